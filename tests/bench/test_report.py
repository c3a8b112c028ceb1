"""bench/report/report.py on rows made up here: which files it makes, what it says about them, what it refuses."""
import json
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path

from bench_harness import SOURCE, python_with_matplotlib

CHARTS = ["kernels_limit", "kernels_split", "kernels_step"]
PASSES = {"tet4": ["tled_tet4_force", "node_update"], "hex8": ["tled_hex8_brick_force", "brick_update", "a_new_kernel"]}


def result(backends=("cpu", "cpu:double", "opencl:0"), sizes=(1000, 100000), elements=("tet4", "hex8")):
    rows = []
    for element in elements:
        for size in sizes:
            for backend in backends:
                for i, kernel in enumerate([*PASSES[element], "step"]):
                    row = {"kernel": kernel, "element": element, "backend": backend, "elements": size, "ns_per_element_step": 5.0 + i,
                           "bytes_per_element": 80.0, "flops_per_element": 200.0, "bytes_per_second": 9e9, "triad_bytes_per_second": 1e10,
                           "fma_flops_per_second": 1e11, "fraction_of_limit": 0.6, "spread": 0.01, "hash": f"{len(backend) == 10:016x}"}
                    if kernel == "step":
                        row.update(nodes=size, memory_bytes=100 * size, ms_per_step=size * 1e-5, law="neo-hookean")
                    rows.append(row)
    known = [{"name": b, "device": "a <device> & more", "version": "1", "bit_exact": b != "cpu:double"} for b in backends]
    return {"machine": {"cpu": "a processor", "threads": 2, "compiler": "a compiler", "backends": known}, "rows": rows}


class Page(HTMLParser):
    """Every element is closed, no id appears twice, nothing is fetched."""

    def __init__(self, text):
        super().__init__()
        self.open, self.ids, self.used = [], [], []
        self.feed(text)
        assert not self.open, self.open

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.ids += [attrs["id"]] if "id" in attrs else []
        self.used += [v for k, v in attrs.items() if k in ("src", "href", "xlink:href")]
        if tag not in ("meta", "br", "link", "img"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if self.open and self.open[-1] == tag:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, (tag, self.open)
        self.open.pop()


class Report(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="pliant-report-")
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)

    def report(self, data, expect=0):
        (self.folder / "kernels.json").write_text(data if isinstance(data, str) else json.dumps(data))
        done = subprocess.run([PYTHON, SOURCE / "bench" / "report" / "report.py", self.folder], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, expect, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        return (self.folder / "report.html").read_text() if expect == 0 else done.stderr

    def test_charts_and_a_page_that_needs_nothing_else(self):
        text = self.report(result())
        names = sorted(p.name for p in self.folder.iterdir())
        self.assertEqual(names, sorted(["kernels.json", "report.html"] + [f"{c}.{e}" for c in CHARTS for e in ("png", "svg")]))
        for chart in CHARTS:
            ElementTree.parse(self.folder / f"{chart}.svg")
            self.assertTrue((self.folder / f"{chart}.png").read_bytes().startswith(b"\x89PNG"))
        page = Page(text)
        self.assertEqual(len(page.ids), len(set(page.ids)))
        for target in page.used:
            self.assertTrue(target.startswith("#"), target)
            self.assertIn(target[1:], page.ids)
        self.assertNotRegex(re.sub(r'xmlns(:\w+)?="[^"]*"', "", text), "https?://")
        self.assertEqual(text.count("<svg"), 3)
        self.assertIn("a &lt;device&gt; &amp; more", text)
        self.assertIn("a_new_kernel", text)

    def test_the_same_rows_give_the_same_bytes(self):
        first = self.report(result())
        charts = [(self.folder / f"{c}.svg").read_bytes() for c in CHARTS]
        self.assertEqual(self.report(result()), first)
        self.assertEqual([(self.folder / f"{c}.svg").read_bytes() for c in CHARTS], charts)

    def test_it_says_whether_the_bits_agree(self):
        data = result()
        self.assertIn("Same bits", self.report(data))
        for row in data["rows"]:
            if (row["element"], row["elements"], row["backend"]) == ("hex8", 1000, "opencl:0"):
                row["hash"] = "00000000000000ff"
        text = self.report(data)
        self.assertNotIn("Same bits", text)
        self.assertIn("differ in bits</b> for hex8 with 1\u2009000 elements", text)

    def test_it_says_when_the_figures_are_doubtful(self):
        data = result()
        self.assertNotIn("was not quiet", self.report(data))
        data["rows"][0]["spread"] = 0.5
        next(r for r in data["rows"] if r["kernel"] == "step")["fraction_of_limit"] = 40
        text = self.report(data)
        self.assertIn("1 of 42 rows spread", text)
        self.assertIn("1 of 12 steps come out above", text)

    def test_one_size_one_element_one_backend(self):
        text = self.report(result(backends=("cpu",), sizes=(1000,), elements=("hex8",)))
        self.assertNotIn("Same bits", text)  # nothing was compared

    def test_refusals(self):
        self.assertIn("is not JSON", self.report("{", expect=2))
        self.assertIn('expected an object with "machine" and "rows"', self.report("[]", expect=2))
        self.assertIn("no rows", self.report({"machine": {}, "rows": []}, expect=2))
        data = result()
        del data["rows"][0]["spread"]
        self.assertIn("'spread'", self.report(data, expect=2))
        self.assertEqual(sorted(p.name for p in self.folder.glob("*.html")), [])
        (self.folder / "kernels.json").unlink()
        done = subprocess.run([PYTHON, SOURCE / "bench" / "report" / "report.py", self.folder], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("pliant bench kernels --out", done.stderr)


if __name__ == "__main__":
    PYTHON = python_with_matplotlib()
    if PYTHON is None:
        print("skipped: no Python here has matplotlib (Debian: python3-matplotlib)")
        sys.exit(77)
    unittest.main(verbosity=2)
