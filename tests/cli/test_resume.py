"""Checkpoints: a resumed run gives the bits of an uninterrupted one, and what cannot be resumed is refused."""
import resource
import subprocess
import time

import harness


class Resume(harness.CliTest):
    def backends(self):
        names = [b["name"] for b in self.json("devices")["backends"]]
        return [n for n in ("cpu", "cpu:double", "opencl:0") if n in names]

    def split(self, backend, first, second, **keys):
        scene = self.scene(**keys)
        steps = lambda n, *rest: self.json("run", scene, "--backend", backend, "--steps", n, *rest)
        whole = steps(first + second)
        steps(first, "--checkpoint", "c.pckpt")
        resumed = steps(second, "--resume", "c.pckpt")
        for key in ("hash", "step", "time", "dt", "stable_dt"):
            self.assertEqual(resumed[key], whole[key], f"{key} on {backend}")
        self.assertEqual(resumed["steps"], second)
        return whole

    def test_a_hundred_steps(self):
        for backend in self.backends():
            self.split(backend, 37, 63)

    def test_relaxation(self):
        for backend in self.backends():
            self.split(backend, 37, 63, relaxation={"tolerance": 1e-6, "max_steps": 1000})

    def test_across_a_renewal_of_the_step(self):
        stretched = {
            "material": {"law": "neo-hookean", "young": 30000, "poisson": 0.4, "density": 1000, "damping": 5},
            "prescribed": [
                {"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, 0.01, 0], "curve": "smooth", "duration": 1}
            ],
        }
        first = self.json("run", self.scene(body=stretched), "--backend", "cpu", "--steps", 1)["dt"]
        for backend in self.backends():
            whole = self.split(backend, 500, 30, body=stretched)
            self.assertLess(whole["dt"], first)

    def test_from_one_backend_to_another(self):
        if not self.opencl()["bit_exact"]:
            self.skipTest("opencl:0 is in tolerance mode")
        scene = self.scene()
        whole = self.json("run", scene, "--backend", "cpu", "--steps", 100)
        self.json("run", scene, "--backend", "opencl:0", "--steps", 37, "--checkpoint", "c.pckpt")
        resumed = self.json("run", scene, "--backend", "cpu", "--steps", 63, "--resume", "c.pckpt")
        self.assertEqual(resumed["hash"], whole["hash"])

    def test_default_end_counts_what_was_done(self):
        scene = self.scene(dt=0.002)
        self.json("run", scene, "--backend", "cpu", "--steps", 100, "--checkpoint", "c.pckpt")
        self.assertEqual(self.json("run", scene, "--backend", "cpu", "--resume", "c.pckpt")["steps"], 50)

    def test_equilibrium_stays(self):
        scene = self.scene(relaxation={"tolerance": 1e-2, "max_steps": 20000})
        whole = self.json("run", scene, "--backend", "cpu", "--checkpoint", "c.pckpt")
        resumed = self.json("run", scene, "--backend", "cpu", "--resume", "c.pckpt")
        self.assertEqual((resumed["steps"], resumed["converged"], resumed["hash"]), (0, True, whole["hash"]))
        self.assertEqual(resumed["residual"], whole["residual"])

    def test_refused(self):
        scene, other = self.scene(), self.scene("other", gravity=[0, 0, 0])
        run = ("run", scene, "--backend", "cpu", "--steps", 1)
        self.pliant(*run, "--checkpoint", "c.pckpt")
        self.refused("run", other, "--backend", "cpu", "--resume", "c.pckpt", words=["c.pckpt", "\"scene\"", "\"other\"", "not the same: gravity"])
        self.refused(*run, "--dt", "1e-4", "--resume", "c.pckpt", words=["c.pckpt", "not the same: dt"])
        self.refused("run", scene, "--backend", "cpu:double", "--resume", "c.pckpt", words=["float", "double"])
        self.refused(*run, "--resume", "absent.pckpt", words=["absent.pckpt"])
        good = (self.folder / "c.pckpt").read_bytes()
        for name, data in (("short", good[: len(good) // 2]), ("empty", b""), ("other", b"hello" * 100),
                           ("flipped", good[:200] + bytes([good[200] ^ 1]) + good[201:])):
            (self.folder / name).write_bytes(data)
            self.refused(*run, "--resume", name, words=[name])

    def test_saved_on_the_way(self):
        """What a run that is killed has left goes on with the bits of one that was not."""
        squeezed = {"prescribed": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, -0.05, 0], "curve": "smooth",
                                    "duration": 0.2}]}
        scene, file = self.scene(body=squeezed), self.folder / "c.pckpt"
        command = [harness.PLIANT, "run", str(scene), "--backend", "cpu", "--steps", "100000000", "--checkpoint", "c.pckpt",
                   "--checkpoint-every", "0.05"]
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        kept, end = [], time.monotonic() + 120
        while len(kept) < 3:
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), end, "no checkpoint on the way")
            if file.exists() and (not kept or file.stat().st_ino != kept[-1]):
                kept.append(file.stat().st_ino)
            time.sleep(0.01)
        process.kill()
        process.wait()
        steps = lambda *rest: self.json("run", scene, "--backend", "cpu", "--steps", *rest)
        done = steps(0, "--resume", "c.pckpt")["step"]
        self.assertGreater(done, 0)
        resumed, whole = steps(77, "--resume", "c.pckpt"), steps(done + 77)
        for key in ("hash", "deep_hash", "step", "time", "dt"):
            self.assertEqual(resumed[key], whole[key], key)

    def test_full_disk_keeps_the_older_checkpoint(self):
        run = ("run", self.scene(), "--backend", "cpu", "--steps", 1)
        self.pliant(*run, "--checkpoint", "c.pckpt")
        before = (self.folder / "c.pckpt").read_bytes()
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
        done = self.pliant(*run, "--checkpoint", "c.pckpt", expect=2, preexec_fn=limit, env={"POCL_KERNEL_CACHE": "0"})
        self.assertIn("c.pckpt", done.stderr)
        self.assertEqual((self.folder / "c.pckpt").read_bytes(), before)
        self.assertEqual(self.names(), ["c.pckpt", "scene.json"])


if __name__ == "__main__":
    harness.main()
