"""What `pliant bench kernels` writes: its members, the same bits on every bit-exact backend, its refusals. No time is looked at."""
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PLIANT = os.environ.get("PLIANT", "pliant")
WORDS = {"kernel", "element", "backend", "hash"}
COUNTS = {"elements"}
POSITIVE = {"ns_per_element_step", "bytes_per_element", "flops_per_element", "bytes_per_second", "triad_bytes_per_second",
            "fma_flops_per_second", "fraction_of_limit"}
OF_A_STEP = {"nodes", "memory_bytes", "ms_per_step", "law"}


def pliant(*arguments):
    return subprocess.run([PLIANT, "bench", "kernels", *map(str, arguments)], capture_output=True, text=True, timeout=550)


class Kernels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="pliant-bench-")
        out = Path(cls.folder.name) / "made" / "here"
        cls.done = pliant("--sizes", 1000, "--elements", "tet4,hex8", "--json", "-", "--out", out)
        cls.out = out

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.result = json.loads(self.done.stdout)

    def test_every_row_has_its_members(self):
        self.assertEqual({r["element"] for r in self.result["rows"]}, {"tet4", "hex8"})
        for row in self.result["rows"]:
            expected = WORDS | COUNTS | POSITIVE | {"spread"} | (OF_A_STEP if row["kernel"] == "step" else set())
            self.assertEqual(set(row), expected)
            for key in WORDS:
                self.assertTrue(row[key] and isinstance(row[key], str), row)
            for key in POSITIVE:
                self.assertTrue(math.isfinite(row[key]) and row[key] > 0, (key, row))
            self.assertTrue(900 <= row["elements"] <= 1300, row)
            self.assertGreaterEqual(row["spread"], 0)
            self.assertRegex(row["hash"], "^[0-9a-f]{16}$")

    def test_a_step_counts_what_its_passes_count(self):
        rows = self.result["rows"]
        for step in (r for r in rows if r["kernel"] == "step"):
            same = [r for r in rows if r["kernel"] != "step" and (r["element"], r["backend"]) == (step["element"], step["backend"])]
            self.assertGreaterEqual(len(same), 2)
            for key in ("bytes_per_element", "flops_per_element"):
                self.assertTrue(math.isclose(step[key], sum(r[key] for r in same), rel_tol=1e-9), (key, step))

    def test_bit_exact_backends_have_one_hash(self):
        exact = {b["name"] for b in self.result["machine"]["backends"] if b["bit_exact"]}
        self.assertIn("cpu", exact)
        for element in ("tet4", "hex8"):
            rows = [r for r in self.result["rows"] if r["element"] == element and r["backend"] in exact]
            self.assertEqual(exact & {"cpu", "opencl:0"}, {r["backend"] for r in rows})
            self.assertEqual(len({r["hash"] for r in rows}), 1, rows)
            other = {r["hash"] for r in self.result["rows"] if r["element"] == element and r["backend"] == "cpu:double"}
            self.assertEqual(len(other), 1)
            self.assertNotEqual(other, {rows[0]["hash"]})  # else the hash would not look at the state

    def test_files_hold_the_same_rows(self):
        self.assertEqual(sorted(p.name for p in self.out.iterdir()), ["kernels.csv", "kernels.json"])
        self.assertEqual(json.loads((self.out / "kernels.json").read_text()), self.result)
        lines = (self.out / "kernels.csv").read_text().splitlines()
        self.assertEqual(len(lines), 1 + len(self.result["rows"]))
        self.assertEqual({line.count(",") for line in lines}, {len(WORDS | COUNTS | POSITIVE | OF_A_STEP)})
        self.assertIn("bench/report/report.py", self.done.stderr)

    def test_refusals_name_the_option_and_the_value(self):
        for arguments, words in ((("--elements", "tet5"), ("--elements", "tet5")), (("--sizes", 0), ("--sizes", "0")),
                                 (("--law", "rubber"), ("--law", "rubber")), (("--backends", "cuda"), ("cuda",))):
            done = pliant(*arguments)
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            for word in words:
                self.assertIn(word, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
