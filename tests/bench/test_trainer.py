"""What `pliant bench trainer --quick` writes, and what its session did: it pressed, cut, held, saved, loaded and went back. No time is looked at."""
import json
import subprocess
import tempfile
import unittest
from pathlib import Path

from bench_harness import PLIANT, schema_errors


def trainer(*arguments):
    return subprocess.run([PLIANT, "bench", "trainer", *map(str, arguments)], capture_output=True, text=True, timeout=250)


class Trainer(unittest.TestCase):
    def test_a_session_on_a_liver(self):
        with tempfile.TemporaryDirectory(prefix="pliant-trainer-") as folder:
            done = trainer("--organs", "liver", "--seconds", 6, "--backend", "cpu", "--ahead", 2, "--out", folder, "--json", "-")
            self.assertEqual(done.returncode, 0, done.stderr)
            result = json.loads(done.stdout)
            self.assertEqual((Path(folder) / "trainer.csv").read_text().count("\n"), 2)
        self.assertEqual(schema_errors(result, "bench-trainer"), [])
        row = result["rows"][0]
        self.assertEqual((row["organ"], row["rate"], result["busy"], result["ahead"]), ("liver", 60, 0, 2))
        self.assertGreater(row["real_time"], 0)
        self.assertLess(row["real_time"], 1.2, "time never runs ahead of the clock")
        self.assertTrue({"save", "load", "reset", "move_blade", "force_trace", "pick", "grab"} <= row["calls_ms"].keys(), row["calls_ms"])

    def test_quick_is_one_organ(self):
        done = trainer("--quick", "--busy", 1, "--backend", "cpu", "--json", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout)
        self.assertEqual(schema_errors(result, "bench-trainer"), [])
        self.assertEqual([row["organ"] for row in result["rows"]], ["liver_hybrid"])
        self.assertEqual((result["seconds"], result["busy"], result["ahead"]), (3, 1, 1))

    def test_bad_options_are_refused(self):
        for arguments, part in ((("--organs", "spleen"), "--organs: got spleen, expected some of liver_hybrid, liver, two_livers"),
                                (("--seconds", "0"), "--seconds: got 0, expected 1 to 3600"), (("--busy", "-1"), "--busy: got -1, expected 0 to 1024"),
                                (("--ahead", "5"), "--ahead: got 5, expected 0 to 4")):
            done = trainer(*arguments)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(part, done.stderr)


if __name__ == "__main__":
    unittest.main()
