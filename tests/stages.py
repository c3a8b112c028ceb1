#!/usr/bin/env python3
"""The stages of `./dev test`. Usage: stages.py [--quick | --full]; ./dev has installed what they need.

The file stands beside CMakeLists.txt and variants.cmake, which give the tests the labels that the stages choose from. A stage is a row
of `stages`: ./dev builds its preset, ctest runs its tests, and what ctest writes for JUnit is counted. build/log keeps for each stage
what ctest said, its results, and what ninja did, and stages.txt and stages.json of all.
"""
import glob
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOG = ROOT / "build/log"


@dataclass
class Stage:
    name: str
    preset: str
    tests: list = field(default_factory=list)  # which ones: arguments of ctest
    targets: list = field(default_factory=list)  # all, if none is named
    options: list = field(default_factory=list)  # -DNAME=VALUE of the build
    environment: dict = field(default_factory=dict)
    after_build: object = None  # a function
    command: list = None  # instead of a build and of ctest: it succeeds or fails


@dataclass
class Counts:
    """Test cases, also those inside an executable of GoogleTest."""

    tests: int = 0
    skipped: int = 0
    failed: int = 0

    def add(self, other):
        self.tests, self.skipped, self.failed = self.tests + other.tests, self.skipped + other.skipped, self.failed + other.failed


# --- the stages ----------------------------------------------------------------------------------------------------------------
SANITIZERS = {
    "ASAN_OPTIONS": "detect_leaks=1:strict_string_checks=1",
    "UBSAN_OPTIONS": "print_stacktrace=1",
    "LSAN_OPTIONS": f"suppressions={ROOT}/tests/sanitizers/lsan.supp:print_suppressions=0",
    "TSAN_OPTIONS": f"suppressions={ROOT}/tests/sanitizers/tsan.supp:halt_on_error=1",
}


def stages(mode):
    """Those of one mode: "", "--quick" or "--full"."""
    full = mode == "--full"
    # Warnings are errors where g++ builds everything; those of clang++ are printed.
    strict = ["-DCMAKE_COMPILE_WARNING_AS_ERROR=ON"]
    # Where there is a driver, a test that is skipped for want of an OpenCL device is a failure.
    opencl = {"PLIANT_REQUIRE_OPENCL": "1"} if glob.glob("/etc/OpenCL/vendors/*.icd") else {}

    # The same test objects with something else in one place: tests/variants.cmake.
    def variant(name, word, environment):
        return Stage(name, "check", ["-L", f"^variant_{word}$"], [f"variant_{word}"], strict, environment)

    debian_python = ["-DPython3_EXECUTABLE=/usr/bin/python3"] if os.access("/usr/bin/python3", os.X_OK) else []  # it has NumPy

    def sanitized(name, preset, labels, paths, *targets, options=()):
        tests = ["-L", labels, "-LE", "^(.*[.]single|fuzz|oclgrind|slow|variant_.*)$"]
        return Stage(name, preset, tests, targets, [f"-DPLIANT_FUZZ_PATHS={paths}", *options], SANITIZERS)

    def fuzz(name, seconds):
        fuzzers = sorted(path.stem for path in (ROOT / "tests/fuzz").glob("fuzz_*.cpp"))
        return Stage(name, "fuzz", ["-L", "^fuzz$"], fuzzers, [f"-DPLIANT_FUZZ_SECONDS={seconds}"])

    yield Stage("all tests (g++, release)", "check", ["-LE", "^(.*[.]single|fuzz|oclgrind|variant_.*)$"], [], strict, opencl, lend_command)
    if mode == "--quick":
        return
    yield variant("twins with -ffp-contract=fast", "contract", opencl)
    yield variant("twins built by clang++", "clang", opencl)
    if full:
        # What CMake does without OpenCL and Embree. Left out is what looks at neither and has run above.
        left_out = "^(.*[.]single|fuzz|physics|statics|bench|paths|variant_.*)$"
        yield Stage("without OpenCL and Embree, from scratch", "no-extras", ["-LE", left_out], [], strict)
    else:
        yield variant("without OpenCL and Embree", "bare", {})
    yield Stage("kernels under oclgrind", "check", ["-L", "^oclgrind$"], ["pliant_cli"])
    # A Debug build by the other compiler, with assertions: the shared library, installed and used from outside, the Python module, the
    # command, and the tests that are quick.
    yield Stage("Debug, shared library, Python (clang++)", "clang", ["-L", "^(package|python|scene)$", "-LE", "[.]single$"],
                ["pliant_lib", "pliant_python", "example_hello", "pliant_cli", "tutorial_embed", "test_scene"], debian_python)
    lint = [sys.executable, "-B", str(ROOT / "tests/lint/lint.py"), "all" if full else "changed"]
    if full:
        yield sanitized("address and undefined-behaviour sanitizers", "asan", ".", 100000, "all")
        yield sanitized("thread sanitizer", "tsan", ".", 300, "all")
        yield fuzz("fuzzing, 10 minutes each", 600)
    else:
        yield sanitized("address and undefined-behaviour sanitizers", "fuzz", "scene|io|devices|paths|python_sanitized", 300, "test_scene", "test_io",
                        "test_devices", "random_cut", "pliant_python", options=["-DPLIANT_PYTHON=ON", *debian_python])
        yield fuzz("fuzzing, 20 s each", 20)
    yield Stage("clang-format, cppcheck, clang-tidy", "lint", command=lint)


