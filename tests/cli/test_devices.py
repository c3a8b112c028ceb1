"""pliant devices."""
import os

import harness


class Devices(harness.CliTest):
    def test_every_backend_has_a_verdict(self):
        backends = {b["name"]: b for b in self.json("devices")["backends"]}
        self.assertTrue(backends["cpu"]["bit_exact"])
        self.assertFalse(backends["cpu:double"]["bit_exact"])
        for backend in backends.values():
            self.assertEqual(backend["bit_exact"], backend["tolerance_reason"] == "", backend)
        text = self.pliant("devices").stdout
        self.assertIn("bit-exact", text)
        self.assertIn("tolerance (", text)
        self.assertEqual(self.pliant("devices", "--quiet").stdout, "")

    def test_cache_of_kernels_that_cannot_be_written(self):
        if "Portable Computing Language" not in self.opencl()["platform"]:
            self.skipTest("there is no PoCL")
        (self.folder / "file").write_text("")
        run = ("run", self.scene(), "--steps", 2, "--hash", "--backend")
        plain = self.pliant(*run, "cpu").stdout.splitlines()[-1]
        cases = (("POCL_CACHE_DIR", "/proc/none", "opencl:0"), ("XDG_CACHE_HOME", "/proc/none", "opencl"), ("POCL_CACHE_DIR", "file", ""))
        for variable, value, backend in cases:
            environment = {k: v for k, v in os.environ.items() if k not in ("POCL_CACHE_DIR", "XDG_CACHE_HOME")}
            environment.update({variable: value, "TMPDIR": str(self.folder)})
            if backend:
                done = self.pliant(*run, backend, env=environment)
                self.assertEqual(done.stdout.splitlines()[-1], plain)
                self.assertRegex(done.stderr, f"backend opencl.*compiled kernels, {value}.* \\(from {variable}\\), cannot be written: ")
                self.assertEqual(self.names(), ["file", "scene.json"])  # the folder that stood in is gone
            refused = self.pliant(*run, "opencl", env=dict(environment, TMPDIR="/proc/none"), expect=2).stderr
            self.assertIn(f"(from {variable}), cannot be written: ", refused)
            self.assertIn("set POCL_CACHE_DIR to a folder that can be", refused)
        self.pliant(*run, "opencl", env=dict(os.environ, POCL_CACHE_DIR=""))  # set and empty is as not set


if __name__ == "__main__":
    harness.main()
