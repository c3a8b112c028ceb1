"""pliant plan on a small cube."""
import json

import harness

SMALL = ("--least", "60", "--most", "300", "--reference", "700", "--reference-seconds", "0", "--backend", "cpu")


class Plan(harness.CliTest):
    def test_the_choice_meets_both_and_is_the_cheapest_that_does(self):
        plan = self.json("plan", self.scene(), "--tolerance", "20%", "--budget", "1s", "--out", "chosen.json", *SMALL)
        self.assertTrue(plan["found"])
        self.assertEqual(plan["nearest"], [])
        within = [t for t in plan["trials"] if t["error_l2"] is not None and t["error_l2"] <= 0.2]
        self.assertEqual(plan["choice"]["ms_per_frame"], min(t["ms_per_frame"] for t in within))
        self.assertIn(plan["choice"], plan["trials"])
        self.assertGreater(len({t["element"] for t in plan["trials"]}), 1)
        scene = json.loads((self.folder / "chosen.json").read_text())
        self.assertEqual(scene["bodies"][0]["element"], plan["choice"]["element"])
        run = self.json("run", "chosen.json", "--backend", "cpu", "--steps", "1")
        self.assertEqual(run["nodes"], plan["choice"]["nodes"])
        self.assertAlmostEqual(run["dt"] / plan["choice"]["dt"], 1, delta=0.3)  # the step follows the deformation

    def test_errors_are_those_of_the_static_reference(self):
        plan = self.json("plan", self.scene(), "--tolerance", "0.01%", "--budget", "1s", *SMALL)
        self.assertFalse(plan["found"])
        self.assertIsNone(plan["choice"])
        errors = [t["error_l2"] for t in plan["trials"] if t["element"] == "hex8full"]
        self.assertGreater(len(errors), 1)
        self.assertLess(errors[-1], errors[0])
        self.assertLess(errors[-1], 0.2)

    def test_nothing_meets_both(self):
        plan = self.json("plan", self.scene(), "--tolerance", "20%", "--budget", "0.001us", *SMALL)
        self.assertFalse(plan["found"])
        self.assertIn(len(plan["nearest"]), (1, 2))
        self.assertLessEqual(plan["nearest"][0]["error_l2"], 0.2)

    def test_bad_input(self):
        self.refused("plan", self.scene(), "--tolerance", "2%%", words=["--tolerance", "2%%"])
        self.refused("plan", self.scene(), "--budget", "4 parsecs", words=["--budget", "4 parsecs"])
        self.refused("plan", self.scene(), "--reference", "1", words=["--reference", "1"])
        self.refused("plan", harness.SCENES / "two_bodies.json", words=["/bodies", "one body"])
        self.refused("plan", harness.SCENES / "beam_tet.json", words=["volume mesh"])


if __name__ == "__main__":
    harness.main()
