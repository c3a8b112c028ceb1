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

    def palpation(self, **material):
        tool = {"name": "ball", "shape": {"sphere": 0.03}, "path": [[0, 0, 0.08, 0], [0.1, 0, 0.07, 0], [0.4, 0, 0.07, 0]], "friction": 0.3}
        return self.scene("palpation", gravity=[0, 0, 0], duration=0.15, tools=[tool],
                          body={"prescribed": [], "material": {"young": 3000, "poisson": 0.4, "density": 1000, "damping": 20, **material}})

    def test_tools_are_compared_on_the_way(self):
        """In the scene's own words: what is written differs in lattice, element and model alone."""
        scene = self.palpation()
        plan = self.json("plan", scene, "--tolerance", "70%", "--budget", "1s", "--out", "chosen.json", "--seconds", 20, *SMALL)
        self.assertTrue(plan["found"])
        self.assertEqual(plan["compared"], {"seconds": 0.15, "times": 8})
        measured = [t for t in plan["trials"] if t["error_l2"] is not None]
        self.assertGreater(len(measured), 1)
        for trial in measured:
            self.assertGreater(trial["error_force"], 0)
            self.assertGreater(trial["error_l2"], 0)
        self.assertLess(min(t["error_force"] for t in measured), 0.5)
        self.assertEqual(plan["choice"]["ms_per_frame"], min(t["ms_per_frame"] for t in measured if t["error_l2"] <= 0.7))
        before, after = json.loads(scene.read_text()), json.loads((self.folder / "chosen.json").read_text())
        self.assertEqual(after["bodies"][0]["element"], plan["choice"]["element"])
        for key in ("lattice", "element", "model"):
            before["bodies"][0].pop(key, None), after["bodies"][0].pop(key, None)
        self.assertEqual(after, before)
        self.assertEqual(self.json("run", "chosen.json", "--backend", "cpu", "--steps", 1)["nodes"], plan["choice"]["nodes"])

    def test_files_are_found_from_elsewhere(self):
        """A scene with relative paths, whose copy lies in another folder."""
        (self.folder / "here").mkdir()
        (self.folder / "there").mkdir()
        (self.folder / "here" / "cube.obj").write_bytes((harness.SCENES / "meshes" / "cube.obj").read_bytes())
        scene = self.scene("here/scene", body={"surface": "cube.obj"}, dt=0.0005)
        self.json("plan", scene, "--tolerance", "30%", "--budget", "1s", "--out", "there/chosen.json", *SMALL)
        after = json.loads((self.folder / "there" / "chosen.json").read_text())
        self.assertNotIn("dt", after)
        self.assertEqual(after["bodies"][0]["material"], json.loads(scene.read_text())["bodies"][0]["material"])
        self.json("run", "there/chosen.json", "--backend", "cpu", "--steps", 1)

    def test_what_there_is_no_time_for_is_listed(self):
        """The reference takes all of a hundredth of a second, and one trial is always made."""
        scene = json.loads(self.palpation().read_text())
        scene["gravity"] = [0, -9.81, 0]
        (self.folder / "falls.json").write_text(json.dumps(scene))
        plan = self.json("plan", "falls.json", "--tolerance", "0.01%", "--budget", "1s", "--seconds", 0.01, *SMALL)
        self.assertIsNotNone(plan["trials"][0]["error_l2"])
        self.assertLess(plan["compared"]["seconds"], 0.15)
        self.assertIn("0.01 s are over (--seconds)", plan["trials"][-1]["remark"])

    def test_bad_input(self):
        self.refused("plan", self.scene(), "--seconds", 0, words=["--seconds is 0 s; expected more than 0"])
        self.refused("plan", self.scene(), "--tolerance", "2%%", words=["--tolerance", "2%%"])
        self.refused("plan", self.scene(), "--budget", "4 parsecs", words=["--budget", "4 parsecs"])
        self.refused("plan", self.scene(), "--reference", "1", words=["--reference", "1"])
        self.refused("plan", harness.SCENES / "two_bodies.json", words=["/bodies", "one body"])
        self.refused("plan", harness.SCENES / "beam_tet.json", words=["volume mesh"])


if __name__ == "__main__":
    harness.main()
