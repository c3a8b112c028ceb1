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
        self.opencl()
        (self.folder / "file").write_text("")
        run = ("run", self.scene(), "--steps", 2, "--hash", "--backend")
        plain = self.pliant(*run, "cpu").stdout.splitlines()[-1]
        for variable, value in (("POCL_CACHE_DIR", "/proc/none"), ("POCL_CACHE_DIR", "file"), ("XDG_CACHE_HOME", "/proc/none")):
            environment = {k: v for k, v in os.environ.items() if k not in ("POCL_CACHE_DIR", "XDG_CACHE_HOME")}
            environment.update({variable: value, "TMPDIR": str(self.folder)})
            for backend in ("auto", "opencl"):
                done = self.pliant(*run, backend, env=environment)
                if "opencl:" not in done.stdout:
                    self.skipTest("there is no PoCL")
                self.assertEqual(done.stdout.splitlines()[-1], plain)
                self.assertRegex(done.stderr, f"backend opencl.*compiled kernels, {value}.* \\(from {variable}\\), cannot be written: ")
            self.assertEqual(self.names(), ["file", "scene.json"])  # the folder that stood in is gone
            nowhere = dict(environment, TMPDIR="/proc/none")
            self.refused(*run, "opencl", env=nowhere, words=["there is no OpenCL device", f"(from {variable})"] if "/proc" in value
                         else ["cannot build kernel"])
        self.pliant(*run, "opencl", env=dict(os.environ, POCL_CACHE_DIR=""))  # set and empty is as not set


if __name__ == "__main__":
    harness.main()
