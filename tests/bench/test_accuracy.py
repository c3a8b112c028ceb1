"""What `pliant bench accuracy` writes: its members, errors that repeat to the bit, orders of convergence, fronts, resuming. No time is
compared with a limit."""
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PLIANT = os.environ.get("PLIANT", "pliant")
SCENES = Path(os.environ.get("PLIANT_SOURCE", Path(__file__).resolve().parents[2])) / "scenes"
ROW = {"problem", "method", "refine", "resolution", "nodes", "spacing", "dt", "step", "steps", "backend", "precision", "seconds",
       "ms_per_simulated_second", "ns_per_node_step", "spread", "change", "error_l2", "error_max", "order", "reference",
       "reference_error", "settled", "failure", "pareto"}
TIMES = {"seconds", "ms_per_simulated_second", "ns_per_node_step", "spread", "pareto"}
METHODS = ["tet4", "tet4anp", "hex8", "hex8full", "flsm-2", "hybrid-50"]


def pliant(*arguments, scenes=SCENES):
    return subprocess.run([PLIANT, "bench", "accuracy", "--quick", "--scenes", str(scenes), *map(str, arguments)], capture_output=True,
                          text=True, timeout=300)


def without_times(row):
    return {k: v for k, v in row.items() if k not in TIMES}


def key(row):
    return row["problem"], row["method"], row["refine"], row["step"], row["backend"]


