#!/usr/bin/env python3
"""Compare the static solver with CalculiX (Debian package calculix-ccx) on two problems.

usage: calculix.py PLIANT [FOLDER]

Writes a box of tet10 as a deck for ccx and as a scene with "solver": {"type": "static", "order": 2} on the same tetrahedra. The problems
are a cantilever with a force at its end: linear elasticity, and Saint-Venant-Kirchhoff at large displacement, which is ccx's
*ELASTIC with NLGEOM. Prints the mean displacement of the end by both and the largest difference at the corners of the elements.
"""
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

CELLS, SIZE = (16, 4, 4), (0.2, 0.05, 0.05)
YOUNG, POISSON = 20000.0, 0.4
PATHS = ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))


def box(cells=CELLS, size=SIZE):
    """Corner nodes, and tetrahedra around each cell's diagonal from corner 0 to 7."""
    nx, ny, nz = cells
    nodes = [tuple(size[c] * at[c] / cells[c] for c in range(3))
             for at in ((i, j, k) for k in range(nz + 1) for j in range(ny + 1) for i in range(nx + 1))]
    tets = []
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                c = [(i + (a & 1)) + (nx + 1) * ((j + (a >> 1 & 1)) + (ny + 1) * (k + (a >> 2 & 1))) for a in range(8)]
                tets += [(c[0], c[p], c[q], c[7]) for p, q in PATHS]
    return nodes, tets


def write_vtk(file, nodes, tets):
    lines = ["# vtk DataFile Version 3.0", "box", "ASCII", "DATASET UNSTRUCTURED_GRID", f"POINTS {len(nodes)} double"]
    lines += [" ".join(repr(x) for x in node) for node in nodes]
    lines += [f"CELLS {len(tets)} {5 * len(tets)}"] + ["4 " + " ".join(map(str, t)) for t in tets]
    lines += [f"CELL_TYPES {len(tets)}"] + ["10"] * len(tets)
    file.write_text("\n".join(lines) + "\n")


def write_deck(file, nodes, tets, force, nonlinear):
    nodes, middles, elements = list(nodes), {}, []
    for tet in tets:
        corners = list(tet)
        for i, j in EDGES:
            key = tuple(sorted((tet[i], tet[j])))
            if key not in middles:
                middles[key] = len(nodes)
                nodes.append(tuple((a + b) / 2 for a, b in zip(nodes[key[0]], nodes[key[1]])))
            corners.append(middles[key])
        elements.append(corners)
    corners_only = {n for tet in tets for n in tet}
    wall = [n for n, x in enumerate(nodes) if abs(x[0]) < 1e-12]
    end = [n for n in corners_only if abs(nodes[n][0] - SIZE[0]) < 1e-12]
    out = ["*NODE, NSET=ALL"] + [f"{n + 1}, " + ", ".join(repr(x) for x in node) for n, node in enumerate(nodes)]
    out += ["*ELEMENT, TYPE=C3D10, ELSET=BODY"]
    out += [f"{e + 1}, " + ", ".join(str(n + 1) for n in element) for e, element in enumerate(elements)]
    out += ["*NSET, NSET=WALL"] + [f"{n + 1}," for n in wall]
    out += ["*MATERIAL, NAME=SOFT", "*ELASTIC", f"{YOUNG}, {POISSON}", "*SOLID SECTION, ELSET=BODY, MATERIAL=SOFT"]
    out += ["*BOUNDARY", "WALL, 1, 3", "*STEP, NLGEOM, INC=1000" if nonlinear else "*STEP", "*STATIC", "0.1, 1." if nonlinear else "1., 1."]
    out += ["*CLOAD"] + [f"{n + 1}, 3, {force / len(end)!r}" for n in end]
    out += ["*NODE PRINT, NSET=ALL, FREQUENCY=1000000", "U", "*END STEP"]
    file.write_text("\n".join(out) + "\n")
    return len(nodes)


