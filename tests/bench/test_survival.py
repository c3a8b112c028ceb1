"""What `pliant bench survival` writes; that scenes are the same whenever they are drawn; that finished ones are not run again; and that the
first of them end well. No time is looked at."""
import json
import subprocess
import tempfile
import unittest
from pathlib import Path

from bench_harness import PLIANT, SOURCE, schema_errors

COUNT = 12


def survival(*arguments):
    return subprocess.run([PLIANT, "bench", "survival", "--quick", "--scenes", SOURCE / "scenes", *map(str, arguments)],
                          capture_output=True, text=True, timeout=900)


class Survival(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="pliant-survival-")
        cls.out = Path(cls.folder.name) / "made"
        cls.done = survival("--count", COUNT, "--json", "-", "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.result = json.loads(self.done.stdout)

    def test_rows_have_their_members_and_all_scenes_end_well(self):
        self.assertEqual(schema_errors(self.result, "bench-survival"), [])
        self.assertEqual([row["number"] for row in self.result["rows"]], list(range(COUNT)))
        for row in self.result["rows"]:
            with self.subTest(number=row["number"]):
                self.assertEqual(row["outcome"], "ended", row["message"])
        self.assertEqual(self.result["summary"]["ended"], COUNT)
        self.assertGreater(sum(row["edits"] for row in self.result["rows"]), 0, "none of them was cut")

    def test_finished_scenes_are_taken_from_the_folder(self):
        kept = self.out / "survival-quick.rows.jsonl"
        rows = [json.loads(line) for line in kept.read_text().splitlines()]
        rows[1]["message"] = "kept"
        kept.write_text("".join(json.dumps(row) + "\n" for row in rows[:-1]) + '{"number": 11, "outc')  # the last was interrupted
        again = survival("--count", COUNT, "--json", "-", "--out", self.out)
        self.assertEqual(again.returncode, 0, again.stderr)
        result = json.loads(again.stdout)
        self.assertEqual(result["rows"][1]["message"], "kept")
        last, before = result["rows"][-1], self.result["rows"][-1]
        del last["ms_per_frame"], before["ms_per_frame"]
        self.assertEqual(last, before, "drawn again, it is another scene or ends otherwise")

    def test_vessels_stay_in_shapes_with_hollows(self):
        done = survival("--first", 1033, "--count", 1, "--json", "-")
        row = json.loads(done.stdout)["rows"][0]
        self.assertEqual((row["body"], row["outcome"]), ("gallbladder_tet", "ended"), row["message"])

    def test_bad_options(self):
        for arguments in (["--count", "0"], ["--first", "-1"]):
            done = survival(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn("--count", done.stderr)


if __name__ == "__main__":
    unittest.main()
