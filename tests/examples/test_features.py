#!/usr/bin/env python3
"""The examples of one feature each run, and their numbers are those that the feature must give."""
import os
import re
import subprocess
import unittest
from pathlib import Path

FOLDER = Path(os.environ["EXAMPLES"])


def output(name, *arguments):
    done = subprocess.run([str(FOLDER / name), *arguments], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def numbers(text):
    return [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text)]


class Features(unittest.TestCase):
    def test_hello_pulls_a_corner(self):
        x = [numbers(line)[1] for line in output("hello").splitlines()[1:]]
        self.assertEqual(len(x), 5)
        self.assertGreater(x[-1], 0.11)

    def test_cut_makes_two_pieces(self):
        lines = output("cut").splitlines()
        self.assertEqual(numbers(lines[0])[0], 1)
        self.assertEqual(numbers(lines[-1])[0], 2)
        self.assertGreater(numbers(lines[-1])[2], 0, "no triangle on the cut")

    def test_tool_feels_what_it_presses(self):
        force = [numbers(line)[2] for line in output("tool").splitlines()]
        self.assertEqual(force[0], 0, "it is above the block")
        self.assertEqual(force, sorted(force), "deeper is harder")
        self.assertGreater(force[-1], 1)
        self.assertAlmostEqual(force[-1], force[-2], 2, "it stands still")

    def test_probe_agrees_with_statics(self):
        text = output("probe")
        values = {line.split(":")[0]: numbers(line.split(":")[1]) for line in text.splitlines()[1:]}
        self.assertAlmostEqual(values["middle, stress"][0] / values["load over area"][0], 1, 1)
        self.assertAlmostEqual(values["clamp, reaction"][0], -0.2, 3)
        self.assertAlmostEqual(values["middle, displacement"][0], 5e-4, 5)  # F / (E A) times half the length

    def test_frames_sends_what_moved(self):
        news, same, sent, low = numbers(output("frames"))
        self.assertEqual(news + same, 120)
        self.assertGreaterEqual(sent, 8)
        self.assertLess(low, 0, "it does not hang down")

    def test_haptics_feels_the_press(self):
        lines = output("haptics", "2").splitlines()
        force = [numbers(line)[2] for line in lines[:-1]]
        self.assertEqual(len(force), 20)
        self.assertEqual(force[0], 0, "it is above the block")
        self.assertGreater(max(force), 0.1)
        self.assertGreater(numbers(lines[-1])[0], 100, "ticks")
        refused = subprocess.run([str(FOLDER / "haptics"), "1", "telepathy:1"], capture_output=True, text=True, timeout=120)
        self.assertEqual(refused.returncode, 5)
        self.assertIn("udp:PORT", refused.stderr)


if __name__ == "__main__":
    unittest.main()
