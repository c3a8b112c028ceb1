#!/usr/bin/env python3
"""What tests/stages.py counts and prints of tests that pass, fail, die or are skipped. Usage: stages_test.py SOURCE_FOLDER"""
import contextlib
import io
import json
import sys
import tempfile
from pathlib import Path

source = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(source / "tests"))
import stages  # noqa: E402

# A test of ctest each: a name, what it prints, and how it ends.
GOOGLE_TEST = """[==========] Running 4 tests from 1 test suite.
[ RUN      ] Node.moves
{long}
[       OK ] Node.moves (0 ms)
[ RUN      ] Node.waits
[  SKIPPED ] Node.waits (0 ms)
[ RUN      ] Node.breaks
node_test.cpp:7: Failure
[  FAILED  ] Node.breaks (0 ms)
[ RUN      ] Node.rests
[       OK ] Node.rests (0 ms)
[==========] 4 tests from 1 test suite ran. (3 ms total)
[  PASSED  ] 2 tests.
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] Node.waits
[  FAILED  ] 1 test, listed below:
[  FAILED  ] Node.breaks
"""
WELL = "[==========] 3 tests from 2 test suites ran. (3 ms total)\n[  PASSED  ] 2 tests.\n[  SKIPPED ] 1 test, listed below:\n"
GOOD = [("whole", "much\n" * 3000 + WELL, "exit 0"), ("script", "hidden\n", "exit 0"), ("left_out", "no device\n", "exit 77")]
BAD = [("cases", GOOGLE_TEST.format(long="much\n" * 3000), "exit 1"), ("bad_script", "2 is not 3 <&> \033[31m\n" + "more\n" * 1000, "exit 1"),
       ("dead", "[ RUN      ] Node.quiet\n[       OK ] Node.quiet (0 ms)\n[ RUN      ] Node.last\nits last words\n", "kill -SEGV $$")]
BAD_OUTPUT = ["node_test.cpp:7: Failure", "[ RUN      ] Node.breaks", "2 is not 3 <&>", "its last words", "dead (SEGFAULT)", "gone (Not Run)",
              "--- cases", "--- bad_script"]
GOOD_OUTPUT = ["much", "hidden", "Node.moves", "Node.quiet", "no device"]


def run_tests(folder, tests, *more):
    """What run_ctest returns for these tests, and what it prints."""
    lines = list(more)
    for name, text, end in tests:
        (folder / f"{name}.txt").write_text(text)
        (folder / f"{name}.sh").write_text(f"cat {folder}/{name}.txt\n{end}\n")
        lines.append(f"add_test({name} sh {folder}/{name}.sh)\nset_tests_properties({name} PROPERTIES SKIP_RETURN_CODE 77)")
    (folder / "CTestTestfile.cmake").write_text("\n".join(lines) + "\n")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        well, counts = stages.run_ctest(folder, folder / "stage", [], {})
    return well, (counts.tests, counts.skipped, counts.failed), printed.getvalue()


def check(right, *shown):
    if not right:
        print("stages_test.py:", *shown, sep="\n")
        sys.exit(1)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        well, counts, text = run_tests(folder, GOOD)
        check(well and counts == (5, 2, 0), well, counts, text)
        check(text.startswith("3 tests passed, 2 skipped; Total Test time (real) ="), text)
        well, counts, text = run_tests(folder, GOOD + BAD, "add_test(gone /nowhere/at/all)")
        check(not well and counts == (5 + 4 + 3, 2 + 1, 4), well, counts, text)
        for line in BAD_OUTPUT:
            check(line in text, f"not printed: {line}", text)
        for line in GOOD_OUTPUT:
            check(line not in text, f"printed: {line}", text)
        check(text.count("more") < 300 and "lines: the .log of this stage" in text, text)
        well, counts, text = run_tests(folder, [])  # no test at all is a failure
        check(not well and counts == (0, 0, 0) and "No tests were found" in text, well, counts, text)

    row = {"stage": "one", "tests": 10, "skipped": 1, "failed": 0, "seconds": 2, "cpu_seconds": 3, "result": "ok"}
    text, well = stages.summary([row, row], 7)
    check(well and "100% tests passed, 0 tests failed out of 20 (2 skipped)" in text and "could not" not in text, text)
    text, well = stages.summary([row, {**row, "failed": 3, "result": "FAILED"}], 7)
    check(not well and "85% tests passed, 3 tests failed out of 20" in text and "could not" not in text, text)
    text, well = stages.summary([row, {**row, "tests": 0, "skipped": 0, "result": "FAILED"}], 7)
    check(not well and "1 stage(s) could not build or run" in text, text)

    # A stage that does not build, or whose command fails, fails the whole.
    printed = io.StringIO()
    with tempfile.TemporaryDirectory() as name, contextlib.redirect_stdout(printed):
        stages.LOG = Path(name)
        status = [stages.run([stages.Stage("lint", "lint", command=[end])]) for end in ("true", "false")]
        rows = json.loads((Path(name) / "stages.json").read_text())
    check(status == [0, 1] and rows[0]["result"] == "FAILED", status, rows, printed.getvalue())

    presets = {preset["name"] for preset in json.loads((source / "CMakePresets.json").read_text())["buildPresets"]}
    pages = (source / "CONTRIBUTING.md").read_text()
    for mode in ("", "--quick", "--full"):
        for stage in stages.stages(mode):
            check(stage.command or stage.preset in presets, f"{stage.name}: there is no preset {stage.preset}")
            check(mode or f"build/{stage.preset}" in pages, f"{stage.name}: CONTRIBUTING.md does not say that it is built in build/{stage.preset}")


main()