class Accuracy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="pliant-accuracy-")
        cls.out = Path(cls.folder.name) / "made"
        # An interrupted run: one problem is there when the other is asked for.
        cls.first = pliant("--problems", "column", "--methods", "hex8", "--backends", "auto,cpu", "--out", cls.out)
        cls.kept = json.loads((cls.out / "accuracy.json").read_text()) if cls.first.returncode == 0 else None
        cls.done = pliant("--problems", "column,cantilever-0.3", "--backends", "auto,cpu", "--json", "-", "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.assertEqual(self.first.returncode, 0, self.first.stderr)
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.result = json.loads(self.done.stdout)
        self.rows = self.result["rows"]

    def series(self, problem, method):
        rows = [r for r in self.rows if (r["problem"], r["method"], r["step"], r["backend"]) == (problem, method, "0.9", "auto")]
        return sorted(rows, key=lambda r: r["resolution"])

    def test_every_row_has_its_members(self):
        self.assertEqual(sorted({r["method"] for r in self.rows}), sorted(METHODS))
        self.assertEqual([p["name"] for p in self.result["problems"]], ["column", "cantilever-0.3"])
        self.assertEqual(len({key(r) for r in self.rows}), len(self.rows))
        for row in self.rows:
            self.assertEqual(ROW - set(row), set(), row)
            self.assertEqual(set(row) - ROW - {"hash", "substeps"}, set(), row)
            if row["failure"] is not None:
                continue
            self.assertTrue(row["settled"] or row["change"] <= 2e-3, row)
            for name in ("nodes", "resolution", "spacing", "dt", "steps", "seconds", "ms_per_simulated_second", "ns_per_node_step",
                         "error_l2", "error_max"):
                self.assertTrue(math.isfinite(row[name]) and row[name] > 0, (name, row))
            self.assertTrue(math.isclose(row["ns_per_node_step"] * row["nodes"] * row["steps"] * 1e-9, row["seconds"], rel_tol=1e-9))
            self.assertTrue(math.isclose(row["ms_per_simulated_second"] * row["dt"] * row["steps"] / 1e3, row["seconds"], rel_tol=1e-9))

    def test_finite_elements_always_answer(self):
        for row in self.rows:
            if row["method"] in ("tet4", "tet4anp", "hex8", "hex8full", "hybrid-50"):
                self.assertIsNone(row["failure"], row)

    def test_orders_of_convergence(self):
        # Linear elements on a smooth problem: second order in displacements, against an exact answer.
        for method in ("tet4", "tet4anp", "hex8", "hex8full"):
            coarse, fine = self.series("column", method)
            self.assertIsNone(coarse["order"])
            self.assertAlmostEqual(fine["order"], 2, delta=0.25, msg=method)
            self.assertAlmostEqual(fine["order"], math.log2(coarse["error_l2"] / fine["error_l2"]), places=9)
            self.assertLess(fine["error_l2"], 0.004)
        # One-point hexahedra bend; tetrahedra of the same lattice hardly do.
        self.assertLess(self.series("cantilever-0.3", "hex8")[1]["error_l2"], 0.05)
        self.assertGreater(self.series("cantilever-0.3", "tet4")[1]["error_l2"], 0.15)

    def test_errors_repeat_to_the_bit(self):
        again = pliant("--problems", "column,cantilever-0.3", "--methods", "hex8,hybrid-50", "--backends", "auto,cpu", "--json", "-")
        self.assertEqual(again.returncode, 0, again.stderr)
        mine = {key(r): r for r in self.rows}
        rows = json.loads(again.stdout)["rows"]
        self.assertGreaterEqual(len(rows), 12)
        for row in rows:
            old = mine[key(row)]
            # json keeps doubles to the last bit
            self.assertEqual(without_times(row), without_times(old))

    def test_bit_exact_backends_have_the_same_errors(self):
        exact = {b["name"] for b in self.result["machine"]["backends"] if b["bit_exact"]}
        compared = 0
        for row in self.rows:
            if row["backend"] != "cpu" or "cpu" not in exact:
                continue
            other = next(r for r in self.rows if key(r) == (*key(row)[:4], "auto"))
            self.assertEqual((row["error_l2"], row["error_max"], row["hash"]), (other["error_l2"], other["error_max"], other["hash"]))
            compared += 1
        self.assertGreaterEqual(compared, 2 * len(METHODS))

    def test_fronts(self):
        floor = {p["name"]: p["floor"] for p in self.result["problems"]}

        def beats(a, b):
            x, y = (max(r["error_l2"], floor[r["problem"]]) for r in (a, b))
            s, t = (r["ms_per_simulated_second"] for r in (a, b))
            return x <= y and s <= t and (x, s) != (y, t)

        for problem in floor:
            rows = [r for r in self.rows if r["problem"] == problem and r["failure"] is None]
            self.assertTrue(any(r["pareto"] for r in rows), problem)
            for row in rows:
                best = row["error_l2"] < 1 and not any(beats(other, row) for other in rows)
                self.assertEqual(row["pareto"], best, row)
        for row in self.rows:
            self.assertFalse(row["pareto"] and row["failure"], row)
        for found in self.result["findings"]:
            on = [r["problem"] for r in self.rows if r["method"] == found["method"] and r["pareto"]]
            self.assertEqual(found["on_front"], list(dict.fromkeys(on)))
            self.assertIn(found["method"], METHODS)

    def test_finished_points_are_kept(self):
        self.assertIn("finished points are in", self.done.stderr)
        self.assertNotIn("finished points are in", self.first.stderr)
        mine = {key(r): r for r in self.rows}
        for row in self.kept["rows"]:  # times too: they were not measured again
            self.assertEqual({**row, "pareto": 0}, {**mine[key(row)], "pareto": 0})
        self.assertEqual(sorted(p.name for p in self.out.iterdir()), ["accuracy-quick.points.json", "accuracy.csv", "accuracy.json"])

    def test_refusals(self):
        for arguments, words in ((("--problems", "bridge"), "expected uniaxial, shear, column"), (("--methods", "tet5"), "expected tet4, tet4anp"),
                                 (("--backends", "abacus"), "abacus")):
            done = pliant(*arguments)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)
        self.assertIn("holds no meshes/liver.obj", pliant(scenes=self.out).stderr)
        broken = Path(self.folder.name) / "broken"
        broken.mkdir()
        (broken / "accuracy-quick.points.json").write_text("{")
        done = pliant("--problems", "column", "--methods", "hex8", "--out", broken)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--again", done.stderr)
        (broken / "accuracy-quick.points.json").write_text('{"suite": 0, "cpu": "abacus", "points": {}, "references": {}}')
        self.assertIn("was made by suite 0", pliant("--problems", "column", "--methods", "hex8", "--out", broken).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
