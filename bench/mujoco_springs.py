#!/usr/bin/env python3
"""Compare the motion of a network of springs with MuJoCo (PyPI package mujoco).

usage: mujoco_springs.py PLIANT [FOLDER]

Writes a block of tetrahedra whose edges are springs as a scene, and the same network as a model of MuJoCo: one body with three slides per node,
one spatial tendon per spring, integrated by RK4. One side is held; gravity and an initial velocity move the rest, until springs have
stretched by tens of percent. Prints the largest displacement, and the largest difference between the two after each tenth of the time.
"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from calculix import box, surface_order, write_vtk

CELLS, SIZE = (4, 2, 2), (0.08, 0.04, 0.04)
DENSITY, STIFFNESS, DAMPING, SECONDS, FRAMES = 1000.0, 8.0, 1.0, 0.3, 10


def masses(nodes, tets):
    out = [0.0] * len(nodes)
    for tet in tets:
        a, b, c, d = (nodes[n] for n in tet)
        u, v, w = ([x - y for x, y in zip(p, a)] for p in (b, c, d))
        volume = abs(u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6
        for n in tet:
            out[n] += DENSITY * volume / 4
    return out


def model(nodes, tets):
    """MJCF text. The held nodes are sites of the world."""
    mass = masses(nodes, tets)
    edges = sorted({tuple(sorted((t[i], t[j]))) for t in tets for i in range(4) for j in range(i)})
    out = ["<mujoco><option timestep='2e-5' integrator='RK4' gravity='0 -9.81 0'/><worldbody>"]
    for n, x in enumerate(nodes):
        at = " ".join(repr(c) for c in x)
        site = f"<site name='s{n}'/>"
        if x[0] < 1e-9:
            out.append(f"<site name='s{n}' pos='{at}'/>")
            continue
        slides = "".join(f"<joint name='{a}{n}' type='slide' axis='{axis}' damping='{DAMPING * mass[n]!r}'/>"
                         for a, axis in zip("xyz", ("1 0 0", "0 1 0", "0 0 1")))
        out.append(f"<body pos='{at}'>{slides}<inertial pos='0 0 0' mass='{mass[n]!r}' diaginertia='1e-9 1e-9 1e-9'/>{site}</body>")
    out.append("</worldbody><tendon>")
    for a, b in edges:
        out.append(f"<spatial stiffness='{STIFFNESS}' springlength='{math.dist(nodes[a], nodes[b])!r}'><site site='s{a}'/><site site='s{b}'/></spatial>")
    return "".join(out) + "</tendon></mujoco>", len(edges)


def their_frames(nodes, tets, text):
    import mujoco
    body = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(body)
    free = [n for n, x in enumerate(nodes) if x[0] >= 1e-9]
    for i, n in enumerate(free):
        data.qvel[3 * i + 2] = 10 * nodes[n][0]
    frames = []
    for frame in range(1, FRAMES + 1):
        while data.time < SECONDS * frame / FRAMES - 1e-9:
            mujoco.mj_step(body, data)
        at = {n: tuple(nodes[n][c] + data.qpos[3 * i + c] for c in range(3)) for i, n in enumerate(free)}
        frames.append({n: at.get(n, nodes[n]) for n in range(len(nodes))})
    return frames


def our_frames(pliant, folder, nodes, tets):
    scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "duration": SECONDS, "dt": 2e-5,
             "bodies": [{"name": "block", "mesh": "block.vtk", "model": {"type": "mass-spring", "spring": {"stiffness": STIFFNESS}},
                         "material": {"young": 1000, "poisson": 0.25, "density": DENSITY, "damping": DAMPING},
                         "fixed": [{"plane": [[1e-9, 0, 0], [-1, 0, 0]]}],
                         "initial": [{"all": True, "velocity": {"linear": [[0, 0, 0], [0, 0, 0], [10, 0, 0]]}}]}]}
    write_vtk(folder / "block.vtk", nodes, tets)
    (folder / "block.json").write_text(json.dumps(scene))
    steps = round(SECONDS / FRAMES / scene["dt"])
    subprocess.run([pliant, "run", folder / "block.json", "--quiet", "--backend", "cpu", "--out", folder / "out", "--format", "obj", "--every", str(steps)],
                   check=True)
    order, frames = surface_order(tets), []
    for file in sorted((folder / "out").glob("*.obj"))[1:]:
        vertices = [tuple(map(float, line.split()[1:4])) for line in file.read_text().splitlines() if line.startswith("v ")]
        frames.append(dict(zip(order, vertices)))
    return frames


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    try:
        import mujoco
    except ImportError:
        print("mujoco was not found (pip install mujoco): nothing was compared")
        return 77
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(tempfile.mkdtemp(prefix="pliant-mujoco-"))
    folder.mkdir(parents=True, exist_ok=True)
    nodes, tets = box(CELLS, SIZE)
    text, springs = model(nodes, tets)
    theirs, ours = their_frames(nodes, tets, text), our_frames(str(Path(sys.argv[1]).resolve()), folder, nodes, tets)
    print(f"{len(nodes)} nodes, {springs} springs, MuJoCo {mujoco.__version__}")
    worst = 0.0
    for k, (mine, other) in enumerate(zip(ours, theirs, strict=True)):
        largest = max(math.dist(other[n], nodes[n]) for n in mine)
        miss = max(math.dist(mine[n], other[n]) for n in mine) / largest
        print(f"{SECONDS * (k + 1) / FRAMES:.2f} s  largest displacement {1000 * largest:6.2f} mm  largest difference {miss:.1e} of it")
        worst = max(worst, miss)
    return 0 if worst < 1e-3 else 1


if __name__ == "__main__":
    sys.exit(main())
