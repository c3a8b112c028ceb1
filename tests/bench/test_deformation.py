"""What `pliant bench deformation` writes: its members, the published sizes, the same bits on bit-exact backends; and its report, on these
rows and on rows made up here. No time is looked at."""
import json
import math
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from bench_harness import PLIANT, SOURCE, python_with_matplotlib, schema_errors

NODES = {"bunny": 2250, "apple": 2250, "liver": 2886, "kidney": 2886}
RATIO = {"bunny": 0.4, "apple": 0.6, "liver": 0.4, "kidney": 0.6}
TOTAL = {"bunny": 13.5, "apple": 16.2, "liver": 20.4, "kidney": 24.6}
COLUMNS = {"scene", "method", "backend", "nodes", "ratio", "ms_per_step", "ms_per_frame", "source_ms", "passes"}
FORCES = {"tled": {"tled"}, "flsm": {"flsm"}, "hybrid": {"tled", "flsm"}}


def pliant(*arguments):
    return subprocess.run([PLIANT, "bench", "deformation", "--quick", "--scenes", SOURCE / "scenes", *map(str, arguments)],
                          capture_output=True, text=True, timeout=500)


def made_up_rows(errors):
    """Parts scaling and accuracy; `errors` are those of the series, in their order, at every ratio."""
    same = {"scene": "liver", "backend": "cpu", "ms_per_step": 0.2, "spread": 0.01, "dt": 1e-3, "ms_per_frame": 3.4, "hash": "0" * 16}
    rows = []
    for nodes in (10000, 100000, 1000000):
        for width, limit in ((1, 45), (2, 50), (3, 60)):
            for cut in ("none", "plane", "random"):
                row = {**same, "part": "scaling", "method": "flsm", "nodes": nodes, "ratio": 0.0, "width": width, "cut": cut, "limit_ns": limit,
                       "ns_per_node": 40.0, "fraction": 0.5, "passes": []}
                rows.append({**row, "set_up_seconds": nodes * 1e-5} if cut == "none" else row)
    names = ("alpha of the scene", "stiffness matched", "stiffness matched, 2 substeps", "stiffness matched, nu = 0")
    for name, error in zip(names, errors):
        rows.append({**same, "part": "accuracy", "method": "tled", "nodes": 2898, "ratio": 1.0, "series": name, "substeps": 1})
        for ratio in (0.3, 0.5):
            rows.append({**same, "part": "accuracy", "method": "hybrid", "nodes": 2898, "ratio": ratio, "series": name, "substeps": 1,
                         "error_operational": error, "error_near_interface": error, "error_far": None, "near_share": 1.0, "error_flsm": 0.2,
                         "error_other_coupling": error, "coupling": "conservative", "speedup": 0.5})
    return rows


