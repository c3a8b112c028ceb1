#!/usr/bin/env python3
"""Writes the meshes of the scenes that tear: meshes/sheet_tet.msh, a sheet with a notch, and meshes/gallbladder_tet.msh, a liver-like body with
a gallbladder under it and a layer between them, and meshes/liver_tet.msh and meshes/pear_tet.msh, the two without the layer. Both are grids of tetrahedra as in tet_meshes.py; those of the second one are chosen by a
distance function, and their boundary is drawn onto it. Running it again changes nothing.
"""
import pathlib

from tet_meshes import grid, volume, write_msh

CELL = 0.006  # of the organs [m]
LAYER = (-0.006, 0.0)  # between them, in y [m]


def without_unused(vertices, tets):
    number = {}
    for tet in tets:
        for n in tet:
            number.setdefault(n, len(number))
    kept = sorted(number, key=number.get)
    return [vertices[n] for n in kept], [tuple(number[n] for n in tet) for tet in tets]


def centroid(vertices, tet):
    return tuple(sum(vertices[n][c] for n in tet) / 4 for c in range(3))


def sheet():
    """100 x 60 x 4 mm, with a notch of 12 mm in the middle of one side."""
    vertices, tets = grid((0.1, 0.06, 0.004), (25, 15, 1), 0.2, 7)
    kept = []
    for tet in tets:
        x, y, _ = centroid(vertices, tet)
        if not (x < 0.012 and 0.028 < y < 0.032):
            kept.append(tet)
    return without_unused(vertices, kept)


def ellipsoid(p, centre, radii):
    """Negative inside, about the distance near the surface [m]."""
    q = [(p[c] - centre[c]) / radii[c] for c in range(3)]
    k = sum(v * v for v in q) ** 0.5
    slope = sum((v / r) ** 2 for v, r in zip(q, radii)) ** 0.5
    return k * (k - 1) / slope if slope > 0 else -min(radii)


def organs(p):
    """A liver-like half ellipsoid above y = 0, a pear below the layer, and the layer where both are near."""
    liver = max(ellipsoid(p, (0, 0.004, 0), (0.054, 0.036, 0.036)), -p[1])
    pear = max(min(ellipsoid(p, (0.006, -0.02, 0), (0.026, 0.017, 0.017)), ellipsoid(p, (-0.016, -0.016, 0), (0.02, 0.012, 0.011))),
               p[1] - LAYER[0])
    layer = max(abs(p[0] + 0.002) - 0.024, abs(p[2]) - 0.009, p[1], LAYER[0] - p[1])
    return min(liver, pear, layer)


def gradient(p, h=1e-5):
    out = []
    for c in range(3):
        low, high = list(p), list(p)
        low[c] -= h
        high[c] += h
        out.append((organs(high) - organs(low)) / (2 * h))
    return out


def boundary_nodes(tets):
    count = {}
    for tet in tets:
        for k in range(4):
            face = tuple(sorted(tet[:k] + tet[k + 1:]))
            count[face] = count.get(face, 0) + 1
    return sorted({n for face, times in count.items() if times == 1 for n in face})


def gallbladder():
    cells = (20, 14, 14)
    size = tuple(n * CELL for n in cells)
    origin = (-0.06, -0.042, -0.042)
    vertices, tets = grid(size, cells, 0, 7)
    vertices = [tuple(round(v[c] + origin[c], 9) for c in range(3)) for v in vertices]
    tets = [tet for tet in tets if organs(centroid(vertices, tet)) < 0]
    vertices, tets = without_unused(vertices, tets)
    around = [[] for _ in vertices]
    for tet in tets:
        for n in tet:
            around[n].append(tet)
    least = 0.3 * CELL**3 / 6
    for _ in range(3):
        for n in boundary_nodes(tets):
            p = vertices[n]
            g, f = gradient(p), organs(p)
            square = sum(v * v for v in g)
            if square < 0.1:
                continue
            step = [-f * v / square for v in g]
            if any(abs(p[1] - y) < 1e-9 for y in LAYER):
                step[1] = 0.0  # the sides of the layer stay flat
            for share in (1.0, 0.5, 0.25):
                vertices[n] = tuple(round(p[c] + share * step[c], 9) for c in range(3))
                if min(volume(vertices, tet) for tet in around[n]) >= least:
                    break
                vertices[n] = p
    return vertices, tets


def half(mesh, above):
    """The liver, or the gallbladder, without the layer between them."""
    vertices, tets = mesh
    middles = [centroid(vertices, tet)[1] for tet in tets]
    return without_unused(vertices, [tet for tet, y in zip(tets, middles) if (y > LAYER[1] if above else y < LAYER[0])])


def main():
    folder = pathlib.Path(__file__).resolve().parent.parent / "meshes"
    both = gallbladder()
    halves = (("liver_tet.msh", half(both, True)), ("pear_tet.msh", half(both, False)))
    for name, (vertices, tets) in (("sheet_tet.msh", sheet()), ("gallbladder_tet.msh", both), *halves):
        volumes = [volume(vertices, tet) for tet in tets]
        mean = sum(volumes) / len(volumes)
        assert min(volumes) > 0.1 * mean, f"{name}: a tetrahedron has only {min(volumes) / mean:.3f} of the mean volume"
        print(f"{name}: {len(vertices)} vertices, {len(tets)} tetrahedra, least volume {min(volumes) / mean:.2f} of the mean")
        write_msh(folder / name, vertices, tets)


if __name__ == "__main__":
    main()
