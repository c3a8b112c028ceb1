#!/usr/bin/env python3
"""Runs by hand: devices drive tools while a scene runs; each sample counts; the log of the drives gives the same bits without a device."""
import csv
import json
import math
import re
import signal
import subprocess
import time

import device_ends
from device_ends import Haply, Igtl, Osc, Udp, exchange, press, stroke, write_csv
from harness import PLIANT, CliTest, main

SAMPLES = 100


class Live(CliTest):
    def touched(self, name="scene", body=None, tools=("probe",), **keys):
        """The soft cube, held at its foot, and spheres near its front, 3 mm from it."""
        places = {"probe": [0, 0, 0.073], "other": [0.02, 0.073, 0]}
        tools = [{"name": t, "shape": {"sphere": 0.02}, "path": [[0, *places.get(t, [0, 0, 0.3])]]} for t in tools]
        keys = {"tools": tools, "gravity": [0, 0, 0], "duration": 2, **keys}
        return self.scene(name, body={"prescribed": [], **(body or {})}, **keys)

    def stroke_file(self, name="stroke.csv", samples=SAMPLES, way=press):
        write_csv(self.folder / name, stroke(samples, way))
        return name

    def begin(self, *arguments):
        """Starts a run, whose JSON goes to run.json. Returns it with the ports of its devices, in their order."""
        run = subprocess.Popen([PLIANT, "run", *map(str, arguments), "--json", "run.json"], cwd=self.folder, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.communicate)
        self.addCleanup(run.kill)
        ports, said, wanted = [], "", arguments.count("--live")
        while wanted > 0:
            line = run.stderr.readline()
            said += line
            self.assertTrue(line, said)
            if "is driven by" in line:
                wanted -= 1
                found = re.search(r"listens on port (\d+)", line)
                ports.append(int(found.group(1)) if found else 0)
        return run, ports

    def end(self, run, expect=0):
        out, errors = run.communicate(timeout=300)
        self.assertEqual(run.returncode, expect, out + errors)
        return json.loads((self.folder / "run.json").read_text()), errors

    def lockstep(self, kind, scene, samples, *more):
        """Returns the run's JSON and the forces that the device got."""
        end = Haply() if kind == "websocket" else None
        text = f"websocket:{end.port}?answer=wrench" if end else f"{kind}:0"
        run, ports = self.begin(scene, "--backend", "cpu", "--live", text, "--lockstep", "--rate", device_ends.RATE, "--patience", "0.5", *more)
        end = end or {"udp": Udp, "osc": Osc, "igtl": Igtl}[kind](ports[0])
        self.addCleanup(end.close)
        forces = exchange(end, samples)
        return self.end(run)[0], forces

    def from_file(self, scene, *more, backend="cpu", file=None):
        return self.json("run", scene, "--backend", backend, "--live", f"file:{file or self.stroke_file()}", "--lockstep", *more)

    # One stroke, one hash

    def check_transport(self, kind):
        scene, samples = self.touched(), stroke(SAMPLES, press)
        file = self.from_file(scene)
        self.assertGreater(file["instruments"]["devices"][0]["largest_force"], 0.05)
        run, forces = self.lockstep(kind, scene, samples)
        self.assertEqual(run["hash"], file["hash"])
        self.assertEqual(run["instruments"]["log_hash"], file["instruments"]["log_hash"])
        device = run["instruments"]["devices"][0]
        self.assertEqual((device["used"], device["missed"], device["falling"], device["refused"]), (SAMPLES + 1, 0, 0, 0))
        self.assertAlmostEqual(max(sum(f * f for f in force) ** 0.5 for force in forces), file["instruments"]["devices"][0]["largest_force"], places=5)
        return forces

    def test_udp(self):
        self.check_transport("udp")

    def test_osc(self):
        self.check_transport("osc")

    def test_igtl(self):
        self.check_transport("igtl")

    def test_websocket(self):
        probe = self.pliant("run", self.touched(), "--live", "websocket:1?answer=wrench", "--lockstep", "--patience", "0.01", expect=None)
        if "no WebSocket" in probe.stderr or "libwebsockets" in probe.stderr:
            self.skipTest(probe.stderr.strip())
        self.check_transport("websocket")

    def test_the_scene_is_where_the_samples_are(self):
        """The tool's pose at the end is that of the last sample, and the clock has come to it."""
        samples = stroke(SAMPLES, lambda share: (0.01 * share, 0, -0.02 * share))
        write_csv(self.folder / "line.csv", samples)
        run = self.from_file(self.touched(), "--out", "out", "--every", "1", file="line.csv")
        self.assertTrue(samples[-1][0] - run["dt"] * 1.01 < run["time"] <= samples[-1][0] + 1e-6 * run["dt"], run["time"])
        with open(self.folder / "out" / "scene_tools.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), run["steps"] + 1)
        for row in rows:
            share = float(row["time [s]"]) / samples[-1][0]
            self.assertAlmostEqual(float(row["x [m]"]), 0.01 * share, delta=2e-5)
            self.assertAlmostEqual(float(row["z [m]"]), 0.073 - 0.02 * share, delta=2e-5)

    def test_samples_that_do_not_rise_are_refused_and_answered(self):
        scene, samples = self.touched(), stroke(SAMPLES, press)
        run, ports = self.begin(scene, "--backend", "cpu", "--live", "udp:0", "--lockstep", "--patience", "0.5")
        end = Udp(ports[0])
        self.addCleanup(end.close)
        for k, (t, position) in enumerate(samples):
            exchange(end, [(t, position)])
            if k in (20, 60):
                exchange(end, [(t, (0.3, 0.5, -0.1)), (t - 0.001, (0.3, 0.5, -0.1))])
        result, errors = self.end(run)
        device = result["instruments"]["devices"][0]
        self.assertEqual((device["falling"], device["used"]), (4, SAMPLES + 1))
        self.assertEqual(errors.count("expected more than"), 1)
        self.assertEqual(result["hash"], self.from_file(scene)["hash"])

    def test_two_devices(self):
        scene = self.touched(tools=("probe", "other"))
        samples = stroke(SAMPLES, press)
        down = stroke(SAMPLES, lambda share: (0, -0.012 * share, 0))
        run, ports = self.begin(scene, "--backend", "cpu", "--live", "udp:0", "--tool", "other", "--live", "udp:0", "--tool", "probe",
                                "--lockstep", "--patience", "0.5", "--log", "drives.log")
        other, probe = (Udp(port) for port in ports)
        for one, two in zip(down, samples):
            other.send(*one)
            probe.send(*two)
            other.wrench(), probe.wrench()
        other.close(), probe.close()
        result, _ = self.end(run)
        write_csv(self.folder / "down.csv", down)
        again = self.json("run", scene, "--backend", "cpu", "--live", "file:down.csv", "--tool", "other", "--live", f"file:{self.stroke_file()}",
                          "--tool", "probe", "--lockstep")
        self.assertEqual(again["hash"], result["hash"])
        self.assertEqual([t["max_force"] > 0.03 for t in result["tools"]], [True, True])
        self.assertEqual(self.json("run", scene, "--backend", "cpu", "--replay", "drives.log")["hash"], result["hash"])

    def test_the_scene_ends_first(self):
        run, forces = self.lockstep("udp", self.touched(duration=0.1), stroke(52, press))  # the last one is behind 0.1 s
        self.assertAlmostEqual(run["time"], 0.1, delta=run["dt"])
        self.assertEqual(forces[-1], [0, 0, 0])

    # The log

    def backends(self):
        names = [b["name"] for b in json.loads(self.pliant("devices", "--json", "-").stdout)["backends"]]
        return [n for n in ("cpu", "opencl:0") if n in names]

    def replayed(self, scene, run, *more, log="drives.log", backend="cpu"):
        again = self.json("run", scene, "--backend", backend, "--replay", log, *more)
        for key in ("hash", "deep_hash", "step", "time"):
            self.assertEqual(again[key], run[key], key)
        self.assertEqual(again["instruments"]["log_hash"], run["instruments"]["log_hash"])
        self.assertEqual(again["instruments"]["time"], "replay")
        return again

    def test_replay(self):
        scene = self.touched()
        self.stroke_file(samples=200)
        write_csv(self.folder / "slow.csv", [(8 * t, p) for t, p in stroke(200, press)])  # devices may wait for a compiler
        hashes = set()
        for backend in self.backends():
            for time_of in (["--lockstep"], []):
                with self.subTest(backend=backend, lockstep=bool(time_of)):
                    arguments = [] if time_of else ["--seconds", "0.3"]
                    file = "stroke.csv" if time_of else "slow.csv"
                    run = self.json("run", scene, "--backend", backend, "--live", f"file:{file}", *time_of, *arguments, "--log", "drives.log")
                    self.assertEqual(run["instruments"]["time"], "lockstep" if time_of else "paced")
                    self.assertGreater(run["instruments"]["drives"], 3)
                    self.replayed(scene, run, backend=backend)
                    if backend != "cpu" and self.opencl()["bit_exact"]:
                        self.replayed(scene, run)
                    if time_of:
                        hashes.add(run["hash"])
        if not self.backends()[1:] or self.opencl()["bit_exact"]:
            self.assertEqual(len(hashes), 1)

    def test_paced_by_the_wall(self):
        scene = self.touched()
        write_csv(self.folder / "slow.csv", [(4 * t, p) for t, p in stroke(200, press)])
        began = time.monotonic()
        run = self.json("run", scene, "--backend", "cpu", "--live", "file:slow.csv", "--seconds", "1", "--out", "out", "--rate", "500")
        self.assertGreater(time.monotonic() - began, 0.7)
        device = run["instruments"]["devices"][0]
        self.assertGreater(device["ticks"], 100)
        self.assertGreater(device["frames"], 10)
        self.assertEqual((device["not_finite"], device["poses_refused"]), (0, 0))
        self.assertGreater(run["tools"][0]["max_force"], 0.02)
        self.assertGreater(device["largest_force"], 0.01)
        with open(self.folder / "out" / "scene_tools.csv") as file:
            self.assertGreater(len(list(csv.DictReader(file))), 10)

    def test_batches_that_are_made_again(self):
        """Drives lie within what is taken back and done with shorter steps."""
        table = {"name": "table", "shape": {"half_space": [[0, -0.055, 0], [0, 1, 0]]}}
        probe = {"name": "probe", "shape": {"sphere": 0.02}, "path": [[0, 0, 0, 0.073]]}
        scene = self.scene(body={"prescribed": [], "fixed": [], "velocity": [0, -3, 0]}, tools=[table, probe], gravity=[0, 0, 0], duration=0.06)
        run = self.from_file(scene, "--tool", "probe", "--log", "drives.log", file=self.stroke_file(samples=30))
        self.assertGreater(run["batches_made_again"], 0)
        self.replayed(scene, run)

    def test_a_log_behind_the_scenes_duration(self):
        scene = self.touched(duration=0.1)
        run = self.from_file(scene, "--seconds", "0.15", "--log", "drives.log")
        self.assertGreater(run["time"], 0.14)
        self.replayed(scene, run)

    def test_resume(self):
        scene = self.touched()
        whole = self.from_file(scene, "--log", "drives.log")
        half = self.json("run", scene, "--backend", "cpu", "--replay", "drives.log", "--steps", whole["steps"] // 2, "--checkpoint", "c.pckpt")
        self.assertEqual(half["steps"], whole["steps"] // 2)
        self.assertEqual(self.replayed(scene, whole, "--resume", "c.pckpt")["steps"], whole["steps"] - half["steps"])
        later = self.from_file(scene, "--resume", "c.pckpt", "--log", "later.log")
        self.replayed(scene, later, "--resume", "c.pckpt", log="later.log")
        self.refused("run", scene, "--backend", "cpu", "--replay", "later.log", words=["later.log:2", "begins at step", "--resume"])

    def test_an_interrupted_run_has_a_log(self):
        scene = self.touched()
        run, ports = self.begin(scene, "--backend", "cpu", "--live", "udp:0", "--lockstep", "--patience", "60", "--log", "drives.log")
        end = Udp(ports[0])
        self.addCleanup(end.close)
        exchange(end, stroke(SAMPLES, press)[:40])
        run.send_signal(signal.SIGINT)
        result, _ = self.end(run, expect=130)
        self.assertTrue(result["interrupted"])
        self.replayed(scene, result)

    # Forceps in the hand

    def test_a_button_closes_forceps(self):
        """Pressed while the ball is in the tissue, it pulls it up, and lets go in the end; the log gives the same bits."""
        tool = {"name": "forceps", "shape": {"sphere": 0.02}, "path": [[0, 0, 0, 0.073]], "grip": {}}
        scene = self.scene("forceps", body={"prescribed": []}, tools=[tool], gravity=[0, 0, 0], duration=2)
        way = lambda share: (0, 0, -0.006 * min(1, 5 * share) + 0.02 * max(0, min(1, 2.5 * share - 1)))
        write_csv(self.folder / "pull.csv", stroke(300, way), buttons=lambda t: 1 if 0.15 < t < 0.5 else 0)
        write_csv(self.folder / "open.csv", stroke(300, way), buttons=lambda t: 2)
        for time_of in (["--lockstep"], ["--seconds", "0.7"]):
            with self.subTest(time_of[0]):
                run = self.json("run", scene, "--backend", "cpu", "--live", "file:pull.csv", *time_of, "--log", "drives.log", "--out", "out", "--every", "10")
                rows = [line for line in (self.folder / "drives.log").read_text().splitlines() if line.startswith("grip")]
                self.assertEqual([row.split(",")[3:] for row in rows], [["1", "forceps"], ["0", "forceps"]])
                with open(self.folder / "out" / "forceps_tools.csv") as file:
                    pulls = [float(row["fz [N]"]) for row in csv.DictReader(file)]
                self.assertLess(min(pulls), -0.05)
                self.assertEqual(pulls[-1], 0)
                for backend in self.backends():
                    self.replayed(scene, run, backend=backend)
        middle = int(rows[0].split(",")[1]) + 20
        self.json("run", scene, "--backend", "cpu", "--replay", "drives.log", "--steps", middle, "--checkpoint", "c.pckpt")
        self.replayed(scene, run, "--resume", "c.pckpt")
        self.from_file(scene, "--log", "open.log", file="open.csv")
        self.assertNotIn("grip", (self.folder / "open.log").read_text())

    # A blade in the hand

    def cut(self, name="cut", **keys):
        """The soft cube under a blade of 0.12 m, 1 mm above it, that cuts by force."""
        material = {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000, "damping": 10, "toughness": 5000}
        scalpel = {"name": "scalpel", "cuts": "by-force", "edge": 0.0005, "path": [[0, 0.003, 0.051, -0.06, 0.003, 0.051, 0.06]]}
        return self.scene(name, body={"prescribed": [], "material": material}, **{"blades": [scalpel], "gravity": [0, 0, 0], "duration": 2, **keys})

    def test_a_blade(self):
        """It indents, cuts and comes out; the log gives the same bits, also from its middle and on other backends."""
        scene = self.cut()
        write_csv(self.folder / "down.csv", stroke(200, lambda share: (0, -0.03 * math.sin(math.pi * share), 0)))
        for time_of in (["--lockstep"], ["--seconds", "0.7"]):
            with self.subTest(time_of[0]):
                run = self.json("run", scene, "--backend", "cpu", "--live", "file:down.csv", *time_of, "--log", "drives.log", "--checkpoint", "end.pckpt")
                device = run["instruments"]["devices"][0]
                self.assertEqual((device["tool"], device["poses_refused"]), ("scalpel", 0))
                self.assertGreater(run["blades"][0]["fracture"], 0)
                self.assertGreater(run["cut_edges"], 0)
                self.assertGreater(device["largest_force"], 0.3)
                for backend in self.backends():
                    self.replayed(scene, run, backend=backend)
        half = self.json("run", scene, "--backend", "cpu", "--replay", "drives.log", "--steps", run["steps"] // 2, "--checkpoint", "c.pckpt")
        self.assertGreater(half["steps"], 0)
        self.replayed(scene, run, "--resume", "c.pckpt")

    def test_a_hand_too_quick_for_its_blade(self):
        """The blade follows as fast as it may, and is refused nowhere."""
        write_csv(self.folder / "quick.csv", stroke(100, lambda share: (0, 0.1 * min(1, 10 * share), 0)))
        run = self.json("run", self.cut(), "--backend", "cpu", "--live", "file:quick.csv", "--lockstep", "--log", "drives.log")
        self.assertEqual(run["instruments"]["devices"][0]["poses_refused"], 0)
        heights = [float(line.split(",")[5]) for line in (self.folder / "drives.log").read_text().splitlines() if line.startswith("drive")]
        self.assertLess(max(b - a for a, b in zip(heights, heights[1:])), 0.005)
        self.assertGreater(heights[-1], 0.1)

    def test_blades_that_are_not_there(self):
        scalpel = {"name": "scalpel", "cuts": "by-force", "edge": 0.0005, "path": [[t, 0, 0.06, -0.06, 0, 0.06, 0.06] for t in (0.5, 1)]}
        scene = self.cut(blades=[scalpel])
        file = f"file:{self.stroke_file()}"
        self.refused("run", scene, "--backend", "cpu", "--live", file, words=["scalpel", "nowhere", "path"])
        (self.folder / "bad.log").write_text("pliant-drives/1\nbegin,0,0\ndrive,0,0,0.01,0,0,0.07,0,0,0,1,scalpel\n")
        self.refused("run", scene, "--backend", "cpu", "--replay", "bad.log", words=["bad.log:3", "scalpel", "nowhere"])

    GOOD = "pliant-drives/1\nbegin,0,0\ndrive,0,0,0.01,0,0,0.07,0,0,0,1,probe\n"

    def test_logs_that_do_not_fit(self):
        scene = self.touched(dt=1e-3)
        row = "drive,10,0.01,0.01,0,0,0.07,0,0,0,1,probe\n"
        for text, words in (
            ("", ["bad.log:0", "the file is \"empty\""]),
            ("step,time\n", ["bad.log:1", "pliant-drives/1"]),
            ("pliant-drives/1\n", ["bad.log:1", "begin,STEP,TIME"]),
            (self.GOOD + row.replace("probe", "needle"), ["bad.log:4", "\"needle\"", "\"probe\""]),
            (self.GOOD + row + row.replace("10,0.01", "9,0.01", 1), ["bad.log:5", "\"9\"", "from 10"]),
            (self.GOOD + row + row.replace("10,0.01", "11,0.009", 1), ["bad.log:5", "0.009", "0.01"]),
            (self.GOOD + row.replace("0.07", "nan"), ["bad.log:4", "\"nan\"", "finite"]),
            (self.GOOD + row.replace("0.07", "1e999"), ["bad.log:4", "\"1e999\"", "finite"]),
            (self.GOOD + row.replace("0,0,0,1,", "0,0,1,1,"), ["bad.log:4", "0,0,1,1", "unit quaternion"]),
            (self.GOOD + row.replace("0.01,0.01", "0.01,-1"), ["bad.log:4", "\"-1\"", "more than 0"]),
            (self.GOOD + "push,10,0.01\n", ["bad.log:4", "push,10,0.01", "drive,..., grip,..., confirm,..., again,... or end,..."]),
            (self.GOOD + "end,20,0.02\n" + row, ["bad.log:5", "nothing behind the end"]),
            (self.GOOD + row.replace("10,0.01", "10,0.0101", 1), ["bad.log:4", "step 10 is at 0.0101", "another scene"]),
        ):
            with self.subTest(words=words):
                (self.folder / "bad.log").write_text(text)
                self.refused("run", scene, "--backend", "cpu", "--replay", "bad.log", words=words)
        self.refused("run", scene, "--backend", "cpu", "--replay", "absent.log", words=["absent.log"])

    def test_bad_usage(self):
        scene, two = self.touched(), self.touched("two", tools=("probe", "other"))
        file = f"file:{self.stroke_file()}"
        for arguments, words in (
            ((scene, "--lockstep"), ["--lockstep", "--live"]),
            ((scene, "--live", file, "--replay", "x"), ["--replay", "--live"]),
            ((scene, "--live", file, "--patience", "1"), ["--patience", "--lockstep"]),
            ((scene, "--live", file, "--rate", "100"), ["--rate is 100", "300 to 10000"]),
            ((scene, "--live", file, "--tool", "prob"), ["\"prob\"", "\"probe\"", "did you mean"]),
            ((scene, "--live", "fire:x"), ["fire", "udp:PORT"]),
            ((two, "--live", file), ["1 --live and 0 --tool", "\"other\""]),
            ((two, "--live", file, "--tool", "probe", "--live", file, "--tool", "probe"), ["twice"]),
            ((self.scene("none"), "--live", file), ["no tools"]),
            ((self.touched("rest", relaxation={"tolerance": 1e-4}), "--live", file), ["relaxation"]),
        ):
            with self.subTest(words=words):
                self.refused("run", *arguments, "--backend", "cpu", words=words)


if __name__ == "__main__":
    main()
