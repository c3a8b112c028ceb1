#!/usr/bin/env python3
"""Tools through the command: what a run says of their forces, in its text, its JSON and its table."""
import csv
import json
import math
import re

from harness import SCENES, CliTest, main


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

    def thrown(self, **keys):
        """The cube thrown on a table faster than its step stands, so that batches are made again."""
        table = {"name": "table", "shape": {"half_space": [[0, -0.055, 0], [0, 1, 0]]}}
        body = {"prescribed": [], "fixed": [], "velocity": [0, -3, 0]}
        probe = {"name": "all", "all": True, "quantities": ["energy"]}
        return self.scene(body=body, tools=[table], gravity=[0, 0, 0], duration=0.06, probes=[probe], **keys)

    def test_what_was_taken_back_is_seen_nowhere(self):
        scene = self.thrown()
        run = self.json("run", scene, "--backend", "cpu", "--out", "out", "--every", "1")
        with open(self.folder / "out" / "scene_all.csv") as file:
            rows = list(csv.DictReader(file))
        steps = [int(row["step"]) for row in rows]
        self.assertEqual(steps, list(range(run["steps"] + 1)))
        times = [float(row["time [s]"]) for row in rows]
        self.assertEqual(times, sorted(set(times)))
        energies = [float(row["kinetic [J]"]) + float(row["strain [J]"]) for row in rows]
        # It pushed a few elements through themselves, and the first step of a batch is made anew from a calmed state.
        self.assertLess(max(energies), 1.01 * energies[0])
        self.assertLess(sum(run["probes"][0]["energy"].values()), 1.01 * energies[0])
        self.assertEqual(len([name for name in self.names("out") if name.startswith("scene_0")]), len(steps))
        # Each batch was a step: what the run says of all of them is what the table holds.
        with open(self.folder / "out" / "scene_tools.csv") as file:
            table = list(csv.DictReader(file))
        force = [sum(float(row[f"f{axis} [N]"]) ** 2 for axis in "xyz") ** 0.5 for row in table]
        self.assertAlmostEqual(run["tools"][0]["max_force"] / max(force), 1, places=6)
        self.assertAlmostEqual(run["tools"][0]["max_penetration"] / max(float(row["penetration [m]"]) for row in table), 1, places=6)

    def test_the_end_of_a_run_is_on_the_way_of_a_longer_one(self):
        scene = self.thrown()
        whole = self.json("run", scene, "--backend", "cpu", "--steps", "80", "--out", "out", "--every", "1")
        self.json("run", scene, "--backend", "cpu", "--steps", "12", "--checkpoint", "c.pckpt", "--out", "short", "--every", "1")
        ends = (self.folder / "out" / "scene_00000012.vtu", self.folder / "short" / "scene_00000012.vtu")
        self.assertEqual(ends[0].read_bytes(), ends[1].read_bytes())
        rest = self.json("run", scene, "--backend", "cpu", "--steps", "68", "--resume", "c.pckpt")
        self.assertEqual(rest["deep_hash"], whole["deep_hash"])

    def test_names_in_tables(self):
        scene = self.scene(tools=[ball('a "tool", far', 0.2)], duration=0.02)
        self.json("run", scene, "--backend", "cpu", "--out", "out")
        with open(self.folder / "out" / "scene_tools.csv") as file:
            self.assertEqual({row["tool"] for row in csv.DictReader(file)}, {'a "tool", far'})

    def test_silence_is_told(self):
        thin = {"name": "needle", "shape": {"capsule": [[0, 0, 0], [0, 0.1, 0], 0.004]}, "path": [[0, 0, 0.06, 0]]}
        scene = self.scene(tools=[ball("far", 0.2), thin], duration=0.02)
        remarks = self.json("run", scene, "--backend", "cpu")["remarks"]
        self.assertEqual(len([r for r in remarks if "tool 'far' has touched nothing until" in r]), 1)
        self.assertEqual(len([r for r in remarks if "tool 'needle' is 0.008 m thin, and points of contact are 0.01 m apart" in r]), 1)
        self.assertIn("tool 'far' has touched nothing", self.pliant("run", scene, "--backend", "cpu").stderr)

    def pressed(self, damping, **keys):
        """A sphere that is pressed 10 mm into the cube, whose foot is held, in a tenth of a second."""
        body = {"prescribed": [], "lattice": {"spacing": 0.01}, "material": {"young": 3000, "poisson": 0.4, "density": 1000, "damping": damping}}
        return self.scene(body=body, tools=[dict(ball("probe", 0.06, 0.071), friction=0)], gravity=[0, 0, 0], **keys)

    def test_damping_in_the_force_of_a_tool_is_told(self):
        def told(*run):
            return [r for r in self.json("run", *run, "--backend", "cpu")["remarks"] if "\"damping\" causes most" in r]

        self.assertEqual(len(told(self.pressed(100, duration=0.1))), 1)
        self.assertEqual(told(self.pressed(0, duration=0.1)), [])
        self.assertEqual(told(self.pressed(100, duration=2)), [])

    def test_relaxation_finds_the_force_of_a_slow_press(self):
        for tissue in (False, True):
            keys = {"contact": {"friction": 0}} if tissue else {}
            slow = self.json("run", self.pressed(40, duration=3, **keys), "--backend", "cpu")
            rest = self.json("run", self.pressed(0, relaxation={"tolerance": 1e-4}, **keys), "--backend", "cpu")
            self.assertTrue(rest["converged"])
            self.assertLess(rest["steps"], slow["steps"])
            for axis in (1, 2):
                self.assertAlmostEqual(rest["tools"][0]["force"][axis], slow["tools"][0]["force"][axis], delta=0.005 * slow["tools"][0]["max_force"])

    def test_a_tool_deep_in_held_tissue_is_told(self):
        # The side that it meets is held: nothing gives way.
        held = self.scene(body={"prescribed": [], "fixed": [{"plane": [[0, 0, 0.01], [0, 0, 1]]}]}, tools=[ball("probe", 0.05)], duration=0.15)
        run = self.json("run", held, "--backend", "cpu")
        self.assertGreater(run["contact"]["penetration_in_cells"], 0.5)
        told = [remark for remark in run["remarks"] if "cells deep into tissue" in remark]
        self.assertEqual(len(told), 1)
        self.assertIn("tool 'probe' went ", told[0])

    def test_interpenetration(self):
        # A ball of 20 mm comes 10 mm deep into a cube that is held as a whole, and a second cube overlaps its corner.
        corners = [(x, y, z) for z in (-0.12, -0.02) for y in (0.03, 0.13) for x in (0.04, 0.14)]
        faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"]
        (self.folder / "other.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {f}\n" for f in faces))
        other = {"name": "other", "surface": "other.obj"}
        held = {"prescribed": [], "fixed": [{"all": True}]}
        probes = [{"name": "ball", "between": ["probe", "cube"]}, {"name": "all", "between": ["cube"], "quantities": ["interpenetration"]}]
        path = self.scene(body=held, tools=[ball("probe", 0.06)], duration=0.12, dt=0.001, probes=probes)
        scene = json.loads(path.read_text())
        scene["bodies"].append({**scene["bodies"][0], **other})
        path.write_text(json.dumps(scene))
        run = self.json("run", path, "--backend", "cpu", "--out", "out")
        found = {(i["first"], i["second"]): i for i in run["interpenetrations"]}
        self.assertEqual(list(found), [("probe", "cube"), ("cube", "other")])
        tool = found["probe", "cube"]
        cap = math.pi * 0.01 ** 2 * (0.06 - 0.01) / 3
        self.assertAlmostEqual(tool["volume"] / cap, 1, delta=1e-3)
        self.assertAlmostEqual(tool["depth"], 0.01, delta=1e-5)
        self.assertAlmostEqual(tool["area"][0] / (2 * math.pi * 0.02 * 0.01), 1, delta=1e-3)
        self.assertEqual((tool["tool"], run["no_closed_surface"]), (True, []))
        self.assertAlmostEqual(found["cube", "other"]["volume"] / 6e-6, 1, delta=1e-4)
        self.assertAlmostEqual(found["cube", "other"]["centroid"][1], 0.04, delta=1e-6)
        by_name = {p["name"]: p for p in run["probes"]}
        self.assertEqual(by_name["ball"]["interpenetration"], {key: tool[key] for key in by_name["ball"]["interpenetration"]})
        self.assertAlmostEqual(by_name["all"]["interpenetration"]["volume"] / (cap + 6e-6), 1, delta=1e-3)
        with open(self.folder / "out" / "scene_ball.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual((float(rows[0]["volume [m^3]"]), rows[0]["centroid x [m]"]), (0, "nan"))
        self.assertAlmostEqual(float(rows[-1]["volume [m^3]"]), tool["volume"], delta=1e-12)
        self.assertAlmostEqual(float(rows[-1]["deepest z [m]"]), tool["deepest"][2], delta=1e-8)
        self.assertIn("tool probe in body cube: ", self.pliant("run", path, "--backend", "cpu").stdout)
        told = self.pliant("info", path).stdout
        self.assertIn("probe ball: interpenetration of probe and cube", told)
        self.assertEqual(self.json("info", path)["probes"][0], {"name": "ball", "between": ["probe", "cube"], "quantities": ["interpenetration"]})

    def test_a_blade_that_cuts_by_force_has_rows(self):
        run = self.json("run", str(SCENES / "incise.json"), "--steps", "150", "--backend", "cpu", "--out", "out")
        with open(self.folder / "out" / "incise_tools.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["tool"] for row in rows}, {"scalpel"})
        blade = run["blades"][0]
        self.assertGreater(blade["force"][1], 1)
        self.assertAlmostEqual(float(rows[-1]["fy [N]"]), blade["force"][1], places=6)
        self.assertAlmostEqual(float(rows[-1]["work [J]"]), blade["work"], places=9)
        self.assertLess(float(rows[-1]["y [m]"]), float(rows[0]["y [m]"]))

    def test_attempts_of_a_blade_in_json_and_table(self):
        scalpel = {"name": "a,b", "cuts": "by-force", "edge": 0.0002, "path": [[0, -0.056, 0.035, -0.023, -0.056, 0.065, -0.023],
                                                                           [0.4, 0.036, 0.035, 0.0175, 0.036, 0.065, 0.0175]]}
        material = {"law": "neo-hookean", "young": 20000, "poisson": 0.4, "density": 1000, "damping": 60, "toughness": 10000}
        body = {"lattice": {"spacing": 0.01}, "material": material, "fixed": [{"plane": [[0, 0.02, 0], [0, -1, 0]]}], "prescribed": []}
        scene = self.scene(body=body, blades=[scalpel], duration=0.4)
        run = self.json("run", scene, "--backend", "cpu", "--out", "out")
        blade = run["blades"][0]
        attempts = blade["cut_attempts"]
        self.assertEqual(blade["attempts"], len(attempts))
        self.assertGreater(len(attempts), 8)
        self.assertEqual({a["stroke"] for a in attempts} - set(range(blade["strokes"])), set())
        self.assertEqual({a["body"] for a in attempts}, {"cube"})
        for before, after in zip(attempts, attempts[1:]):
            self.assertLessEqual(before["time"], after["time"])
            if before["stroke"] == after["stroke"]:
                self.assertEqual(before["to"], after["from"])
        self.assertTrue(attempts[-1]["gave_way"])
        with open(self.folder / "out" / "scene_attempts.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["blade"], int(row["from"]), int(row["to"]), row["gave way"]) for row in rows],
                         [("a,b", a["from"], a["to"], "1" if a["gave_way"] else "0") for a in attempts])
        self.assertAlmostEqual(float(rows[-1]["x [m]"]), attempts[-1]["position"][0], places=8)
        # The run goes on from its middle with what it knew there.
        self.json("run", scene, "--backend", "cpu", "--seconds", "0.2", "--checkpoint", "c.pckpt")
        self.assertEqual(self.json("run", scene, "--backend", "cpu", "--resume", "c.pckpt")["blades"], run["blades"])

    def test_faces_of_a_blade_have_rows_of_their_own(self):
        run = self.json("run", str(SCENES / "spread.json"), "--steps", "400", "--backend", "cpu", "--out", "out")
        with open(self.folder / "out" / "spread_tools.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["tool"] for row in rows}, {"scalpel", "scalpel (faces)"})
        self.assertNotIn("tools", run)
        blade = run["blades"][0]
        faces = blade["faces"]
        self.assertGreater(faces["normal"], 0.1)
        self.assertGreater(faces["points"], 20)
        self.assertGreater(blade["work"], faces["work"])
        whole, own = rows[-2:]
        self.assertAlmostEqual(float(whole["fy [N]"]), blade["force"][1], places=6)
        self.assertAlmostEqual(float(own["fy [N]"]), faces["force"][1], places=6)
        self.assertAlmostEqual(float(own["work [J]"]), faces["work"], places=9)
        self.assertGreater(float(own["area [m^2]"]), 1e-4)

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
        for up, message in ((0.05, "body 'high' begins inside body 'low'"), (0.002, "body 'high' begins in the same place as body 'low'")):
            scene["bodies"][1]["translate"] = [0.002, up, 0.002]
            (self.folder / "two.json").write_text(json.dumps(scene))
            refused = self.pliant("run", "two.json", "--backend", "cpu", expect=2)
            self.assertIn("/contact: " + message, refused.stderr)

    def test_a_tool_that_begins_wholly_inside_is_refused(self):
        for shape in ({"sphere": 0.01}, {"box": [0.02, 0.02, 0.02]}, {"capsule": [[0, -0.01, 0], [0, 0.01, 0], 0.005]},
                      {"mesh": str(SCENES / "meshes" / "cube.obj")}):
            tool = {"name": "t", "shape": shape}
            if "mesh" in shape:
                tool["scale"] = 0.1
            refused = self.pliant("run", self.scene(tools=[tool], duration=0.01), "--backend", "cpu", expect=2)
            told = re.search(r"/tools/0: tool 't' begins inside body 'cube', ([0-9.]+) m deep", refused.stderr)
            self.assertIsNotNone(told, refused.stderr)
            self.assertGreater(float(told[1]), 0.04)


if __name__ == "__main__":
    main()
