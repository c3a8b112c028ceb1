#!/usr/bin/env python3
"""Writes the small tetrahedral meshes beside the scenes: meshes/beam_tet.msh, meshes/cube_tet.vtu, and meshes/nodule_tet.vtu, whose
elements have a modulus each.

Each is a grid of boxes split into six tetrahedra along a diagonal (Kuhn's split, mirrored from box to box so that shared faces
agree), with every vertex moved at random inside its face, edge or volume. The seed is fixed: running it again changes nothing.
"""

import itertools
import pathlib
import random


def grid(size, cells, jitter, seed):
    """Vertices and tetrahedra of the box [0, size] with the given number of cells per axis.

    A vertex moves by at most `jitter` cell edges along each axis on which it is not on the boundary.
    """
    rng = random.Random(seed)
    step = [s / n for s, n in zip(size, cells)]
    vertices = []
    for k, j, i in itertools.product(*(range(n + 1) for n in reversed(cells))):
        moved = [
            at * h + (rng.uniform(-jitter, jitter) * h if 0 < at < n else 0.0) for at, n, h in zip((i, j, k), cells, step)
        ]
        vertices.append(tuple(round(x, 9) for x in moved))

    def node(corner):
        return corner[0] + (cells[0] + 1) * (corner[1] + (cells[1] + 1) * corner[2])

    tets = []
    for k, j, i in itertools.product(*(range(n) for n in reversed(cells))):
        cell = (i, j, k)
        # Walk from one end of the diagonal to the other, one axis at a time; odd cells are mirrored.
        start = [c + c % 2 for c in cell]
        direction = [1 - 2 * (c % 2) for c in cell]
        for axes in itertools.permutations(range(3)):
            corner = list(start)
            tet = [node(corner)]
            for axis in axes:
                corner[axis] += direction[axis]
                tet.append(node(corner))
            if volume(vertices, tet) < 0:
                tet[2], tet[3] = tet[3], tet[2]
            tets.append(tuple(tet))
    return vertices, tets


def volume(vertices, tet):
    o, a, b, c = (vertices[n] for n in tet)
    u, v, w = ([p[k] - o[k] for k in range(3)] for p in (a, b, c))
    return (
        u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])
    ) / 6


def check(name, size, vertices, tets):
    """No tetrahedron may have turned over, and together they must fill the box."""
    volumes = [volume(vertices, tet) for tet in tets]
    mean = size[0] * size[1] * size[2] / len(tets)
    assert min(volumes) > 0.1 * mean, f"{name}: a tetrahedron has only {min(volumes) / mean:.3f} of the mean volume"
    assert abs(sum(volumes) / (mean * len(tets)) - 1) < 1e-7, f"{name}: the volumes do not add up"
    print(f"{name}: {len(vertices)} vertices, {len(tets)} tetrahedra, least volume {min(volumes) / mean:.2f} of the mean")


def write_msh(path, vertices, tets):
    """Gmsh 2.2 text; nodes and elements are numbered from 1."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(vertices))]
    lines += [f"{n} {x:.9g} {y:.9g} {z:.9g}" for n, (x, y, z) in enumerate(vertices, 1)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    lines += [f"{n} 4 2 1 1 " + " ".join(str(v + 1) for v in tet) for n, tet in enumerate(tets, 1)]
    lines += ["$EndElements", ""]
    path.write_text("\n".join(lines))


def write_vtu(path, vertices, tets, moduli=None):
    """VTK XML with the numbers as text; `moduli` [Pa]: the array "E" of the elements."""

    def array(kind, name, components, rows):
        head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">'
        return [head, *rows, "</DataArray>"]

    lines = ['<?xml version="1.0"?>', '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">']
    lines += ["<UnstructuredGrid>", f'<Piece NumberOfPoints="{len(vertices)}" NumberOfCells="{len(tets)}">', "<Points>"]
    lines += array("Float64", "Points", 3, [" ".join(f"{x:.9g}" for x in v) for v in vertices])
    lines += ["</Points>", "<Cells>"]
    lines += array("Int32", "connectivity", 1, [" ".join(map(str, tet)) for tet in tets])
    lines += array("Int32", "offsets", 1, [" ".join(str(4 * n) for n in range(1, len(tets) + 1))])
    lines += array("UInt8", "types", 1, [" ".join(["10"] * len(tets))])
    lines += ["</Cells>"]
    if moduli:
        lines += ["<CellData>", *array("Float64", "E", 1, [" ".join(f"{m:.6g}" for m in moduli)]), "</CellData>"]
    lines += ["</Piece>", "</UnstructuredGrid>", "</VTKFile>", ""]
    path.write_text("\n".join(lines))


def modulus(vertices, tet):
    """Soft tissue of 4 kPa with a nodule that grows stiffer towards its middle, to 60 kPa."""
    middle = [sum(vertices[n][k] for n in tet) / 4 for k in range(3)]
    away = sum(((m - c) / r) ** 2 for m, c, r in zip(middle, (0.05, 0.015, 0.025), (0.012, 0.008, 0.012)))
    return 4000 + 56000 * max(0.0, 1 - away) ** 0.5


def main():
    folder = pathlib.Path(__file__).resolve().parent.parent / "meshes"
    folder.mkdir(exist_ok=True)
    for name, size, cells, write in (
        ("beam_tet.msh", (0.1, 0.02, 0.02), (20, 3, 3), write_msh),
        ("cube_tet.vtu", (0.1, 0.1, 0.1), (4, 4, 4), write_vtu),
    ):
        vertices, tets = grid(size, cells, 0.2, 2024)
        check(name, size, vertices, tets)
        write(folder / name, vertices, tets)
    size, name = (0.08, 0.025, 0.05), "nodule_tet.vtu"
    vertices, tets = grid(size, (16, 5, 10), 0.2, 2026)
    check(name, size, vertices, tets)
    write_vtu(folder / name, vertices, tets, [modulus(vertices, tet) for tet in tets])


if __name__ == "__main__":
    main()
