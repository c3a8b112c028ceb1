"""Steps per second of a pliant.Batch against as many single Worlds in a loop, alternating in one process.

Usage: PYTHONPATH=build/release/python python3 bench/batch/steps.py SCENE [-n MEMBERS] [--threads T ...] [--steps S] [--rounds R]
[--one-loop] [--sizes N ...]
The loop is over Worlds with one thread each; "as they are": with a thread for every core. Ratios of the loop's times to the others' are medians over
rounds, with the least and the largest. A round counts as disturbed by other programs where a call got less than 0.9 of the cores that it has threads for;
figures are of undisturbed rounds, or, marked so, of all where there are none. "cores": processor time over time, in the median;
"of processor time": by what all cores worked for the process, which other programs disturb less than the clock.
"""
import argparse
import os
import time

import numpy as np

import pliant


def memory():
    """Resident memory of this process [bytes]."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def seconds(call):
    """On the clock, and of all cores together."""
    start, busy = time.perf_counter(), time.process_time()
    call()
    return time.perf_counter() - start, time.process_time() - busy


def single_worlds(scene, n, cores):
    """Each has as many threads as the thread that makes it may use cores."""
    all_cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, cores)
    worlds = [pliant.World(scene, backend="cpu", normals=False) for _ in range(n)]
    os.sched_setaffinity(0, all_cores)
    return worlds


def loop(worlds, steps):
    for world in worlds:
        world.step(steps)


def report(steps, times, threads):
    pairs = {name: np.array(rounds[1:]) for name, rounds in times.items()}  # the first round warms up
    free = np.all([pairs[name][:, 1] > 0.9 * t * pairs[name][:, 0] for name, t in threads.items()], axis=0)
    print(f"{free.sum()} of {len(free)} rounds undisturbed" + ("" if free.any() else "; figures of all rounds"))
    used = free if free.any() else ~free
    reference, reference_busy = next(iter(pairs.values()))[used].T
    for name, rounds in pairs.items():
        clock, busy = rounds[used].T
        ratios = reference / clock
        print(f"{name}: {steps / np.median(clock):.0f} steps/s, {np.median(busy / clock):.2f} cores, {np.median(ratios):.2f} times the first line's "
              f"({ratios.min():.2f} to {ratios.max():.2f}), of processor time {np.median(reference_busy / busy):.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("-n", type=int, default=64)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--steps", type=int, default=10, help="of each member in one call")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--alone", action="store_true", help="no single Worlds: memory and steps per second of the Batch")
    parser.add_argument("--one-loop", action="store_true", help="without the loop over Worlds as they are, for want of memory")
    parser.add_argument("--sizes", type=int, nargs="+", default=[], help="of further Batches whose members are to have the same hash")
    options = parser.parse_args()
    n, steps = options.n, options.steps
    empty = memory()
    batches = {t: pliant.Batch(options.scene, n, threads=t) for t in options.threads}
    each = (memory() - empty) / n / len(batches)
    print(f"{options.scene}: {n} members of {batches[options.threads[0]][0].info['nodes']} nodes, {each / 2**20:.2f} MiB each, {steps} steps a call")
    calls, singles = {}, []
    if not options.alone:
        cores = os.sched_getaffinity(0)
        for name, used in (("loop", {min(cores)}), ("loop, Worlds as they are", cores))[:2 - options.one_loop]:
            worlds = single_worlds(options.scene, n, used)
            calls[name] = lambda worlds=worlds: loop(worlds, steps)
            singles += worlds
    calls |= {f"Batch, {t} thread{'s'[:t > 1]}": (lambda b=b: b.step(steps)) for t, b in batches.items()}
    times = {name: [] for name in calls}
    for _ in range(options.rounds + 1):
        for name, call in calls.items():
            times[name].append(seconds(call))
    report(n * steps, times, {name: int(name.split()[1]) if name.startswith("Batch") else 1 for name in times if "as they are" not in name})
    hashes = {h for b in batches.values() for h in b.hashes()} | {w.hash() for w in singles}
    for size in options.sizes:
        with pliant.Batch(options.scene, size) as batch:
            for _ in range(options.rounds + 1):
                batch.step(steps)
            hashes |= set(batch.hashes())
    print(f"hashes of all members{', and of Batches of ' + ', '.join(map(str, options.sizes)) if options.sizes else ''}:", "the same" if len(hashes) == 1 else f"{len(hashes)} different ones")


if __name__ == "__main__":
    main()
