#!/usr/bin/env python3
"""The viewers of examples/ run and draw: the window under Xvfb with software rendering, the ray tracer headless."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

SOURCE = Path(os.environ["PLIANT_SOURCE"])
WINDOW, VIEWER = os.environ.get("WINDOW", ""), os.environ.get("EMBREE_VIEWER", "")


def rows(path):
    """Width, height and the inflated rows of a PNG."""
    data, at, packed = path.read_bytes(), 8, b""
    width, height = struct.unpack(">II", data[16:24])
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        if data[at + 4 : at + 8] == b"IDAT":
            packed += data[at + 8 : at + 8 + length]
        at += 12 + length
    return width, height, zlib.decompress(packed)


class Screen:
    """A server of X without a screen. (xvfb-run may fail to remove its folder when all has gone well.)"""

    def __enter__(self):
        self.server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "640x480x24"], stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL, text=True)
        return {**os.environ, "DISPLAY": f":{self.server.stdout.readline().strip()}"}

    def __exit__(self, *error):
        self.server.terminate()
        self.server.communicate()


class Viewers(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="pliant-viewers-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        scene = {"format": "pliant-scene/1", "bodies": [{
            "surface": str(SOURCE / "scenes/meshes/cube.obj"), "lattice": {"spacing": 0.02},
            "material": {"young": 3000, "poisson": 0.4, "damping": 5}, "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}]}]}
        self.scene = self.folder / "cube.json"
        self.scene.write_text(json.dumps(scene))

    def run_here(self, *command, env=None):
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, cwd=self.folder, env=env, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    @unittest.skipUnless(WINDOW and shutil.which("Xvfb"), "needs the example window and Xvfb")
    def test_window(self):
        with Screen() as env:
            self.look_at_windows(env)

    def look_at_windows(self, env):
        pictures = []
        actions = (("still", "--pull", "0,0"), ("pulled", "--pull", "0.3,0.3"), ("cut", "--cut", "-0.6,0.1,0.6,0.1"), ("probed", "--probe", "0.1"),
                   ("grasped", "--grasp", "0.1"), ("heavy", "--set", "gravity y=-15"))
        for name, *action in actions:
            self.run_here(WINDOW, self.scene, "--screenshot", f"{name}.png", "--seconds", 0.2, "--size", "480x360", *action, env=env)
            pictures.append(rows(self.folder / f"{name}.png"))
        self.assertEqual(pictures[0][:2], (480, 360))
        self.assertGreater(len(set(pictures[0][2])), 20, "one colour only")
        for (name, *_), picture in list(zip(actions, pictures))[1:]:
            self.assertGreater(self.difference(pictures[0], picture), 0.002, f"{name}: the picture shows nothing of it")
        self.look_at_a_device(env)
        wrong = subprocess.run([WINDOW, self.scene, "--set", "mass=1", "--screenshot", "no.png"], capture_output=True, text=True, env=env, timeout=300)
        self.assertEqual((wrong.returncode, "no slider 'mass'" in wrong.stderr), (2, True), wrong.stderr)

    def look_at_a_device(self, env):
        """A recorded stroke pushes a tool into the cube, then a blade, in wall time; without any the window says so."""
        scene = json.loads(self.scene.read_text())
        scene["tools"] = [{"name": "probe", "shape": {"sphere": 0.02}, "path": [[0, 0, 0.075, 0]]}]
        with_tool = self.folder / "probe.json"
        with_tool.write_text(json.dumps(scene))
        rows_of = [f"{0.01 * i:.2f},0,{-0.0015 * i:.4f},0,0,0,0,1,0" for i in range(16)]
        stroke = self.folder / "stroke.csv"
        stroke.write_text("time,x,y,z,qx,qy,qz,qw,buttons\n" + "\n".join(rows_of) + "\n")
        size = ("--seconds", 0.4, "--size", "480x360")
        self.run_here(WINDOW, with_tool, "--screenshot", "waits.png", *size, env=env)
        felt = self.run_here(WINDOW, with_tool, "--live", f"file:{stroke}", "--screenshot", "felt.png", *size, env=env)
        self.assertGreater(float(felt.split("the hand feels ")[1].split()[0]), 0.01, felt)
        self.assertGreater(self.difference(rows(self.folder / "waits.png"), rows(self.folder / "felt.png")), 0.002)
        material = {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000, "damping": 10, "toughness": 5000}
        scene = {**scene, "tools": [], "bodies": [{**scene["bodies"][0], "material": material}],
                 "blades": [{"name": "scalpel", "cuts": "by-force", "edge": 0.0005, "path": [[0, 0, 0.052, -0.06, 0, 0.052, 0.06]]}]}
        with_blade = self.folder / "scalpel.json"
        with_blade.write_text(json.dumps(scene))
        slow = self.folder / "slow.csv"
        slow.write_text("time,x,y,z,qx,qy,qz,qw,buttons\n" + "".join(f"{0.01 * i:.2f},0,{-0.0005 * i:.4f},0,0,0,0,1,0\n" for i in range(61)))
        felt = self.run_here(WINDOW, with_blade, "--live", f"file:{slow}", "--screenshot", "cut.png", *size, env=env)
        self.assertGreater(float(felt.split("scalpel: the hand feels ")[1].split()[0]), 0.05, felt)
        wrong = subprocess.run([WINDOW, self.scene, "--live", f"file:{stroke}"], capture_output=True, text=True, env=env, timeout=300)
        self.assertEqual((wrong.returncode, "a tool or a blade by force for each device" in wrong.stderr), (2, True), wrong.stderr)

    def difference(self, a, b):
        """Share of the bytes that differ clearly in the right half, where the panel is not."""
        width, height, row = a[0], a[1], 3 * a[0] + 1
        right = [(y * row + x) for y in range(height) for x in range(row * 3 // 5, row)]
        return sum(abs(a[2][i] - b[2][i]) > 40 for i in right) / len(right)

    @unittest.skipUnless(VIEWER, "needs the example embree_viewer")
    def test_embree_viewer(self):
        text = self.run_here(VIEWER, self.scene, "frames", 3, 1)
        self.assertEqual(text.count("(hierarchy built)"), 1, text)
        for word in ("simulate", "refit", "trace", "mean"):
            self.assertIn(word, text)
        self.assertEqual([rows(f)[:2] for f in sorted((self.folder / "frames").iterdir())], [(640, 480)] * 3)


if __name__ == "__main__":
    if not WINDOW and not VIEWER:
        sys.exit(77)
    unittest.main(verbosity=2)