def lend_command():
    """The documents name build/release/pliant; where nobody has built there it is that of build/check."""
    release = ROOT / "build/release"
    if not (release / "build.ninja").exists():
        release.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / "build/check/pliant", release / "pliant")


# --- what ctest says -----------------------------------------------------------------------------------------------------------
def count_case(case):
    """An executable of GoogleTest sums up its cases. Anything else is one test, and so is an executable that did not reach its end."""
    text = case.findtext("system-out") or ""
    ran = sum(map(int, re.findall(r"^\[==========\] (\d+) tests? from .* ran\.", text, re.M)))
    listed = lambda word: sum(map(int, re.findall(rf"^\[  {word} \] (\d+) tests?, listed below:", text, re.M)))
    # An executable that is not there is also "skipped" to ctest.
    skip = case.find("skipped")
    skipped = skip is not None and skip.get("message", "").startswith("SKIP_")
    passed = case.get("status") == "run"
    if ran:
        return Counts(ran, listed("SKIPPED"), listed("FAILED ") or int(not passed and not skipped))
    return Counts(1, int(skipped), int(not passed and not skipped))


MOST_LINES = 200  # of one failure, since a check in a loop may fail a thousand times


def shortened(lines):
    left_out = len(lines) - MOST_LINES
    half = MOST_LINES // 2
    return lines if left_out <= 0 else [*lines[:half], f"... {left_out} lines: the .log of this stage in build/log has them ...", *lines[-half:]]


def only_failures(text):
    """The output of a test without what passed inside an executable of GoogleTest."""
    kept, case = [], None  # `case`: the lines of one that has not ended
    for line in text.splitlines():
        if line.startswith("[ RUN      ]"):
            case = [line]
        elif case and line.startswith(("[       OK ]", "[  SKIPPED ]")):
            case = None
        elif case:
            case.append(line)
            if line.startswith("[  FAILED  ]"):
                kept += shortened(case)
                case = None
        elif line and not re.match(r"\[(----------|==========|  PASSED  |  SKIPPED )\]", line):
            kept.append(line)
    return (kept if case or "[ RUN" in text else shortened(kept)) + shortened(case or [])  # it died in the last one


