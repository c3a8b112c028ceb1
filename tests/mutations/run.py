#!/usr/bin/env python3
"""Break the code on purpose and see which tests notice: ./dev mutate [--again] [--list] [--check] [N...]

Each file NN_name.mutation below this folder, on the shelf of the room that it breaks, is one small error: why it matters, what has to be built, which tests should
notice, and the text that is replaced. They are made in a copy of the tracked files in build/mutate/src, which has its own build
folder. Results are kept in build/mutate/results.json: a second call goes on with what is missing or was not caught, --again
begins anew. The exit code is 0 only if every mutation asked for is caught.
"""
import argparse
import fcntl
import hashlib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import anchor

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
WORK = ROOT / "build" / "mutate"
COPY = WORK / "src"
BUILD = COPY / "build" / "release"
RESULTS = WORK / "results.json"
TEST_SECONDS = 600  # a test that hangs has noticed too
CAUGHT, SURVIVED, STALE, BROKEN, BAD_TEST = "caught", "SURVIVED", "does not apply", "does not build", "its test fails anyway"


class Bad(Exception):
    """A mutation file, a build or a test that is not as it should be."""


class Mutation:
    """NN_name.mutation: `key: text` lines (title, why, build, test; build and test may repeat), then blocks

    file: path
    in: function
    <<<
    tokens that stand exactly once in the functions of this name, however they are spaced (anchor.py)
    ===
    what replaces them
    >>>

    Without `in` they stand exactly once in the file.
    """

    def __init__(self, path):
        self.path = path
        self.id = path.stem
        self.number = int(path.stem.split("_")[0])
        self.text = path.read_text()
        self.title, self.why, self.build, self.tests, self.blocks = "", "", [], [], []
        lines, file, function, at = self.text.split("\n"), None, "", 0
        while at < len(lines):
            line = lines[at]
            at += 1
            if not line.strip() or line.startswith("#"):
                continue
            if line == "<<<":
                try:
                    middle = lines.index("===", at)
                    end = lines.index(">>>", middle)
                except ValueError:
                    raise Bad(f"{path.name}: a block has no '===' or no '>>>'") from None
                if file is None:
                    raise Bad(f"{path.name}: a block before any 'file:'")
                self.blocks.append((file, function, "\n".join(lines[at:middle]), "\n".join(lines[middle + 1 : end])))
                at = end + 1
                continue
            key, _, value = line.partition(":")
            value = value.strip()
            if key == "file":
                file, function = value, ""
            elif key == "in":
                function = value
            elif key == "title":
                self.title = value
            elif key == "why":
                self.why = f"{self.why} {value}".strip()
            elif key == "build":
                self.build += value.split()
            elif key == "test":
                self.tests.append(value)
            else:
                raise Bad(f"{path.name}: line {at} is neither a known key nor a block: {line}")
        for name, value in [("title", self.title), ("why", self.why), ("test", self.tests), ("block", self.blocks)]:
            if not value:
                raise Bad(f"{path.name}: has no {name}")

    @property
    def digest(self):
        return hashlib.sha256(self.text.encode()).hexdigest()[:16]

    def changed_files(self, tree):
        """{path: (text before, text after)}; throws Bad where a pattern is not there exactly once."""
        changed = {}
        for name, function, old, new in self.blocks:
            try:
                name, start, end = anchor.find(tree, changed, name, function, old)
            except LookupError as missing:
                raise Bad(str(missing)) from None
            before, now = changed.get(name) or [(tree / name).read_text()] * 2
            changed[name] = (before, now[:start] + new + now[end:])
        return changed


def load_all():
    mutations = [Mutation(path) for path in sorted(FOLDER.rglob("*.mutation"), key=lambda path: path.name)]
    numbers = [m.number for m in mutations]
    for number in numbers:
        if numbers.count(number) > 1:
            raise Bad(f"two mutations have the number {number}")
    return mutations


def run(command, log, seconds=None, **options):
    """Exit code (None after `seconds`) and output, which also goes to the end of the log."""
    with open(log, "a") as out:
        out.write(f"$ {command if isinstance(command, str) else shlex.join(command)}\n")
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                               start_new_session=True, **options)
    code = None
    try:
        output, _ = process.communicate(timeout=seconds)
        code = process.returncode
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
    except BaseException:
        os.killpg(process.pid, signal.SIGTERM)  # ninja then ends its compilers and removes what they have begun
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
        raise
    with open(log, "a") as out:
        out.write(output)
    return code, output


