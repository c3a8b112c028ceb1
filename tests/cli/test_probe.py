"""pliant run --probe: a material point and where it goes."""
import csv
import json
import math

import harness
GRAVITY = 9.81
BLADE = {"name": "b", "path": [[0, -0.1, 0.013, 0.08, 0.1, 0.013, 0.08], [0.05, -0.1, 0.013, -0.08, 0.1, 0.013, -0.08]]}
FALLING = {"prescribed": [], "fixed": []}


class Probe(harness.CliTest):
    def run_probes(self, scene, *arguments):
        run = self.json("run", scene, "--backend", "cpu", *arguments)
        return {p["name"]: p for p in run["probes"]}, run

    def near(self, found, expected, delta):
        for a, b in zip(found, expected):
            self.assertAlmostEqual(a, b, delta=delta)

    def test_free_fall(self):
        """Each point of a falling body has the same motion, in lattices, their tetrahedra and shape matching."""
        for body in ({}, {"element": "tet4"}, {"element": "hex8full"}, {"model": {"type": "flsm"}}):
            body = {**FALLING, "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000}, **body}
            probes, run = self.run_probes(self.scene(body=body, dt=0.001), "--steps", 50, "--probe", "a=0.013,-0.021,0.047",
                                          "--probe=b=-0.05,0.05,-0.05")
            self.assertEqual(list(probes), ["a", "b"])
            self.assertEqual((probes["a"]["rest"], probes["a"]["body"]), ([0.013, -0.021, 0.047], "cube"))
            fall = -0.5 * GRAVITY * run["time"] ** 2
            for p in probes.values():
                self.near(p["displacement"], [0, fall, 0], 1e-5)
                self.near(p["velocity"], [0, -GRAVITY * run["time"], 0], 1e-2)
                self.near(p["position"], [x + d for x, d in zip(p["rest"], p["displacement"])], 1e-12)

    def test_interpolation_inside_an_element(self):
        """The held lower side rests, the pressed upper side moves as prescribed, and between them all is in between."""
        probes, _ = self.run_probes(self.scene(), "--seconds", 0.3, "--probe", "low=0.012,-0.05,0.013", "--probe", "high=0.012,0.05,0.013",
                                    "--probe", "a=0.013,0.035,0.002", "--probe", "b=0.013,0.045,0.002", "--probe", "m=0.013,0.04,0.002")
        self.near(probes["low"]["displacement"], [0, 0, 0], 1e-12)
        self.near(probes["high"]["displacement"], [0, -0.01, 0], 1e-7)
        a, b, m = (probes[n]["displacement"] for n in "abm")
        self.near(m, [(x + y) / 2 for x, y in zip(a, b)], 1e-9)  # one cell, linear along an axis
        self.assertGreater(abs(a[1] - b[1]), 1e-6)

    def test_rows_and_frames(self):
        probes, run = self.run_probes(self.scene(dt=0.002), "--steps", 25, "--every", 10, "--out", "out", "--probe", "p=0.01,0.05,0.01",
                                      "--probe", "q=0,0,0")
        with open(self.folder / "out" / "scene_probes.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(int(r["step"]), r["probe"]) for r in rows], [(s, n) for s in (0, 10, 20, 25) for n in "pq"])
        for axis, name in enumerate("xyz"):
            for row, probe in ((rows[-2], probes["p"]), (rows[-1], probes["q"])):
                self.assertAlmostEqual(float(row[name]), probe["position"][axis], delta=1e-8)
                self.assertAlmostEqual(float(row["u" + name]), probe["displacement"][axis], delta=1e-8)
                self.assertAlmostEqual(float(row["v" + name]), probe["velocity"][axis], delta=1e-6)
        self.assertAlmostEqual(float(rows[-1]["time"]), run["time"])
        plain = self.json("run", self.scene(dt=0.002), "--backend", "cpu", "--steps", 25)
        self.assertEqual(plain["deep_hash"], run["deep_hash"])
        self.assertNotIn("probes", plain)

    def test_goes_with_its_side_of_a_cut(self):
        """The blade divides the cells at y = 0.013. Above it the cube is lifted off, below it is held."""
        lifted = {"prescribed": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, 0.1, 0], "curve": "smooth", "start": 0.06,
                                  "duration": 0.2}]}
        for element in ("hex8", "tet4"):
            scene = self.scene(body={**lifted, "element": element}, gravity=[0, 0, 0], blades=[BLADE])
            probes, run = self.run_probes(scene, "--seconds", 0.5, "--probe", "above=0.001,0.016,0.002", "--probe", "below=0.001,0.0105,0.002")
            self.assertEqual(run["pieces"], 2)
            self.assertGreater(probes["above"]["displacement"][1], 0.08)
            self.assertLess(abs(probes["below"]["displacement"][1]), 0.02)

    def test_refused(self):
        run = ("run", self.scene(), "--backend", "cpu", "--steps", 1, "--out", "out", "--probe")
        self.refused(*run, "tip=0,0.25,0", words=["tip", "in no body", "'cube'", "0.2 m"])
        self.refused(*run, "tip=0,0,0", "--probe", "tip=0,0,0.01", words=["two are named \"tip\""])
        for text in ("0,0,0", "=0,0,0", "tip=0,0", "tip=0,0,0,0", "tip=0,0,x", "tip=nan,0,0", "tip=0 0 0", "a,b=0,0,0"):
            self.refused(*run, text, words=[f"--probe is \"{text}\"", "NAME=x,y,z"])
        self.assertFalse((self.folder / "out").exists() and self.names("out"))
        self.refused("run", harness.SCENES / "beam_static.json", "--probe", "a=0,0,0", words=["--probe", "static"])


