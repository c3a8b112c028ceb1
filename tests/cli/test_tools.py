#!/usr/bin/env python3
"""Tools through the command: what a run says of their forces, in its text, its JSON and its table."""
import csv
import json

from harness import CliTest, main


def ball(name, z, far=0.2):
    """A sphere of 20 mm that comes along z, at half the cube's height."""
    return {"name": name, "shape": {"sphere": 0.02}, "friction": 0.2, "path": [[0, 0, 0, far], [0.1, 0, 0, z]]}


class Tools(CliTest):
    def test_forces_in_text_json_and_table(self):
        table = {"name": "table", "shape": {"half_space": [[0, -0.052, 0], [0, 1, 0]]}, "friction": 0.5}
        scene = self.scene(body={"prescribed": [], "fixed": []}, tools=[table, ball("probe", 0.065), ball("far", 0.2)], duration=1)
        run = self.json("run", scene, "--backend", "cpu", "--out", "out")
        by_name = {tool["name"]: tool for tool in run["tools"]}
        self.assertEqual([tool["name"] for tool in run["tools"]], ["table", "probe", "far"])
        weight = 1e-3 * 1000 * 9.81
        self.assertAlmostEqual(by_name["table"]["force"][1] / -weight, 1, delta=0.1)
        self.assertGreater(by_name["probe"]["max_force"], 0.1)
        self.assertEqual((by_name["far"]["max_force"], by_name["far"]["steps_in_contact"]), (0, 0))
        self.assertLess(run["contact"]["penetration_in_cells"], 0.5)
        self.assertFalse([remark for remark in run["remarks"] if "cells deep" in remark])
        with open(self.folder / "out" / "scene_tools.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["tool"] for row in rows}, set(by_name))
        last = [row for row in rows if row["tool"] == "table"][-1]
        self.assertAlmostEqual(float(last["fy [N]"]), by_name["table"]["force"][1], places=6)
        self.assertEqual(float(last["work [J]"]), 0, "the table stands")
        pushed = [float(row["work [J]"]) for row in rows if row["tool"] == "probe"]
        self.assertAlmostEqual(pushed[-1], by_name["probe"]["work"], places=9)
        self.assertTrue(0 < by_name["probe"]["work"] < by_name["probe"]["max_force"] * 0.035)
        self.assertLess(run["contact"]["energy_created"], 0.01)
        self.assertFalse([remark for remark in run["remarks"] if "energy" in remark])
        done = self.pliant("run", scene, "--backend", "cpu")
        self.assertIn("tool table: force [", done.stdout)
        self.assertIn("; did 0 J", done.stdout)

    def test_a_tool_deep_in_held_tissue_is_told(self):
        # The side that it meets is held: nothing gives way.
        held = self.scene(body={"prescribed": [], "fixed": [{"plane": [[0, 0, 0.01], [0, 0, 1]]}]}, tools=[ball("probe", 0.05)], duration=0.15)
        run = self.json("run", held, "--backend", "cpu")
        self.assertGreater(run["contact"]["penetration_in_cells"], 0.5)
        told = [remark for remark in run["remarks"] if "cells deep into tissue" in remark]
        self.assertEqual(len(told), 1)
        self.assertIn("tool 'probe' went ", told[0])

    def test_tissue_on_tissue(self):
        # The same cube twice, one above the other.
        with open(self.folder / self.scene(body={"prescribed": [], "name": "low"}, contact={"friction": 0.3}, duration=0.5)) as file:
            scene = json.load(file)
        high = dict(scene["bodies"][0], name="high", fixed=[], translate=[0, 0.101, 0])
        scene["bodies"].append(high)
        scene["gravity"] = [0, -9.81, 0]
        (self.folder / "two.json").write_text(json.dumps(scene))
        run = self.json("run", "two.json", "--backend", "cpu")
        self.assertEqual(run["tools"], [])
        self.assertGreater(run["contact"]["touching"], 20)
        self.assertLess(run["contact"]["penetration_in_cells"], 0.1)
        self.assertIn("contact points touch other tissue", self.pliant("run", "two.json", "--backend", "cpu").stdout)
        scene["bodies"][1]["translate"] = [0, 0.05, 0]
        (self.folder / "two.json").write_text(json.dumps(scene))
        refused = self.pliant("run", "two.json", "--backend", "cpu", expect=2)
        self.assertIn("/contact: body 'high' begins inside body 'low'", refused.stderr)


if __name__ == "__main__":
    main()
