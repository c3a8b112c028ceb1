"""Frames: names, content, series; folders that cannot be written; disks that are full."""
import os
import re
import resource
import struct
import xml.etree.ElementTree as ElementTree

import harness


def read_vtu(file):
    """Arrays of a file with appended raw data, as lists of numbers by name."""
    data = file.read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    end = data.rindex(b"</AppendedData>")
    root = ElementTree.fromstring(data[: data.index(b"<AppendedData")] + b"</VTKFile>")
    arrays = {}
    for array in root.iter("DataArray"):
        at = start + int(array.get("offset"))
        assert at < end
        size = struct.unpack_from("<Q", data, at)[0]
        code = {"Float32": "f", "Int32": "i", "Int64": "q", "UInt8": "B"}[array.get("type")]
        arrays[array.get("Name")] = struct.unpack_from(f"<{size // struct.calcsize(code)}{code}", data, at + 8)
    return root, arrays


class Files(harness.CliTest):
    def run_frames(self, *arguments, **options):
        return self.json("run", self.scene(dt=0.002), "--backend", "cpu", "--out", "out", *arguments, **options)

    def test_frames_at_the_start_at_multiples_and_at_the_end(self):
        run = self.run_frames("--steps", 25, "--every", 10, "--format", "vtu,obj")
        steps = ["00000000", "00000010", "00000020", "00000025"]
        expected = [f"scene_{s}.vtu" for s in steps] + [f"scene_surface_{s}.{e}" for s in steps for e in ("vtu", "obj")]
        self.assertEqual(self.names("out"), sorted(expected + ["scene.pvd", "scene_surface.pvd"]))
        self.assertEqual(run["frames"], 4)
        for series in ("scene.pvd", "scene_surface.pvd"):
            sets = list(ElementTree.parse(self.folder / "out" / series).iter("DataSet"))
            self.assertEqual([round(float(d.get("timestep")), 6) for d in sets], [0, 0.02, 0.04, 0.05])
            for entry in sets:
                self.assertTrue((self.folder / "out" / entry.get("file")).exists())

    def times(self):
        sets = ElementTree.parse(self.folder / "out" / "scene.pvd").iter("DataSet")
        return [float(d.get("timestep")) for d in sets]

    def test_frames_in_time(self):
        for every in ("16ms", "0.016s", "16000us"):
            run = self.run_frames("--steps", 25, "--every", every)
            self.assertEqual([round(t, 6) for t in self.times()], [0, 0.016, 0.032, 0.048, 0.05])
        self.run_frames("--steps", 25, "--every", "5ms")  # between two steps: the first one after it
        self.assertEqual([round(t, 6) for t in self.times()], [0, 0.006, 0.01, 0.016, 0.02, 0.026, 0.03, 0.036, 0.04, 0.046, 0.05])
        self.run_frames("--steps", 25)
        self.assertEqual([round(t, 6) for t in self.times()], [0, 0.018, 0.034, 0.05])
        self.assertEqual(run["frames"], 5)

    def test_frames_in_time_when_the_step_changes(self):
        """First the step shrinks, as the cube is pressed flat, and grows again when it is let go."""
        curve = [[0, 0], [0.15, 1], [0.3, 0], [0.6, 0]]
        material = {"law": "neo-hookean", "young": 300000, "poisson": 0.4, "density": 1000, "damping": 5}
        flat = {"material": material, "prescribed": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, -0.065, 0],
                                                      "table": curve}]}
        scene = self.scene(body=flat)
        run = self.json("run", scene, "--backend", "cpu", "--seconds", 0.6, "--out", "out", "--every", "10ms")
        first = self.json("run", scene, "--backend", "cpu", "--steps", 1)["dt"]
        self.assertLess(run["simulated_seconds"] / run["steps"], 0.95 * first)  # otherwise this tests nothing
        times = self.times()
        self.assertEqual((len(times), run["frames"]), (61, 61))
        for number, t in enumerate(times):
            self.assertGreaterEqual(t, 0.01 * number - 1e-6 * first)
            self.assertLess(t, 0.01 * number + first)
        plain = self.json("run", scene, "--backend", "cpu", "--seconds", 0.6)
        self.assertEqual((run["deep_hash"], run["step"]), (plain["deep_hash"], plain["step"]))

    def test_files_of_an_earlier_run_are_told(self):
        scene = self.scene(dt=0.002)
        run = ("run", scene, "--backend", "cpu", "--out", "out", "--every", 10, "--format", "obj")
        self.assertNotIn("earlier run", self.pliant(*run, "--steps", 20, "--checkpoint", "half.pckpt").stderr)
        self.assertNotIn("earlier run", self.pliant(*run, "--steps", 20, "--resume", "half.pckpt").stderr)
        self.assertIn("holds 5 files of an earlier run of scene", self.pliant(*run, "--steps", 10).stderr)
        self.assertNotIn("earlier run", self.pliant(*run[:-1], "vtu", "--steps", 10).stderr, "no frames of this kind")

    def test_frames_do_not_change_a_bit(self):
        plain = self.json("run", self.scene(dt=0.002), "--backend", "cpu", "--steps", 25)
        self.assertEqual(self.run_frames("--steps", 25, "--every", 3)["hash"], plain["hash"])

    def test_content(self):
        self.run_frames("--seconds", 0.3, "--every", 1000)
        root, arrays = read_vtu(self.folder / "out" / "scene_00000150.vtu")
        piece = next(root.iter("Piece"))
        self.assertEqual((piece.get("NumberOfPoints"), piece.get("NumberOfCells")), ("216", "125"))
        points = next(name for name in arrays if name.lower() in ("points", "position"))
        x, u, v = arrays[points], arrays["displacement"], arrays["velocity"]
        self.assertEqual((len(x), len(u), len(v)), (648, 648, 648))
        top = [i for i in range(216) if x[3 * i + 1] - u[3 * i + 1] > 0.049]
        self.assertEqual(len(top), 36)
        for i in top:
            self.assertAlmostEqual(u[3 * i + 1], -0.01, places=6)
        self.assertEqual(set(arrays["body"]), {0.0})
        self.assertTrue(all(0.9 < f < 1.1 for f in arrays["fill"]))
        _, surface = read_vtu(self.folder / "out" / "scene_surface_00000150.vtu")
        self.assertAlmostEqual(min(surface["displacement"][1::3]), -0.01, delta=2e-3)

    def test_obj(self):
        self.run_frames("--steps", 1, "--format", "obj")
        self.assertEqual(self.names("out"), ["scene_surface_00000000.obj", "scene_surface_00000001.obj"])
        self.assertRegex((self.folder / "out" / "scene_surface_00000001.obj").read_text(), re.compile(r"^f ", re.M))

    def refused_quickly(self, *arguments, words, **options):
        """Before the simulation: a run of this length would not end within the time limit."""
        self.refused("run", self.scene(dt=1e-7), "--backend", "cpu", "--steps", 10**9, *arguments, words=words, **options)

    def test_places_that_cannot_be_written(self):
        (self.folder / "file").write_text("x")
        self.refused_quickly("--out", "file", words=["file"])
        self.refused_quickly("--out", "file/below", words=["file/below"])
        self.refused_quickly("--checkpoint", "no/such/c.pckpt", words=["no/such/c.pckpt"])
        self.refused_quickly("--motion", "no/such/c.motion", words=["no/such/c.motion"])
        self.refused_quickly("--json", "no/such/r.json", words=["no/such/r.json"])
        self.refused_quickly("--out", "/proc/pliant", words=["/proc/pliant"])
        self.assertEqual(self.names(), ["file", "scene.json"])

    def test_folder_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        (self.folder / "locked").mkdir(mode=0o500)
        self.refused_quickly("--out", "locked", words=["locked"])

    def test_full_disk(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))
        self.refused("run", self.scene(), "--backend", "cpu", "--steps", 1, "--out", "out", words=["scene_00000000.vtu"],
                     preexec_fn=limit)
        self.assertEqual(self.names("out"), [])
        message = self.pliant("devices", "--json", "-", expect=2, stdout_to="/dev/full").stderr
        self.assertIn("standard output", message)

    def pliant(self, *arguments, stdout_to=None, expect=0, **options):
        if stdout_to is None:
            return super().pliant(*arguments, expect=expect, **options)
        import subprocess

        with open(stdout_to, "w") as out:
            done = subprocess.run([harness.PLIANT, *arguments], stdout=out, stderr=subprocess.PIPE, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, expect)
        return done


if __name__ == "__main__":
    harness.main()
