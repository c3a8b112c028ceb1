#!/usr/bin/env python3
"""clang-format, cppcheck and clang-tidy. Usage: lint.py all | changed | staged | these FILE...

all: over all files. changed: the same, but clang-tidy only over what is not in the last commit but one; it is a stage of ./dev test.
these: over the files given. staged: the format of what is about to be committed. kernels/*.h are also OpenCL C: of them only the
format is checked.
"""
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
LOG = ROOT / "build/log"
MOST_TIDIED = 12  # files, so that a stage of ./dev test stays short; `all` looks at all of them
JOBS = int(os.environ.get("PLIANT_JOBS") or len(os.sched_getaffinity(0)))


def say(text):
    print(f"== {text}", flush=True)


def output(*command, **more):
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, errors="replace", **more).stdout


def git_files(*arguments):
    return output("git", *arguments, stderr=subprocess.DEVNULL).split("\0")[:-1]


def write_log(name, lines):
    (LOG / name).write_text("".join(f"{line}\n" for line in lines))
    print("".join(f"{line}\n" for line in lines), end="", flush=True)


def check_format(files):
    """Its exit code is no help: 1 for a place that it would change, and for a file that it cannot read."""
    say(f"clang-format: {len(files)} files")
    said = output("clang-format", "--dry-run", *files, stderr=subprocess.STDOUT) if files else ""
    places = {}
    for file, line in re.findall(r"^([^:\n]+):(\d+):\d+: warning", said, re.M):
        places.setdefault(file, []).append(line)
    lines = [f"{file}:{at[0]}: {len(at)} places; clang-format -i {file}" for file, at in places.items()]
    lines += [line for line in said.splitlines() if re.search("rror", line) and ": warning" not in line]
    write_log("clang-format.log", sorted(lines))
    return not lines


def configure():
    """A folder of its own: the compilation database of clang++, without precompiled headers, with the fuzzers."""
    done = subprocess.run(["cmake", "--preset", "fuzz", "-B", "build/lint", "-DCMAKE_UNITY_BUILD=OFF", "-DPLIANT_PCH=OFF", "-DPLIANT_CCACHE=OFF"],
                          cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    (LOG / "lint-configure.log").write_text(done.stdout)
    if done.returncode != 0:
        print(*done.stdout.splitlines()[-60:], "lint.py: CMake failed; the whole log: build/log/lint-configure.log", sep="\n")
        sys.exit(1)


def check_cpp(files):
    say(f"cppcheck: {len(files)} files")
    command = ["cppcheck", "--quiet", "--std=c++20", "--language=c++", "--inline-suppr", "--enable=warning,performance,portability",
               "--error-exitcode=1", "-j", str(JOBS), "--suppressions-list=tests/lint/cppcheck.txt",
               "-I", "include", "-I", "host", "-I", "kernels", "-I", "."]
    return not files or subprocess.run([*command, *files], cwd=ROOT).returncode == 0


def tidy(file):
    said = output("clang-tidy", "-p", "build/lint", "--quiet", "--extra-arg=-Wno-pragma-once-outside-header", file, stderr=subprocess.DEVNULL)
    return [line.removeprefix(f"{ROOT}/") for line in said.splitlines() if re.search("(warning|error): ", line)]


def known_to_build(files):
    """Those with a command of their own: for others, like the Python module, clang-tidy guesses one, without their headers."""
    known = {Path(entry["file"]).resolve() for entry in json.loads((ROOT / "build/lint/compile_commands.json").read_text())}
    return [file for file in files if (ROOT / file).resolve() in known]


def check_tidy(files):
    files = known_to_build(files)
    say(f"clang-tidy: {len(files)} files")
    with ThreadPoolExecutor(JOBS) as pool:
        lines = sorted({line for found in pool.map(tidy, files) for line in found})
    write_log("clang-tidy.log", lines)
    return lines


def lint(which, files):
    LOG.mkdir(parents=True, exist_ok=True)
    if which == "these":
        cxx = [f for f in files if f.endswith((".cpp", ".h")) and not f.startswith("kernels/")]
    else:
        files = git_files("ls-files", "-z", "*.h", "*.cpp", "*.c")
        cxx = [f for f in files if f.endswith(".cpp")]
    tidied = cxx
    if which == "changed":
        tidied = git_files("diff", "--name-only", "-z", "--diff-filter=d", "HEAD~1", "--", "*.cpp")[:MOST_TIDIED]
    formatted = check_format(files)
    configure()
    clean = check_cpp(cxx)
    tidy_lines = check_tidy(tidied)
    # A file that does not compile by itself: the builds of ./dev test compile several at a time and do not see it.
    compiles = not any(re.search("error: .*clang-diagnostic-error", line) for line in tidy_lines)
    found = not clean or bool(tidy_lines)
    say("found something, see above" if found or not formatted else "nothing found")
    # In a stage of ./dev test only the format and a file that does not compile fail: what else the two find depends on their versions.
    return formatted and compiles and (which == "changed" or not found)


def staged():
    """Whether the text in git's index is formatted."""
    well = True
    for file in git_files("diff", "--cached", "--name-only", "-z", "--diff-filter=d", "--", "*.h", "*.cpp", "*.c"):
        text = subprocess.run(["git", "show", f":{file}"], cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout
        command = ["clang-format", "--dry-run", "-Werror", f"--assume-filename={file}"]
        if subprocess.run(command, cwd=ROOT, input=text, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
            print(f"{file}: not formatted; clang-format -i {file} && git add {file}")
            well = False
    return well


if __name__ == "__main__":
    try:
        sys.exit(0 if (staged() if sys.argv[1] == "staged" else lint(sys.argv[1], sys.argv[2:])) else 1)
    except KeyboardInterrupt:
        sys.exit(130)
