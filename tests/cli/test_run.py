"""pliant run: the end of a run, its figures, and what goes to which stream."""
import json
import os
import pty
import shutil
import signal
import subprocess
import threading
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

    def test_xxhsum_gives_the_hash_of_the_motion_and_the_golden_one(self):
        if shutil.which("xxhsum") is None:
            self.skipTest("there is no xxhsum (Debian: xxhash)")
        golden = json.loads((harness.SOURCE / "tests/golden/hashes.json").read_text())["beam"]
        run = self.json("run", harness.SOURCE / "scenes/beam.json", "--backend", "cpu", "--steps", golden["steps"], "--motion", "beam.motion")
        found = subprocess.run(["xxhsum", "-H3", "beam.motion"], cwd=self.folder, check=True, capture_output=True, text=True).stdout.split()[-1]
        self.assertEqual((found, run["hash"]), (golden["state"], golden["state"]))
        slots = -(-run["nodes"] // 16) * 16  # of a list; lattices in bricks have more
        self.assertEqual((self.folder / "beam.motion").stat().st_size, 2 * 4 * 4 * slots)

    def test_streams(self):
        scene = self.scene()
        done = self.pliant("run", scene, "--backend", "cpu", "--steps", "5")
        for word in ("scene: 216 nodes, 125 elements on cpu", "bit-exact", "5 steps", "stable", "median", "real time", "hash "):
            self.assertIn(word, done.stdout)
        self.assertRegex(done.stderr, r"^pliant: backend cpu \(.*\): requested\n$")
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

    ENDLESS = "1000000000000000"  # 31 years at a microsecond a step, which nothing reaches

    def start(self, *arguments, **options):
        """A run that does not end by itself, once its first frame is there."""
        command = [harness.PLIANT, "run", str(self.scene(dt=0.001)), "--backend", "cpu", "--steps", self.ENDLESS, "--out", "out",
                   "--every", self.ENDLESS, *arguments]
        streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **options}
        process = subprocess.Popen(command, cwd=self.folder, **streams)
        limit = threading.Timer(60, process.kill)  # a test that waits for words that never come fails instead of hanging
        limit.start()
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.addCleanup(limit.cancel)
        while not (self.folder / "out" / "scene.pvd").exists() and process.poll() is None:
            time.sleep(0.05)
        return process

    def test_signals_write_what_there_is(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(signal=number.name):
                process = self.start("--checkpoint", "c.pckpt", "--json", "r.json")
                time.sleep(0.5)
                process.send_signal(number)
                self.assertEqual(process.wait(60), 130)
                run = json.loads((self.folder / "r.json").read_text())
                self.assertTrue(run["interrupted"])
                self.assertGreater(run["steps"], 0)
                self.assertIn(f"scene_{run['step']:08}.vtu", self.names("out"))
                steps = ("run", self.scene(dt=0.001), "--backend", "cpu", "--steps")
                resumed = self.json(*steps, 1, "--resume", "c.pckpt")
                self.assertEqual(resumed["step"], run["step"] + 1)
                for name in ("c.pckpt", "r.json", "out/scene.pvd"):
                    (self.folder / name).unlink()

    def test_nohup_stays_ignored(self):
        process = self.start("--json", "r.json", stdout=subprocess.PIPE, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        process.send_signal(signal.SIGHUP)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertIn(b"interrupted after ", process.stdout.read())
        process.stdout.close()
        self.assertEqual(process.wait(60), 130)

    def test_two_runs_into_one_folder(self):
        process = self.start()
        self.refused("run", self.scene("other"), "--backend", "cpu", "--steps", 1, "--out", "out",
                     words=["'out'", f"process {process.pid}"])
        self.assertFalse([n for n in self.names("out") if n.startswith("other")])
        process.kill()
        process.wait()
        self.pliant("run", self.scene("other"), "--backend", "cpu", "--steps", 1, "--out", "out")  # the dead hold no lock
        self.assertNotIn(".pliant-lock", self.names("out"))

    def test_closed_streams(self):
        run = f"{harness.PLIANT} run {self.scene()} --backend cpu --steps 2 --hash"
        shell = lambda line: subprocess.run(["bash", "-c", line], capture_output=True, text=True, cwd=self.folder)
        plain = shell(run)
        for closed in ("2>&-", "2>/dev/full"):
            done = shell(f"{run} {closed}")
            self.assertEqual(done.returncode, 0, closed)
            self.assertEqual(done.stdout.splitlines()[-1], plain.stdout.splitlines()[-1], closed)
            self.assertEqual(shell(f"{harness.PLIANT} run none.json {closed}").returncode, 2)
        for arguments in ("", " --quiet", " --json - --quiet"):
            done = shell(f"{run}{arguments} --out closed >&-")
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn("standard output is closed", done.stderr)
            self.assertEqual(self.names(), ["scene.json"])  # refused before anything was written
        self.assertEqual(shell(f"{harness.PLIANT} run {self.scene()} --backend cpu --steps 2 --quiet --json r.json >&- 2>&-").returncode, 0)
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["steps"], 2)  # and nothing of the text got into it
        # The lock is a file that stays open: remarks must not get into it.
        process = self.start(preexec_fn=lambda: os.close(2))
        self.assertEqual((self.folder / "out" / ".pliant-lock").read_text(), f"{process.pid}\n")
        process.kill()
        self.assertEqual(shell(f"{run} >/dev/full").returncode, 2)
        self.assertEqual(shell(f"{run} >&- 2>&-").returncode, 2)

    def test_a_step_that_changes_is_told_as_a_range(self):
        pressed = {"prescribed": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, -0.06, 0], "curve": "smooth",
                                   "duration": 0.2}]}
        done = self.pliant("run", self.scene(body=pressed), "--backend", "cpu", "--seconds", 0.2)
        self.assertRegex(done.stdout, r"\d+ steps of [0-9.e-]+ to [0-9.e-]+ s to t = 0\.2\d* s, the last ")
        self.assertRegex(done.stdout, r"largest displacement 0\.06\d* m\n")

    def test_end_in_time_is_the_first_step_there(self):
        run = self.json("run", self.scene(), "--backend", "cpu", "--seconds", 0.1)
        self.assertGreaterEqual(run["time"], 0.1 - 1e-6 * run["dt"])
        self.assertLess(run["time"], 0.1 + run["dt"])
        self.assertAlmostEqual(run["max_displacement"], 0.005, delta=1e-3)
        self.assertEqual((run["pieces"], run["cut_edges"], run["broken_faces"], run["blades_without_contact"]), (1, 0, 0, []))

    def test_a_run_without_an_end_says_so(self):
        process = self.start("--dt", "1e-13", stderr=subprocess.PIPE, text=True)
        said = []
        for line in process.stderr:
            said.append(line)
            if "this run needs about" in line:
                break
        process.stderr.close()
        self.assertRegex("".join(said[-1:]), r"needs about .* days.* more: .* steps of dt = 1e-13 s at .* ms each; the step was given, and [0-9.]+ s is stable")

    def test_progress_on_a_terminal(self):
        main, terminal = pty.openpty()
        process = self.start(stderr=terminal)
        os.close(terminal)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        shown = b""
        while True:
            try:
                part = os.read(main, 65536)
            except OSError:  # the other end is closed
                break
            if not part:
                break
            shown += part
        os.close(main)
        self.assertEqual(process.wait(60), 130)
        self.assertRegex(shown.decode(), r"\[\.*\] +0 %  step \d+  t = [0-9.]+ s  [0-9.e+]+ \S+( \d+ \S+)? left")


if __name__ == "__main__":
    harness.main()