def run_ctest(folder, log, arguments, environment):
    """Runs the tests of a build folder; what it prints goes to log.log, its results to log.xml. Returns whether all went well, and Counts."""
    results, said = log.with_suffix(".xml"), log.with_suffix(".log")
    results.unlink(missing_ok=True)
    jobs = os.environ.get("PLIANT_JOBS") or str(len(os.sched_getaffinity(0)))
    whole = ["--test-output-size-passed", "1000000000", "--test-output-size-failed", "1000000000"]  # the sum of the cases comes last
    with open(said, "w") as stream:
        status = subprocess.run(["ctest", "--test-dir", folder, "-C", "Whole", "-j", jobs, "--output-on-failure", "--no-tests=error", *whole,
                                 "--output-junit", results, *arguments], stdout=stream, stderr=subprocess.STDOUT,
                                env={**os.environ, **environment}).returncode
    text = said.read_text(errors="replace")
    try:
        cases = xml.parse(results).getroot().findall("testcase")
    except (OSError, xml.ParseError) as error:
        print(text, f"stages.py: ctest wrote no results: {error}", sep="\n")
        return False, Counts()
    counts = Counts()
    for case in cases:
        of_case = count_case(case)
        counts.add(of_case)
        if of_case.failed:
            print(f"--- {case.get('name')}", *only_failures(case.findtext("system-out") or ""), sep="\n")
    time_line = re.search(r"^Total Test time.*", text, re.M)
    if status == 0 and counts.failed == 0:
        print(f"{counts.tests - counts.skipped} tests passed, {counts.skipped} skipped; {time_line[0] if time_line else ''}")
        return True, counts
    # Whether a test failed, died or ran out of time stands in this list alone.
    names = re.search(r"^The following tests FAILED:.*", text, re.M | re.S)
    print(names[0].rstrip() if names else text)
    return False, counts


# --- one after the other -------------------------------------------------------------------------------------------------------
def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_stage(stage, number):
    """One row of the closing table."""
    print(f"== {stage.name}", flush=True)
    start, cpu, counts = time.time(), cpu_seconds(), Counts()
    if stage.command:
        well = subprocess.run(stage.command, cwd=ROOT).returncode == 0
    else:
        well = subprocess.run([ROOT / "dev", "build", stage.preset, *stage.options, *stage.targets]).returncode == 0
        if well and stage.after_build:
            stage.after_build()
        if well:
            log = LOG / f"stage-{number}-{stage.preset}"
            well, counts = run_ctest(ROOT / "build" / stage.preset, log, stage.tests, stage.environment)
    ninja_log = ROOT / "build" / stage.preset / ".ninja_log"
    if ninja_log.exists():
        shutil.copy(ninja_log, LOG / f"stage-{number}-{stage.preset}.ninja_log")
    return {"stage": stage.name, "tests": counts.tests, "skipped": counts.skipped, "failed": counts.failed,
            "seconds": round(time.time() - start), "cpu_seconds": round(cpu_seconds() - cpu), "result": "ok" if well else "FAILED"}


def summary(rows, seconds):
    """The closing table, and whether everything went well."""
    table = "{stage:<44} {tests:5d} tests {skipped:3d} skipped {failed:3d} failed {seconds:5d} s {cpu_seconds:5d} CPU-s  {result}"
    lines = ["", *(table.format(**row) for row in rows), "", f"Total Test time (real) = {seconds} s, building included"]
    tests, skipped, failed = (sum(row[key] for row in rows) for key in ("tests", "skipped", "failed"))
    broken = sum(row["result"] != "ok" and row["failed"] == 0 for row in rows)
    if broken:
        lines.append(f"{broken} stage(s) could not build or run; their tests are not counted")
    percent = 100 * (tests - failed) // tests if tests else 0
    lines.append(f"{percent}% tests passed, {failed} tests failed out of {tests} ({skipped} skipped)")
    return "\n".join(lines), all(row["result"] == "ok" for row in rows)


def run(chosen):
    LOG.mkdir(parents=True, exist_ok=True)
    for old in LOG.glob("stage-*"):
        old.unlink()
    start = time.time()
    rows = [run_stage(stage, number) for number, stage in enumerate(chosen, 1)]
    text, well = summary(rows, round(time.time() - start))
    print(text)
    (LOG / "stages.txt").write_text(text + "\n")
    (LOG / "stages.json").write_text(json.dumps(rows) + "\n")
    return 0 if well else 1


if __name__ == "__main__":
    try:
        sys.exit(run(stages(sys.argv[1] if len(sys.argv) > 1 else "")))
    except KeyboardInterrupt:
        sys.exit(130)
