#!/usr/bin/env python3
"""Steps per second of a pliant.Batch beside MuJoCo's rollout of as many worlds (PyPI package mujoco), in pairs.

Usage: PYTHONPATH=build/release/python python3 bench/batch/mujoco_flex.py [-n WORLDS] [--threads T ...] [--steps S] [--rounds R]

The body is the same on both sides: a cube of 0.1 m, 64 nodes, 162 linear tetrahedra, Saint-Venant-Kirchhoff, 5 kPa, damping in proportion to the
stiffness, held below, under gravity, without contact. In MuJoCo it is a flex of elements with three slides a node. Two of its integrators are timed:
Euler, explicit as Pliant's and with the same step, and discrete, implicit with a step ten times as long. First one world of each comes to rest, and must
sag as far as Pliant's. Then each round times both, one after the other, on as many cores as there are threads. Ratios are of simulated time in the two
times of a round: the median over rounds, with the least and the largest; "of processor time": by what all cores worked for the process, which other
programs disturb less than the clock. A round counts as disturbed where a call got less than 0.9 of its cores; figures are of undisturbed rounds, or,
marked so, of all where there are none.
"""
import argparse
import math
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import pliant

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from calculix import box, write_vtk  # noqa: E402

CELLS, SIZE, DT = (3, 3, 3), (0.1, 0.1, 0.1), 2e-3
INTEGRATORS = {"Euler": DT, "discrete": 10 * DT}  # of MuJoCo, with their steps [s]
YOUNG, POISSON, DENSITY, DAMPING = 5000.0, 0.3, 1000.0, 0.005  # damping [s] in proportion to the stiffness


def masses(nodes, tets):
    corners = np.array(nodes)[np.array(tets)]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    mass = np.zeros(len(nodes))
    np.add.at(mass, np.array(tets), DENSITY * volumes[:, None] / 4)
    return mass


def held(x):
    return x[1] < 1e-9


def mjcf(nodes, tets, integrator):
    """A body with three slides for each free node; the flex joins them."""
    mass, bodies, names = masses(nodes, tets).tolist(), [], []
    for n, x in enumerate(nodes):
        at, names = " ".join(map(repr, x)), [*names, f"n{n}"]
        slides = "" if held(x) else "".join(f"<joint type='slide' axis='{axis}'/>" for axis in ("1 0 0", "0 1 0", "0 0 1"))
        inertia = "" if held(x) else f"<inertial pos='0 0 0' mass='{mass[n]!r}' diaginertia='1e-9 1e-9 1e-9'/>"
        bodies.append(f"<body name='n{n}' pos='{at}'>{slides}{inertia}</body>")
    right = [t if np.linalg.det(np.array([np.subtract(nodes[c], nodes[t[0]]) for c in t[1:]])) > 0 else (t[0], t[2], t[1], t[3]) for t in tets]
    flex = (f"<flex name='cube' dim='3' radius='0.001' body='{' '.join(names)}' vertex='{' '.join(['0'] * 3 * len(nodes))}' "
            f"element='{' '.join(str(c) for t in right for c in t)}'>"
            f"<contact contype='0' conaffinity='0' selfcollide='none'/>"
            f"<elasticity young='{YOUNG}' poisson='{POISSON}' damping='{DAMPING}'/></flex>")
    return (f"<mujoco><option timestep='{INTEGRATORS[integrator]}' integrator='{integrator}' gravity='0 -9.81 0'/><worldbody>{''.join(bodies)}</worldbody>"
            f"<deformable>{flex}</deformable></mujoco>")


def scene(folder, nodes, tets):
    write_vtk(folder / "cube.vtk", nodes, tets)
    return {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "dt": DT,
            "bodies": [{"name": "cube", "mesh": str(folder / "cube.vtk"), "element": "tet4", "fixed": [{"plane": [[0, 1e-9, 0], [0, -1, 0]]}],
                        "material": {"law": "saint-venant-kirchhoff", "young": YOUNG, "poisson": POISSON, "density": DENSITY, "stiffness_damping": DAMPING}}]}