class Deformation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="pliant-deformation-")
        cls.out = Path(cls.folder.name) / "made"
        cls.done = pliant("--parts", "scenes", "--backends", "cpu", "--json", "-", "--out", cls.out)
        cls.twin = pliant("--parts", "scenes", "--only", "liver", "--backends", "auto", "--json", "-")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        for done in (self.done, self.twin):
            self.assertEqual(done.returncode, 0, done.stderr)
        self.result, self.on_device = json.loads(self.done.stdout), json.loads(self.twin.stdout)

    def test_every_row_has_its_members(self):
        self.assertEqual(schema_errors(self.result, "bench-deformation"), [])
        self.assertEqual({(r["scene"], r["method"]) for r in self.result["rows"]}, {(s, m) for s in NODES for m in FORCES})
        for row in self.result["rows"]:
            self.assertEqual(COLUMNS - set(row), set())
            self.assertEqual(row["source_ms"], TOTAL[row["scene"]])
            self.assertTrue(math.isclose(row["ms_per_frame"], row["ms_per_step"] * math.ceil(1 / 60 / row["dt"] - 1e-6), rel_tol=1e-9))
            self.assertEqual({p["kernel"].split("_")[0] for p in row["passes"]} & {"tled", "flsm"}, FORCES[row["method"]], row)
            self.assertTrue(all(p["us_per_launch"] > 0 and p["launches_per_step"] > 0 for p in row["passes"]), row)

    def test_sizes_are_the_sources(self):
        for row in self.result["rows"]:
            self.assertLess(abs(row["nodes"] / NODES[row["scene"]] - 1), 0.02, row)
            wanted = {"hybrid": RATIO[row["scene"]], "tled": 1, "flsm": 0}[row["method"]]
            self.assertLessEqual(abs(row["ratio"] - wanted), 0.02 * wanted, row)

    def test_bit_exact_backends_have_one_hash(self):
        exact = {b["name"] for b in self.result["machine"]["backends"] if b["bit_exact"]}
        self.assertIn("cpu", exact)
        hashes = set()
        for mine in self.on_device["rows"]:
            twin = next(r for r in self.result["rows"] if (r["scene"], r["method"]) == (mine["scene"], mine["method"]))
            if mine["backend"] in exact:
                self.assertEqual(mine["hash"], twin["hash"], mine["method"])
            hashes.add(mine["hash"])
        self.assertEqual(len(hashes), 3)  # else the hash would not look at the state

    def test_files_hold_the_same_rows(self):
        self.assertEqual(json.loads((self.out / "deformation.json").read_text()), self.result)
        self.assertEqual(len((self.out / "deformation.csv").read_text().splitlines()), 1 + len(self.result["rows"]))
        self.assertIn("bench/report/report.py", self.done.stderr)

    def test_refusals_name_the_option_and_the_value(self):
        for arguments, words in ((("--only", "heart"), ("--only", "heart", "bunny")), (("--parts", "colour"), ("--parts", "colour", "scaling")),
                                 (("--sizes", 3), ("--sizes", "3")), (("--ratios", 1.5), ("--ratios", "1.5"))):
            done = pliant(*arguments)
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            for word in words:
                self.assertIn(word, done.stderr)
        done = subprocess.run([PLIANT, "bench", "deformation", "--scenes", self.folder.name], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("holds no liver_hybrid.json", done.stderr)

    def report(self, name, rows):
        folder = Path(self.folder.name) / name
        folder.mkdir()
        (folder / "deformation.json").write_text(json.dumps({"machine": self.result["machine"], "rows": rows}))
        python = python_with_matplotlib()
        if python is None:
            self.skipTest("no Python here has matplotlib (Debian: python3-matplotlib)")
        done = subprocess.run([python, SOURCE / "bench" / "report" / "report.py", folder], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        for file in folder.glob("*.svg"):
            ElementTree.parse(file)
            self.assertTrue(file.with_suffix(".png").read_bytes().startswith(b"\x89PNG"))
        return {f.stem for f in folder.glob("*.svg")}, (folder / "report.html").read_text()

    def test_report(self):
        rows = self.on_device["rows"] + self.result["rows"] + made_up_rows((0.5, 0.1, 0.1, 0.05))
        self.assertEqual(schema_errors({"machine": {}, "rows": rows}, "bench-deformation"), [])
        charts, page = self.report("all", rows)
        self.assertEqual(charts, {f"deformation_{c}" for c in ("scenes", "split", "scaling", "set_up", "error")})
        self.assertEqual(page.count("<svg"), 5)
        if len({r["backend"] for r in rows if r["part"] == "scenes"}) > 1:
            self.assertIn("Same bits", page)
        # 0.5^2 = 0.25: the stiffness takes 0.24 of it, Poisson's ratio 0.0075 and the coupling 0.0025.
        self.assertIn("96&#8239;% come from the mismatch of stiffness, 3&#8239;% from Poisson's ratio and 1&#8239;% from the coupling", page)
        self.assertIn("25&#8239;% of what is left", page)
        self.assertIn("8 of 8 hybrids take longer per step", page)

    def test_report_of_one_part_and_of_causes_that_cancel(self):
        charts, page = self.report("cancel", [r for r in made_up_rows((0.5, 0.1, 0.1, 0.2)) if r["part"] == "accuracy"])
        self.assertEqual(charts, {"deformation_error"})
        self.assertIn("100&#8239;% of what is left", page)
        self.assertIn("At ratio 0.3, 0.5 a material without lateral contraction has a larger error", page)


if __name__ == "__main__":
    unittest.main(verbosity=2)
