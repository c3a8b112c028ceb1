#!/usr/bin/env python3
"""Compare a membrane on tissue with FEniCS (Debian package python3-dolfin).

usage: dolfin_capsule.py PLIANT [FOLDER]

A ball of tet4 in a stiff thin capsule is held below and pulled aside above, at small displacement: "membrane" and dynamic relaxation here; there
linear elements and, over the boundary, the energy of plane stress of the tangential strain, P sym(grad u) P with P = I - n n. Prints the mean
displacement where the force acts, and the largest difference at the surface, with and without the capsule.
"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from calculix import box, surface_order, write_vtk

CELLS, RADIUS = 10, 0.05
YOUNG, POISSON, FORCE = 20000.0, 0.4, 0.001
CAPSULE = {"thickness": 0.0002, "young": 2e6, "poisson": 0.3}
LOW, HIGH = -0.57 * RADIUS, 0.57 * RADIUS


def ball():
    """A cube of cells, pushed outwards to spheres."""
    nodes, tets = box((CELLS,) * 3, (2.0,) * 3)

    def pushed(x):
        x = [c - 1 for c in x]
        length = math.hypot(*x)
        return tuple(RADIUS * c * max(map(abs, x)) / length for c in x) if length > 0 else (0.0, 0.0, 0.0)
    return [pushed(x) for x in nodes], tets


def their_displacements(df, nodes, tets, capsule):
    mesh, editor = df.Mesh(), df.MeshEditor()
    editor.open(mesh, "tetrahedron", 3, 3)
    editor.init_vertices(len(nodes))
    editor.init_cells(len(tets))
    for n, x in enumerate(nodes):
        editor.add_vertex(n, x)
    for e, tet in enumerate(tets):
        editor.add_cell(e, tet)
    editor.close()
    mesh.order()
    space = df.VectorFunctionSpace(mesh, "CG", 1)
    u, v = df.TrialFunction(space), df.TestFunction(space)
    eps = lambda w: df.sym(df.grad(w))  # noqa: E731
    lam, mu = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / (2 * (1 + POISSON))
    a = df.inner(lam * df.tr(eps(u)) * df.Identity(3) + 2 * mu * eps(u), eps(v)) * df.dx
    if capsule:
        n, nu = df.FacetNormal(mesh), CAPSULE["poisson"]
        p = df.Identity(3) - df.outer(n, n)
        flat = lambda w: p * eps(w) * p  # noqa: E731
        c = CAPSULE["young"] / (1 - nu * nu) * CAPSULE["thickness"]
        a += c * df.inner((1 - nu) * flat(u) + nu * df.tr(flat(u)) * p, flat(v)) * df.ds
    matrix, load = df.assemble(a), df.assemble(df.dot(df.Constant((0, 0, 0)), v) * df.dx)
    dofs = df.vertex_to_dof_map(space).reshape(-1, 3)
    values = load.get_local()
    end = [i for i, x in enumerate(nodes) if x[2] > HIGH]
    for i in end:
        values[dofs[i][0]] += FORCE / len(end)
    load.set_local(values)
    held = df.DirichletBC(space, df.Constant((0, 0, 0)), lambda x: x[2] < LOW, "pointwise")
    held.apply(matrix, load)
    out = df.Function(space)
    df.solve(matrix, out.vector(), load)
    return out.vector().get_local()[dofs]


def our_displacements(pliant, folder, nodes, tets, capsule):
    body = {"name": "ball", "mesh": "ball.vtk", "element": "tet4",
            "material": {"law": "saint-venant-kirchhoff", "young": YOUNG, "poisson": POISSON, "damping": 40},
            "fixed": [{"plane": [[0, 0, LOW], [0, 0, -1]]}], "forces": [{"plane": [[0, 0, HIGH], [0, 0, 1]], "force": [FORCE, 0, 0]}]}
    if capsule:
        body["membrane"] = CAPSULE
    scene = {"format": "pliant-scene/1", "relaxation": {"tolerance": 1e-9, "max_steps": 1000000}, "bodies": [body]}
    (folder / "ball.json").write_text(json.dumps(scene))
    out = Path(tempfile.mkdtemp(prefix="out-", dir=folder))
    subprocess.run([pliant, "run", folder / "ball.json", "--quiet", "--backend", "cpu:double", "--out", out, "--format", "obj"], check=True)
    lines = max(out.glob("*.obj")).read_text().splitlines()
    places = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    return {n: tuple(x - r for x, r in zip(at, nodes[n])) for n, at in zip(surface_order(tets), places, strict=True)}


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    try:
        import dolfin as df
    except ImportError:
        print("dolfin was not found (Debian package python3-dolfin): nothing was compared")
        return 77
    df.set_log_level(40)
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(tempfile.mkdtemp(prefix="pliant-capsule-"))
    folder.mkdir(parents=True, exist_ok=True)
    nodes, tets = ball()
    write_vtk(folder / "ball.vtk", nodes, tets)
    worst = 0.0
    for name, capsule in (("bare", False), ("capsule", True)):
        theirs = their_displacements(df, nodes, tets, capsule)
        ours = our_displacements(str(Path(sys.argv[1]).resolve()), folder, nodes, tets, capsule)
        largest = max(math.dist(theirs[n], (0, 0, 0)) for n in ours)
        miss = max(math.dist(u, theirs[n]) for n, u in ours.items()) / largest
        end = [n for n in ours if nodes[n][2] > HIGH]
        mean = [sum(u[n][0] for n in end) / len(end) for u in (ours, theirs)]
        print(f"{name:<8} {len(nodes)} nodes  {mean[0]:.9f} m (Pliant) {mean[1]:.9f} m (dolfin)  largest difference {miss:.2e}", flush=True)
        worst = max(worst, miss)
    return 0 if worst < 2e-4 else 1


if __name__ == "__main__":
    sys.exit(main())
