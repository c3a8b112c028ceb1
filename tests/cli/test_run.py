"""pliant run: the end of a run, its figures, and what goes to which stream."""
import json
import signal
import subprocess
import time

import harness


class Run(harness.CliTest):
    def test_figures(self):
        run = self.json("run", self.scene(), "--backend", "cpu", "--steps", "20")
        self.assertEqual(run["scene"], "scene")
        self.assertEqual((run["backend"], run["nodes"], run["elements"], run["steps"]), ("cpu", 216, 125, 20))
        self.assertAlmostEqual(run["simulated_seconds"], 20 * run["dt"])
        self.assertAlmostEqual(run["dt"], 0.9 * run["stable_dt"])
        self.assertGreater(run["ms_per_step"], 0)
        self.assertFalse(run["diverged"])
        self.assertNotIn("converged", run)

    def test_backends_agree_and_double_is_near(self):
        device = self.opencl()
        arguments = ("run", self.scene(), "--steps", "100", "--backend")
        cpu = self.json(*arguments, "cpu")
        if device["bit_exact"]:
            self.assertEqual(self.json(*arguments, "opencl")["hash"], cpu["hash"])
        self.assertNotEqual(self.json(*arguments, "cpu:double")["hash"], cpu["hash"])

    def test_end_by_duration_and_seconds(self):
        scene = self.scene(dt=0.002)
        self.assertEqual(self.json("run", scene, "--backend", "cpu")["steps"], 150)
        self.assertEqual(self.json("run", scene, "--backend", "cpu", "--seconds", "0.1")["steps"], 50)
        self.assertEqual(self.json("run", scene, "--backend", "cpu", "--seconds", "0.1", "--dt", "0.001")["steps"], 100)
        self.assertEqual(self.json("run", scene, "--backend", "cpu", "--steps", "0")["steps"], 0)

    def test_relaxation_reaches_equilibrium_or_says_that_it_did_not(self):
        scene = self.scene(relaxation={"tolerance": 1e-3, "max_steps": 20000})
        run = self.json("run", scene, "--backend", "cpu")
        self.assertTrue(run["converged"])
        self.assertLessEqual(run["residual"], 1e-3)
        short = self.json("run", scene, "--backend", "cpu", "--steps", "64")
        self.assertFalse(short["converged"])
        self.assertEqual(short["steps"], 64)
        self.assertGreater(short["residual"], 1e-3)

    def test_streams(self):
        scene = self.scene()
        done = self.pliant("run", scene, "--backend", "cpu", "--steps", "5")
        for word in ("scene: 216 nodes, 125 elements on cpu", "bit-exact", "5 steps", "stable", "median", "real time", "hash "):
            self.assertIn(word, done.stdout)
        self.assertRegex(done.stderr, r"^pliant: backend cpu \(.*\): asked for\n$")
        quiet = self.pliant("run", scene, "--backend", "cpu", "--steps", "5", "--quiet")
        self.assertEqual((quiet.stdout, quiet.stderr), ("", ""))
        only = self.pliant("run", scene, "--backend", "cpu", "--steps", "5", "--quiet", "--hash")
        self.assertRegex(only.stdout, r"^[0-9a-f]{16}\n$")
        both = self.pliant("run", scene, "--backend", "cpu", "--steps", "5", "--json", "r.json")
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["hash"], only.stdout.strip())
        self.assertIn(only.stdout.strip(), both.stdout)

    def test_auto_says_which_and_why(self):
        stderr = self.pliant("run", self.scene(), "--steps", "1").stderr
        self.assertRegex(stderr, r"pliant: backend (opencl:\d+|cpu) \(.*\): \S")

    def test_profile_lists_every_pass(self):
        run = self.json("run", self.scene(), "--backend", "cpu", "--steps", "10", "--profile")
        for kernel in ("tled_hex8_brick_force", "brick_update", "node_prescribe"):
            rows = [row for row in run["profile"] if row["kernel"] == kernel]
            self.assertIn(sum(row["launches"] for row in rows), (10, 11), kernel)  # one more where the batch's end is looked at
            self.assertGreater(sum(row["seconds"] for row in rows), 0)

    def test_interrupt_writes_what_there_is(self):
        command = [harness.PLIANT, "run", str(self.scene(dt=0.001)), "--backend", "cpu", "--steps", "1000000000", "--out", "out",
                   "--every", "1000000000", "--checkpoint", "c.pckpt", "--json", "r.json"]
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (self.folder / "out" / "scene.pvd").exists() and process.poll() is None:
            time.sleep(0.05)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(60), 130)
        run = json.loads((self.folder / "r.json").read_text())
        self.assertTrue(run["interrupted"])
        self.assertGreater(run["steps"], 0)
        self.assertIn(f"scene_{run['step']:08}.vtu", self.names("out"))
        self.json("run", self.scene(dt=0.001), "--backend", "cpu", "--steps", "1", "--resume", "c.pckpt")


if __name__ == "__main__":
    harness.main()
