"""A step that is too long ends with exit code 4, a message, and the last good state."""
import math
import json

import harness


class Diverge(harness.CliTest):
    def unstable(self):
        stable = self.json("info", self.scene())["stable_step"]["iteration"]
        return ("run", self.scene(), "--backend", "cpu", "--dt", repr(3 * stable), "--steps", 2000)

    def check_message(self, stderr):
        for word in ("diverged in step", "element", "of body 'cube'", "dt = ", "stable step", "3 times", "last-good.pckpt"):
            self.assertIn(word, stderr)

    def test_last_good_state_in_the_current_folder(self):
        run = self.unstable()
        done = self.pliant(*run, expect=4)
        self.check_message(done.stderr)
        self.assertIn("scene-last-good.pckpt", self.names())
        resumed = self.json(*run[:-1], 0, "--resume", "scene-last-good.pckpt")
        self.assertEqual(resumed["steps"], 0)

    def test_json_and_folder(self):
        run = self.unstable()
        report = self.json(*run, "--out", "out", "--every", 50, "--checkpoint", "c.pckpt", expect=4)
        self.assertTrue(report["diverged"])
        self.assertLess(report["steps"], 2000)
        self.assertGreater(report["diverged_step"], report["step"])
        self.assertTrue({"scene-last-good.pckpt", "scene-last-good.vtu"} <= set(self.names("out")))
        self.assertNotIn("c.pckpt", self.names())
        for value in report.values():
            if isinstance(value, float):
                self.assertTrue(math.isfinite(value))

    def test_shipped_scenes_that_fail_do(self):
        report = self.json("run", harness.SCENES / "diverge.json", "--backend", "cpu", expect=4)
        self.assertEqual(len([r for r in report["remarks"] if "times the stable step" in r]), 1)
        self.assertIn("diverged in step", self.pliant("run", harness.SCENES / "invert.json", "--backend", "cpu", expect=4).stderr)

    def test_backends_diverge_alike(self):
        self.opencl()
        scene = harness.SCENES / "diverge.json"
        done = self.pliant("compare", scene, "--steps", 2000, "--json", "r.json", expect=4)
        self.assertIn("both backends alike", done.stderr)
        self.assertTrue(json.loads((self.folder / "r.json").read_text())["identical"])


if __name__ == "__main__":
    harness.main()
