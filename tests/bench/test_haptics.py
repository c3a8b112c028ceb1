"""What `pliant bench haptics --quick` writes, and that what it computes in virtual time keeps its bounds. No time is looked at."""
import json
import subprocess
import tempfile
import unittest
from pathlib import Path

from bench_harness import PLIANT, schema_errors

# What the quick run does not keep; a test that all rows keep is to be taken off the list.
NOT_YET = {("others", "energy at the frame rate and its multiples, held over buffer [dB]")}


def haptics(*arguments):
    return subprocess.run([PLIANT, "bench", "haptics", "--quick", *map(str, arguments)], capture_output=True, text=True, timeout=550)


class Haptics(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="pliant-haptics-")
        cls.out = Path(cls.folder.name) / "out"
        cls.done = haptics("--out", cls.out, "--json", "-")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.result = json.loads(self.done.stdout)
        self.rows = self.result["rows"]

    def test_rows_have_their_members(self):
        self.assertEqual(schema_errors(self.result, "bench-haptics"), [])
        self.assertEqual([part["name"] for part in self.result["parts"]], ["strokes", "others", "edits", "instruments", "passivity", "times"])
        self.assertEqual({row["part"] for row in self.rows}, {"strokes", "others", "edits", "instruments", "passivity", "times"})
        self.assertEqual(sum(row["ok"] is True for row in self.rows), self.result["summary"]["ok"])
        self.assertEqual((self.out / "haptics.csv").read_text().count("\n"), len(self.rows) + 1)

    def test_what_is_computed_keeps_its_bounds(self):
        broken = [row for row in self.rows if row["ok"] is False and row["part"] != "times" and (row["part"], row["test"]) not in NOT_YET]
        self.assertEqual(broken, [])

    def test_curves_are_there_for_figures(self):
        curves = {(trace["scene"], trace["model"]): trace for trace in self.result["traces"]}
        full, held = curves["block", "full"], curves["block", "held"]
        self.assertEqual(len(full["force"]), len(held["force"]))
        self.assertGreater(max(force[1] for force in full["force"]), 0.1)
        self.assertGreater(max(force[1] for force in held["force"]), 0.1)

    def test_bad_options_are_refused(self):
        for arguments, part in ((("--parts", "smell"), '--parts: got "smell", expected strokes, others, edits, instruments, passivity, times'),
                                (("--seconds", "0"), "--seconds: got 0, expected 1 to 3600")):
            done = haptics(*arguments)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(part, done.stderr)


if __name__ == "__main__":
    unittest.main()
