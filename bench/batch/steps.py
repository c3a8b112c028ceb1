"""Steps per second of a pliant.Batch against as many single Worlds in a loop, alternating in one process.

Usage: PYTHONPATH=build/release/python python3 bench/batch/steps.py SCENE [-n MEMBERS] [--threads T ...] [--steps S] [--rounds R]
The single Worlds are made as Worlds are: each has a thread for every core. Ratios are medians over the rounds, with the lowest and the highest.
"""
import argparse
import os
import statistics
import time

import pliant


def memory():
    """Resident memory of this process [bytes]."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def seconds(call):
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def loop(worlds, steps):
    for world in worlds:
        world.step(steps)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("-n", type=int, default=64)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--steps", type=int, default=10, help="of each member in one call")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--alone", action="store_true", help="no single Worlds: memory and steps per second of the Batch")
    options = parser.parse_args()
    n, steps = options.n, options.steps
    empty = memory()
    batches = {t: pliant.Batch(options.scene, n, threads=t) for t in options.threads}
    each = (memory() - empty) / n / len(batches)
    print(f"{options.scene}: {n} members of {batches[options.threads[0]][0].info['nodes']} nodes, {each / 2**20:.2f} MiB each, {steps} steps a call")
    singles = [] if options.alone else [pliant.World(options.scene, backend="cpu", normals=False) for _ in range(n)]
    calls = {f"{t} threads": (lambda b=b: b.step(steps)) for t, b in batches.items()}
    if singles:
        calls["loop"] = lambda: loop(singles, steps)
    times = {name: [] for name in calls}
    for _ in range(options.rounds + 1):
        for name, call in calls.items():
            times[name].append(seconds(call))
    for name in calls:
        rest = times[name][1:]  # the first round warms up
        line = f"{name}: {n * steps / statistics.median(rest):.0f} steps/s"
        if singles:
            ratios = [a / b for a, b in zip(times["loop"][1:], rest)]
            line += f", {statistics.median(ratios):.2f} times the loop ({min(ratios):.2f} to {max(ratios):.2f})"
        print(line)
    hashes = {h for b in batches.values() for h in b.hashes()} | {w.hash() for w in singles}
    print("hashes of all members:", "the same" if len(hashes) == 1 else f"{len(hashes)} different ones")


if __name__ == "__main__":
    main()