def copy_sources():
    """Bring the copy up to date with the tracked files. What is as it was keeps its time, so little is built again."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    names = [os.fsdecode(n) for n in listed.split(b"\0") if n]
    wanted = {n for n in names if (ROOT / n).is_file() or (ROOT / n).is_symlink()}
    for folder, folders, files in os.walk(COPY):
        here = Path(folder)
        if here == COPY and "build" in folders:
            folders.remove("build")
        for name in files:
            if str((here / name).relative_to(COPY)) not in wanted:
                (here / name).unlink()
    for name in sorted(wanted):
        source, target = ROOT / name, COPY / name
        if source.is_symlink():
            target.unlink(missing_ok=True)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.symlink_to(os.readlink(source))
        elif not target.is_file() or target.read_bytes() != source.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(source.read_bytes())
            shutil.copymode(source, target)


def build(targets, log):
    """Throws Bad with the first error of the compiler."""
    if not targets:
        return
    jobs = os.environ.get("PLIANT_JOBS", str(os.cpu_count() or 1))
    code, output = run(["cmake", "--build", str(BUILD), "-j", jobs, "--target", *targets], log)
    if code != 0:
        errors = [line for line in output.splitlines() if "error" in line]
        raise Bad((errors or output.splitlines() or ["no output"])[0][:200])


def configure(log):
    # Debian's Python has what the Python module is built with, and NumPy.
    options = ["-DPLIANT_PYTHON=ON", *(["-DPython3_EXECUTABLE=/usr/bin/python3"] if os.access("/usr/bin/python3", os.X_OK) else [])]
    cache = BUILD / "CMakeCache.txt"
    if not (BUILD / "build.ninja").is_file() or "\nPLIANT_PYTHON:BOOL=ON\n" not in cache.read_text():
        environment = dict(os.environ)
        if shutil.which("ccache"):
            environment.setdefault("CMAKE_CXX_COMPILER_LAUNCHER", "ccache")
        code, output = run(["cmake", "--preset", "release", *options], log, cwd=COPY, env=environment)
        if code != 0:
            raise Bad(f"cmake failed, see {log.relative_to(ROOT)}: {output.strip().splitlines()[-1]}")


def notice(command, log):
    """(who noticed or None, whether any test ran) of one test command. Programs are those of the build folder."""
    environment = dict(os.environ, PATH=f"{BUILD}:{os.environ['PATH']}", PLIANT_SOURCE=str(COPY), PYTHONDONTWRITEBYTECODE="1",
                       PLIANT=str(BUILD / "pliant"), GTEST_COLOR="no")
    code, output = run(["bash", "-c", command], log, TEST_SECONDS, cwd=BUILD, env=environment)
    passed = re.findall(r"^\[       OK \] (\S+)|^ *\d+/\d+ Test +#\d+: (\S+) \.* +Passed", output, re.M)
    is_list = command.startswith(("test_", "ctest"))
    ran = bool(passed) or not is_list
    if code == 0:
        return None, ran
    failed = re.findall(r"^\[  FAILED  \] ([^\s,]+)[, ].*\(\d+ ms\)|^ *\d+/\d+ Test +#\d+: (\S+) \.*\*\*\*", output, re.M)
    names = [a or b for a, b in failed]
    if not names:  # it crashed or hung: the test that had begun
        names = [name for name in re.findall(r"^\[ RUN      \] (\S+)", output, re.M)][-1:]
        names = [f"{name} ({'hangs' if code is None else 'crashes'})" for name in names]
    if not names:
        names = [f"{shlex.split(command)[0]} (exit code {code})"]
    return names[0] + (f" and {len(names) - 1} more" if len(names) > 1 else ""), True


def try_one(mutation, baseline, log):
    """(result, remark)"""
    try:
        files = mutation.changed_files(COPY)
    except Bad as bad:
        return STALE, str(bad)
    for command in mutation.tests:
        if baseline[command]:
            return BAD_TEST, f"{command}: {baseline[command]}"
    try:
        for name, (_, after) in files.items():
            (COPY / name).write_text(after)
        try:
            build(mutation.build, log)
        except Bad as bad:
            return BROKEN, str(bad)
        for command in mutation.tests:
            who, _ = notice(command, log)
            if who:
                return CAUGHT, who
        return SURVIVED, "; ".join(mutation.tests)
    finally:
        for name, (before, _) in files.items():
            (COPY / name).write_text(before)


def row(mutation, result, remark, seconds):
    return f"{mutation.number:3d}  {mutation.title:<66} {result:<15} {seconds:5.0f} s  {remark}"


def main():
    parser = argparse.ArgumentParser(prog="./dev mutate", description="Break the code on purpose and see which tests notice.")
    parser.add_argument("numbers", metavar="N", type=int, nargs="*", help="numbers of mutations (default: all)")
    parser.add_argument("--again", action="store_true", help="also those that were caught before")
    parser.add_argument("--list", action="store_true", help="name them and do nothing")
    parser.add_argument("--check", action="store_true", help="only see whether they still apply to the working tree")
    arguments = parser.parse_args()
    chosen = load_all()
    unknown = set(arguments.numbers) - {m.number for m in chosen}
    if unknown:
        raise Bad(f"there is no mutation {', '.join(map(str, sorted(unknown)))}")
    chosen = [m for m in chosen if not arguments.numbers or m.number in arguments.numbers]
    if arguments.list:
        for m in chosen:
            print(f"{m.number:3d}  {m.title}")
        return 0
    if arguments.check:
        stale = 0
        for m in chosen:
            try:
                m.changed_files(ROOT)
            except Bad as bad:
                stale += 1
                print(f"{m.path.name} does not apply any more: {bad}")
        return 1 if stale else 0
    WORK.mkdir(parents=True, exist_ok=True)
    lock = open(WORK / "lock", "w")  # held until the end
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise Bad(f"another one is at work in {WORK.relative_to(ROOT)}") from None
    log = WORK / "mutate.log"
    log.write_text("")
    results = json.loads(RESULTS.read_text()) if RESULTS.is_file() else {}
    known = {} if arguments.again else {
        m.id: results[m.id] for m in chosen
        if m.id in results and results[m.id]["result"] == CAUGHT and results[m.id]["digest"] == m.digest}
    missing = [m for m in chosen if m.id not in known]
    baseline = {}
    if missing:
        copy_sources()
        configure(log)
        targets = sorted({target for m in missing for target in m.build})
        print(f"== building {' '.join(targets)} in {COPY.relative_to(ROOT)}", flush=True)
        build(targets, log)
        for command in dict.fromkeys(command for m in missing for command in m.tests):
            who, ran = notice(command, log)
            baseline[command] = f"{who} fails without it" if who else "" if ran else "no test ran without it"
    for m in missing:
        start = time.monotonic()
        result, remark = try_one(m, baseline, log)
        seconds = time.monotonic() - start
        print(row(m, result, remark, seconds), flush=True)
        results[m.id] = {"title": m.title, "result": result, "by": remark, "seconds": round(seconds, 1), "digest": m.digest}
        temporary = RESULTS.with_suffix(".tmp")
        temporary.write_text(json.dumps(results, indent=1, sort_keys=True) + "\n")
        temporary.replace(RESULTS)
    print()
    for m in chosen:
        r = results[m.id]
        print(row(m, r["result"], r["by"], r["seconds"]) + (" (before)" if m.id in known else ""))
    caught = sum(results[m.id]["result"] == CAUGHT for m in chosen)
    print(f"\ncaught {caught} of {len(chosen)}" + ("" if caught == len(chosen) else f"; the log: {log.relative_to(ROOT)}"))
    return 0 if caught == len(chosen) else 1


def stop(*_):
    raise KeyboardInterrupt


if __name__ == "__main__":
    for number in (signal.SIGINT, signal.SIGTERM):  # what runs in the background ignores the first
        signal.signal(number, stop)
    try:
        sys.exit(main())
    except Bad as bad:
        sys.exit(f"mutate: {bad}")
    except KeyboardInterrupt:
        sys.exit("mutate: stopped; call it again to go on")