def ccx_displacements(file, count):
    """The last table of displacements in a .dat file."""
    table, tables = {}, []
    for line in file.read_text().splitlines():
        if "displacements" in line:
            table = {}
            tables.append(table)
        parts = line.split()
        if len(parts) == 4 and re.fullmatch(r"\d+", parts[0]):
            table[int(parts[0]) - 1] = tuple(map(float, parts[1:]))
    assert tables and len(tables[-1]) == count, "ccx printed no complete table of displacements"
    return tables[-1]


def pliant_displacements(pliant, folder, nodes, force, linear):
    scene = {"format": "pliant-scene/1", "solver": {"type": "static", "order": 2, "linear": linear, "tolerance": 1e-10},
             "bodies": [{"name": "beam", "mesh": "box.vtk", "element": "tet4",
                         "material": {"law": "saint-venant-kirchhoff", "young": YOUNG, "poisson": POISSON},
                         "fixed": [{"plane": [[1e-9, 0, 0], [-1, 0, 0]]}],
                         "forces": [{"plane": [[SIZE[0] - 1e-9, 0, 0], [1, 0, 0]], "force": [0, 0, force]}]}]}
    (folder / "beam.json").write_text(json.dumps(scene))
    subprocess.run([pliant, "run", folder / "beam.json", "--quiet", "--out", folder / "out", "--format", "obj"], check=True)
    # Nine digits of the surface: enough for a comparison to 1e-6 of the size.
    vertices = [tuple(map(float, line.split()[1:4])) for line in (folder / "out" / "beam_surface.obj").read_text().splitlines()
                if line.startswith("v ")]
    return vertices


def boundary(tets):
    """Faces of one tetrahedron alone, outward."""
    faces = {}
    for tet in tets:
        for f in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)):
            corners = tuple(tet[i] for i in f)
            faces.setdefault(tuple(sorted(corners)), []).append(corners)
    return [found[0] for found in faces.values() if len(found) == 1]


def surface_order(tets):
    """Nodes of the boundary in the order in which Pliant numbers the vertices of a mesh's surface: as its triangles name them."""
    return list(dict.fromkeys(n for triangle in boundary(tets) for n in triangle))


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    if shutil.which("ccx") is None:
        print("ccx was not found (Debian package calculix-ccx): nothing was compared")
        return 77
    pliant = str(Path(sys.argv[1]).resolve())
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(tempfile.mkdtemp(prefix="pliant-calculix-"))
    folder.mkdir(parents=True, exist_ok=True)
    nodes, tets = box()
    write_vtk(folder / "box.vtk", nodes, tets)
    order = surface_order(tets)
    worst = 0.0
    for name, nonlinear, force in (("linear", False, -0.001), ("nonlinear", True, -0.05)):
        count = write_deck(folder / f"{name}.inp", nodes, tets, force, nonlinear)
        log = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True)
        (folder / f"{name}.log").write_text(log.stdout + log.stderr)
        theirs = ccx_displacements(folder / f"{name}.dat", count)
        moved = pliant_displacements(pliant, folder, nodes, force, not nonlinear)
        assert len(moved) == len(order), (len(moved), len(order))
        ours = {n: tuple(x - r for x, r in zip(at, nodes[n])) for n, at in zip(order, moved)}
        largest = max(math.dist(theirs[n], (0, 0, 0)) for n in order)
        miss = max(math.dist(ours[n], theirs[n]) for n in order) / largest
        end = [n for n in order if abs(nodes[n][0] - SIZE[0]) < 1e-12]
        tip = [sum(u[n][2] for n in end) / len(end) for u in (ours, theirs)]
        print(f"{name:<10} {count} nodes  tip {tip[0]:.8f} m (Pliant) {tip[1]:.8f} m (CalculiX)  largest difference {miss:.2e}")
        worst = max(worst, miss)
    return 0 if worst < 1e-4 else 1


if __name__ == "__main__":
    sys.exit(main())
