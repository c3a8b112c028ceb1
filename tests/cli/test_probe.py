"""pliant run --probe: a material point and where it goes."""
import csv

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


if __name__ == "__main__":
    harness.main()
