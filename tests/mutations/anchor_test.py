#!/usr/bin/env python3
"""Mutations still act where they did when code is spaced, explained or moved; what is ambiguous or gone is reported."""
import tempfile
import unittest
from pathlib import Path

import anchor
import run

SOURCE = """// A comment with halve(x) { x / 2; }
#define BEGIN {
namespace a {
template <class T>
struct Box {
  explicit Box(T v) : value{v}, twice{2 * v} { check(v > 0); }
  T halve() const noexcept { return value / 2; }
  T value = T{1}, twice;
};
static const int table[] = {1, 2};
const char* text() { return R"x(} halve() { )x"; }
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void twist(float x) {
  const auto f = [&](int k) { return k + 1'000; };
  if (x <= 0.5e-3f) {
    x = f(2);
  }
}
bool operator==(const Box<int>& x, const Box<int>& y) { return x.value == y.value; }
}  // namespace a
"""


class Anchors(unittest.TestCase):
    def test_functions_are_found_by_name(self):
        names = [name for name, _, _ in anchor.functions(SOURCE)]
        self.assertEqual(names, ["Box", "halve", "text", "twist", "operator"])

    def test_space_and_comments_do_not_count(self):
        plain = anchor.places(SOURCE, "twist", "x <= 0.5e-3f")
        spaced = SOURCE.replace("x <= 0.5e-3f", "x  <=  // at most\n      0.5e-3f")
        self.assertEqual(len(plain), 1)
        self.assertEqual(len(anchor.places(spaced, "twist", "x<=0.5e-3f")), 1)
        self.assertEqual(anchor.places(SOURCE, "halve", "x <= 0.5e-3f"), [])

    def test_members_belong_to_their_constructor(self):
        self.assertEqual(len(anchor.places(SOURCE, "Box", "{2 * v}")), 1)
        self.assertEqual(len(anchor.places(SOURCE, "Box", "v > 0")), 1)

    def test_a_function_that_moved_is_found_on_its_floor(self):
        with tempfile.TemporaryDirectory() as folder:
            tree = Path(folder)
            for name in ("host/a", "host/b", "kernels"):
                (tree / name).mkdir(parents=True)
            (tree / "host/a/old.cpp").write_text("int other() { return 1; }\n")
            (tree / "host/b/new.cpp").write_text("int third(int x) { return x / 3; }\n")
            (tree / "kernels/new.cpp").write_text("int third(int x) { return x / 3; }\n")
            self.assertEqual(anchor.find(tree, {}, "host/a/old.cpp", "third", "x / 3")[0], "host/b/new.cpp")
            with self.assertRaisesRegex(LookupError, "other files of host 0 times"):
                anchor.find(tree, {}, "host/a/old.cpp", "third", "x / 4")
            (tree / "host/b/more.cpp").write_text("int third(int x) { return x / 3; }\n")
            with self.assertRaisesRegex(LookupError, "other files of host 2 times"):
                anchor.find(tree, {}, "host/a/old.cpp", "third", "x / 3")

    def test_every_mutation_survives_other_spacing(self):
        """Each file is written with a token a line and a comment in front of it."""
        with tempfile.TemporaryDirectory() as folder:
            tree = Path(folder)
            mutations = run.load_all()
            for name in {file for m in mutations for file, *_ in m.blocks}:
                source = (run.ROOT / name).read_text()
                lines, last = [], 0
                for token in anchor.tokens(source):
                    between = source[last : token.start]
                    lines.append(("" if token.directive else " // x\n") + between + token.text)
                    last = token.end
                spaced = tree / name
                spaced.parent.mkdir(parents=True, exist_ok=True)
                spaced.write_text("".join(lines) + source[last:])
            for m in mutations:
                m.changed_files(tree)


if __name__ == "__main__":
    unittest.main()
