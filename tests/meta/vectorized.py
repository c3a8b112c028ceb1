#!/usr/bin/env python3
"""Loops of the twins that end in "// vectorized" are: gcc says so. Usage: vectorized.py COMPILE_COMMANDS

One conditional copy of an array is enough for gcc to compute such a loop one element at a time, with the same bits in four times
the time. Compiles each file that has such loops as the build does. "// vectorized in part": in some of the functions that the file
makes of it, such as those of some laws."""
import concurrent.futures
import json
import re
import shlex
import subprocess
import sys

MARK = re.compile(r"for \(.*//.*\bvectorized\b")
NOTE = re.compile(r"([^\s:]+):(\d+):\d+: (optimized: +loop vectorized|missed: couldn't vectorize loop)")


def marked(file):
    with open(file, encoding="utf-8") as text:
        return {number: "in part" in line for number, line in enumerate(text, 1) if MARK.search(line)}


def vectorized(entry):
    """Lines of the file at which gcc vectorized a loop, and those at which it did not, in any of the functions made of it."""
    command = shlex.split(entry["command"])
    command[command.index("-o") + 1] = "/dev/null"
    notes = ["-fopt-info-vec-optimized", "-fopt-info-vec-missed"]
    run = subprocess.run(command + notes, cwd=entry["directory"], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(run.stderr)
    done, missed = set(), set()
    for file, line, what in NOTE.findall(run.stderr):
        if entry["file"].endswith(file.lstrip("./")):
            (done if what.startswith("optimized") else missed).add(int(line))
    return done, missed


def main():
    with open(sys.argv[1], encoding="utf-8") as text:
        files = {e["file"]: e for e in json.load(text) if "/pliant_ref.dir/" in e["command"] and marked(e["file"])}
    loops = failed = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = list(pool.map(vectorized, files.values()))
    for file, (done, missed) in zip(files, results):
        for line, in_part in marked(file).items():
            loops += 1
            if line not in done or (line in missed and not in_part):
                failed += 1
                print(f"{file}:{line}: gcc does not vectorize this loop (gcc -fopt-info-vec-missed says why)")
    print(f"{loops} loops in {len(files)} files, {failed} not vectorized")
    sys.exit(failed > 0 or loops == 0)


main()