class SceneProbes(harness.CliTest):
    """The probes of a scene: tables of their own, reactions and stresses."""

    def of(self, scene, *arguments):
        run = self.json("run", scene, "--backend", "cpu:double", *arguments)
        return {p["name"]: p for p in run["probes"]}, run

    def near(self, found, expected, delta):
        self.assertEqual(len(found), len(expected))
        for a, b in zip(found, expected):
            self.assertAlmostEqual(a, b, delta=delta)

    def test_reactions_at_rest_carry_the_weight(self):
        """Once gravity, which comes slowly, has its final value; in lattices, their tetrahedra, and full cells."""
        for element in ("hex8", "tet4", "hex8full"):
            scene = self.scene(body={"element": element, "prescribed": []}, relaxation={"tolerance": 1e-7},
                               gravity={"acceleration": [3, -9.81, 0], "curve": "smooth", "duration": 0.05},
                               probes=[{"name": "floor", "all": True, "quantities": ["reaction"]},
                                       {"name": "middle", "box": [[-1, -0.001, -1], [1, 0.04, 1]], "quantities": ["reaction"]}])
            probes, run = self.of(scene)
            self.assertTrue(run["converged"])
            self.near(probes["floor"]["reaction"], [-3 * run["mass"], GRAVITY * run["mass"], 0], 1e-4 * GRAVITY * run["mass"])
            self.assertEqual(probes["middle"]["reaction"], [0, 0, 0])  # nothing holds these nodes
            self.assertEqual(list(probes["floor"]), ["name", "body", "reaction"])

    def test_reactions_are_those_of_the_static_solver(self):
        body = {"element": "tet4"}
        push = {"name": "push", "plane": [[0, 0.049, 0], [0, 1, 0]], "quantities": ["reaction"]}
        hold = {"name": "hold", "plane": [[0, -0.049, 0], [0, -1, 0]], "quantities": ["reaction"]}
        relaxed, _ = self.of(self.scene(body=body, relaxation={"tolerance": 1e-7}, probes=[push, hold]))
        static = json.loads(self.pliant("run", self.scene(body=body, solver={"type": "static"}), "--json", "-").stdout)["bodies"][0]["reactions"]
        by_entry = {r["at"]: r for r in static}
        for name, entry in (("hold", "/bodies/0/fixed/0"), ("push", "/bodies/0/prescribed/0")):
            self.near(relaxed[name]["reaction"], by_entry[entry]["force"], 2e-4)

    def test_force_is_the_weight_and_the_loads(self):
        """Of every element, with inertia that has no weight (blades), of half of the loads' ramp; and at rest minus the reaction."""
        push = {"forces": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "force": [0.5, 0, 0.25], "curve": "ramp", "duration": 0.02}]}
        force = {"name": "all", "all": True, "quantities": ["force"]}
        blade = {"name": "b", "path": [[1, 0.013, 0.08, -0.1, 0.013, 0.08, 0.1], [2, 0.013, -0.08, -0.1, 0.013, -0.08, 0.1]]}
        ball = {"surface": str(harness.SCENES / "meshes" / "apple.obj"), "lattice": {"nodes": 600}, "prescribed": [], "fixed": []}
        for body, keys in (({"element": "hex8"}, {}), ({"element": "tet4"}, {}), ({"element": "hex8full"}, {}), (ball, {}),
                           (ball, {"blades": [blade]})):
            probes, run = self.of(self.scene(body={"prescribed": [], **body}, dt=1e-5, probes=[force], **keys), "--steps", 3)
            self.near([f / (GRAVITY * run["mass"]) for f in probes["all"]["force"]], [0, -1, 0], 1e-6)
        self.assertGreater(run["added_mass"], 1e-6 * run["mass"])  # of the last, which cells that a blade may cut have
        probes, run = self.of(self.scene(body={"prescribed": [], **push}, dt=1e-4, probes=[force]), "--steps", 100)
        self.near(probes["all"]["force"], [0.25, -GRAVITY * run["mass"], 0.125], 1e-6)
        low = {"name": "low", "box": [[-1, -0.051, -1], [1, -0.029, 1]], "quantities": ["force", "position"]}  # two of six planes of nodes
        probes, run = self.of(self.scene(body={"prescribed": []}, dt=1e-4, probes=[low]), "--steps", 2)
        self.near(probes["low"]["force"], [0, -GRAVITY * run["mass"] * 1.5 / 5, 0], 1e-6)
        press = {"pressures": [{"plane": [[0, 0.0499, 0], [0, 1, 0]], "pressure": 100}]}
        held = {"name": "held", "plane": [[0, -0.049, 0], [0, -1, 0]], "quantities": ["reaction"]}
        probes, run = self.of(self.scene(body={"prescribed": [], **push, **press}, relaxation={"tolerance": 1e-8}, probes=[force, held]))
        self.near([a + b for a, b in zip(probes["all"]["force"], probes["held"]["reaction"])], [0, 0, 0], 1e-4)
        self.assertGreater(-probes["all"]["force"][1], GRAVITY * run["mass"] + 0.9)

    def test_energy(self):
        """Kinetic of a falling body, elastic of one that is stretched evenly, of all of it and of three of its five layers."""
        energy = [{"name": "all", "all": True, "quantities": ["energy"]},
                  {"name": "part", "box": [[-1, -0.051, -1], [1, 0.011, 1]], "quantities": ["energy", "velocity"]}]
        free = {"prescribed": [], "fixed": [], "material": {"young": 3000, "poisson": 0.4}}
        probes, run = self.of(self.scene(body=free, dt=1e-4, probes=energy), "--steps", 400)
        speed = probes["part"]["velocity"][1]
        self.assertAlmostEqual(probes["all"]["energy"]["kinetic"] / (run["mass"] * speed ** 2 / 2), 1, delta=1e-9)
        self.assertAlmostEqual(probes["part"]["energy"]["kinetic"] / (0.7 * run["mass"] * speed ** 2 / 2), 1, delta=1e-6)  # 3.5 of 5
        self.assertLess(abs(probes["all"]["energy"]["strain"]), 1e-12)
        mu, lame, stretch = 3000 / 2.8, 3000 * 0.4 / (1.4 * 0.2), 1.2
        density = mu / 2 * (stretch ** 2 - 1) - mu * math.log(stretch) + lame / 2 * (stretch - 1) ** 2
        pulled = [{"all": True, "displacement": {"linear": [[0, 0, 0], [0, stretch - 1, 0], [0, 0, 0]]}}]
        for element in ("hex8", "tet4", "tet4anp", "hex8full"):
            scene = self.scene(body={**free, "element": element, "initial": pulled}, gravity=[0, 0, 0], dt=1e-7, probes=energy)
            self.of(scene, "--steps", 1, "--out", element)
            for name, share in (("all", 1), ("part", 0.6)):
                with open(self.folder / element / f"scene_{name}.csv", newline="") as file:
                    row = next(csv.DictReader(file))
                self.assertEqual(row["step"], "0")
                self.assertLess(float(row["kinetic [J]"]), 1e-10)  # of half a step
                self.assertAlmostEqual(float(row["strain [J]"]) / (share * 1e-3 * density), 1, delta=1e-6)

    def test_of_nodes_of_finite_elements_alone(self):
        for quantity in ("reaction", "energy"):
            probe = {"name": "p", "all": True, "quantities": [quantity]}
            self.refused("run", self.scene(body={"model": {"type": "flsm"}}, probes=[probe]), words=["/probes/0", quantity, "flsm"])
        for quantity in ("reaction", "force", "energy"):
            self.refused("run", self.scene(probes=[{"name": "p", "point": [0, 0, 0], "quantities": [quantity]}]),
                         words=[f"/probes/0/quantities/0: got \"{quantity}\", expected no {quantity} of a point"])

    def test_what_turns_a_body_has_its_inertia(self):
        """All nodes of a cube circle about an axis at a constant rate: what moves them is m w^2 r, inwards, and what its damping takes."""
        turn = {"all": True, "rotate": {"axis": [0, 0, 1], "about": [-0.3, 0, 0], "angle": 360}, "curve": "ramp", "duration": 0.5}
        scene = self.scene(body={"fixed": [], "prescribed": [turn]}, gravity=[0, 0, 0], dt=0.0005,
                           probes=[{"name": "all", "all": True, "quantities": ["position", "velocity", "reaction"]}])
        probes, run = self.of(scene, "--seconds", 0.125)
        rate, m = 2 * 3.14159265358979 / 0.5, run["mass"]
        self.near(probes["all"]["position"], [-0.3, 0.3, 0], 1e-9)
        self.near(probes["all"]["velocity"], [-0.3 * rate, 0, 0], 2e-2)  # of the step before
        damping = 5 * m * 0.3 * rate  # of the cube's material, against the way
        self.near(probes["all"]["reaction"], [-damping, -m * rate ** 2 * 0.3, 0], 1e-3 * m * rate ** 2 * 0.3)

    def test_stress_of_a_confined_block(self):
        """Uniform, so that it has a closed form; and its reaction is that stress on the face."""
        young, poisson, stretch = 3000, 0.4, 0.9
        mu, lame = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        axial, side = mu * (stretch - 1 / stretch) + lame * (stretch - 1), lame * (stretch - 1)
        for element in ("hex8", "tet4"):
            scene = self.scene(body={"element": element, "fixed": [{"all": True, "axes": "xz"}, {"plane": [[0, -0.049, 0], [0, -1, 0]]}]},
                               gravity=[0, 0, 0], relaxation={"tolerance": 1e-8},
                               probes=[{"name": "p", "point": [0.013, 0.007, -0.021], "quantities": ["stress", "position", "green_strain", "almansi_strain"]},
                                       {"name": "top", "plane": [[0, 0.049, 0], [0, 1, 0]], "quantities": ["reaction"]}])
            probes, _ = self.of(scene)
            self.near(probes["p"]["stress"], [side, axial, side, 0, 0, 0], 2e-3 * abs(axial))
            self.assertAlmostEqual(probes["top"]["reaction"][1], axial * 0.01, delta=2e-3 * abs(axial * 0.01))
            self.near(probes["p"]["position"], [0.013, -0.05 + 0.057 * stretch, -0.021], 1e-6)
            self.near(probes["p"]["green_strain"], [0, (stretch ** 2 - 1) / 2, 0, 0, 0, 0], 1e-5)
            self.near(probes["p"]["almansi_strain"], [0, (1 - stretch ** -2) / 2, 0, 0, 0, 0], 2e-5)

    def test_tables(self):
        """A file for each probe with units in its header, at a pace of its own, which changes nothing."""
        probes = [{"name": "tip", "point": [0.01, 0.04, 0.01]},
                  {"name": "clamp", "plane": [[0, -0.049, 0], [0, -1, 0]], "quantities": ["reaction"]}]
        _, run = self.of(self.scene(dt=0.002, probes=probes, probe_every={"steps": 4}), "--steps", 10, "--every", 5, "--out", "a")
        for name, columns in (("tip", "x [m],y [m],z [m],ux [m],uy [m],uz [m],vx [m/s],vy [m/s],vz [m/s]"), ("clamp", "rx [N],ry [N],rz [N]")):
            with open(self.folder / "a" / f"scene_{name}.csv", newline="") as file:
                rows = list(csv.reader(file))
            self.assertEqual(",".join(rows[0]), "time [s],step," + columns)
            self.assertEqual([int(r[1]) for r in rows[1:]], [0, 4, 8, 10])
        last = {p["name"]: p for p in run["probes"]}["clamp"]["reaction"]
        self.near([float(v) for v in rows[-1][2:]], last, 1e-7)
        self.of(self.scene(dt=0.002, probes=probes, probe_every=0.01), "--steps", 10, "--out", "b")
        with open(self.folder / "b" / "scene_tip.csv", newline="") as file:
            self.assertEqual([int(r["step"]) for r in csv.DictReader(file)], [0, 5, 10])
        self.of(self.scene(dt=0.002, probes=probes), "--steps", 10, "--every", 5, "--out", "c")
        with open(self.folder / "c" / "scene_tip.csv", newline="") as file:
            self.assertEqual([int(r["step"]) for r in csv.DictReader(file)], [0, 5, 10])
        plain = self.json("run", self.scene(dt=0.002), "--backend", "cpu:double", "--steps", 10)
        self.assertEqual(plain["deep_hash"], run["deep_hash"])

    def test_refused(self):
        for keys, text in (({"probes": [{"name": "p", "point": [1, 0, 0]}]}, "/probes/0: [1, 0, 0] m is in no body at rest"),
                           ({"probes": [{"name": "p", "sphere": [[1, 0, 0], 0.1]}]}, "/probes/0: no node in this set"),
                           ({"probes": [{"name": "p", "all": True}], "solver": {"type": "static"}}, "/probes: got")):
            self.refused("run", self.scene(**keys), "--backend", "cpu", words=[text])


if __name__ == "__main__":
    harness.main()