class Theirs:
    """MuJoCo's own threads over the worlds, each call from where the last one ended."""

    def __init__(self, text, n, threads, steps):
        import mujoco
        import mujoco.rollout
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = [mujoco.MjData(self.model) for _ in range(threads)]
        kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
        start = np.zeros(mujoco.mj_stateSize(self.model, kind))
        mujoco.mj_getState(self.model, self.data[0], start, kind)
        self.state = np.tile(start, (n, 1))
        self.out = np.zeros((n, steps, start.size))
        self.sensors = np.zeros((n, steps, self.model.nsensordata))
        self.rollout, self.steps = mujoco.rollout.Rollout(nthread=threads if threads > 1 else 0), steps

    def step(self):
        self.rollout.rollout(self.model, self.data, self.state, nstep=self.steps, state=self.out, sensordata=self.sensors)
        self.state = self.out[:, -1].copy()

    def sag(self):
        return -self.state[0, 1:1 + self.model.nq].reshape(-1, 3)[:, 1].min()


def check_sag(spec, texts):
    """Of the top after 8 s, by then at rest to a thousandth."""
    steps = 100
    world = pliant.World(spec, backend="cpu")
    world.step(round(8 / DT))
    frame = world.frame()
    ours = (frame.rest[:, 1] - frame.positions[:, 1]).max()
    print(f"the top sags {1000 * ours:.3f} mm with Pliant")
    for integrator, text in texts.items():
        theirs = Theirs(text, 1, 1, steps)
        for _ in range(round(8 / INTEGRATORS[integrator] / steps)):
            theirs.step()
        print(f"  {1000 * theirs.sag():.3f} mm with MuJoCo's {integrator}")
        if not math.isclose(ours, theirs.sag(), rel_tol=0.002):
            sys.exit("they are not the same body: nothing was timed")


def seconds(call):
    start, busy = time.perf_counter(), time.process_time()
    call()
    return time.perf_counter() - start, time.process_time() - busy


def compare(spec, texts, n, threads, steps, rounds):
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, set(sorted(cores)[:threads]))
    with pliant.Batch(spec, n, threads=threads) as batch:
        calls = [lambda: batch.step(steps)] + [Theirs(text, n, threads, steps).step for text in texts.values()]
        times = np.array([[seconds(call) for call in calls] for _ in range(rounds + 1)])[1:]  # the first round warms up
    os.sched_setaffinity(0, cores)
    had = times[:, :, 1] / times[:, :, 0]
    free = (had > 0.9 * threads).all(axis=1)
    print(f"{threads} core{'s'[:threads > 1]}, of which the calls had {np.median(had):.2f}; {free.sum()} of {rounds} rounds undisturbed"
          + ("" if free.any() else "; figures of all"))
    times = times[free] if free.any() else times
    rates = [f"{n * steps / clock:.0f} steps/s, {n * steps / busy:.0f} a second of processor time" for clock, busy in np.median(times, axis=0)]
    print(f"  Pliant: {rates[0]}")
    for k, integrator in enumerate(texts, 1):
        longer = INTEGRATORS[integrator] / DT
        clock, busy = (times[:, k, c] / times[:, 0, c] / longer for c in (0, 1))
        print(f"  MuJoCo's {integrator}: {rates[k]}, each {longer:.0f} times as long; Pliant simulates "
              f"{np.median(clock):.2f} times as much ({clock.min():.2f} to {clock.max():.2f}), of processor time {np.median(busy):.2f} "
              f"({busy.min():.2f} to {busy.max():.2f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-n", type=int, default=1024)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--steps", type=int, default=10, help="of each world in one call")
    parser.add_argument("--rounds", type=int, default=15)
    options = parser.parse_args()
    try:
        import mujoco
    except ImportError:
        print("mujoco was not found (pip install mujoco): nothing was compared")
        return 77
    nodes, tets = box(CELLS, SIZE)
    with tempfile.TemporaryDirectory() as folder:
        spec, texts = scene(Path(folder), nodes, tets), {integrator: mjcf(nodes, tets, integrator) for integrator in INTEGRATORS}
        print(f"{len(nodes)} nodes, {len(tets)} tetrahedra, {options.n} worlds, {options.steps} steps a call, dt {DT} s, MuJoCo {mujoco.__version__}")
        check_sag(spec, texts)
        for threads in options.threads:
            compare(spec, texts, options.n, threads, options.steps, options.rounds)
    return 0


if __name__ == "__main__":
    sys.exit(main())
