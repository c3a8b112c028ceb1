#!/usr/bin/env python3
"""Loops of the twins that end in "// vectorized" are: gcc says so. Usage: vectorized.py COMPILE_COMMANDS

One conditional copy of an array is enough for gcc to compute such a loop one element at a time, with the same bits in four times
the time. Compiles each file that has such loops as the build does."""
import concurrent.futures
import json
import re
import shlex
import subprocess
import sys

MARK = re.compile(r"for \(.*//.*\bvectorized\b")
NOTE = re.compile(r"([^\s:]+):(\d+):\d+: optimized: +loop vectorized")


def marked(file):
    with open(file, encoding="utf-8") as text:
        return [number for number, line in enumerate(text, 1) if MARK.search(line)]


def vectorized(entry):
    """Lines of the file at which gcc vectorized a loop."""
    command = shlex.split(entry["command"])
    if command[0].endswith("ccache"):
        command = command[1:]
    command[command.index("-o") + 1] = "/dev/null"
    run = subprocess.run(command + ["-fopt-info-vec-optimized"], cwd=entry["directory"], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(run.stderr)
    return {int(line) for file, line in NOTE.findall(run.stderr) if entry["file"].endswith(file.lstrip("./"))}


def main():
    with open(sys.argv[1], encoding="utf-8") as text:
        files = {e["file"]: e for e in json.load(text) if "/cpu_ref/" in e["file"] and marked(e["file"])}
    loops = missed = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = list(pool.map(vectorized, files.values()))
    for file, done in zip(files, results):
        for line in marked(file):
            loops += 1
            if line not in done:
                missed += 1
                print(f"{file}:{line}: gcc does not vectorize this loop (gcc -fopt-info-vec-missed says why)")
    print(f"{loops} loops in {len(files)} files, {missed} not vectorized")
    sys.exit(missed > 0 or loops == 0)


main()
