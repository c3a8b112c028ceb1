#!/usr/bin/env python3
"""Writes the triangle surfaces of the scenes with sheets: meshes/skin.obj, a square with a slit in its middle, and meshes/cloth.obj, a square. Their
inner vertices are moved a little from those of a grid, so that no direction is favoured. Running it again changes nothing.
"""
import pathlib
import random


def square(size, cells, seed):
    """Vertices and triangles of a square in the plane z = 0, centred at the origin; the diagonals alternate."""
    rng, h = random.Random(seed), size / cells
    vertices = []
    for j in range(cells + 1):
        for i in range(cells + 1):
            inner = 0 < i < cells and 0 < j < cells
            shift = [0.15 * h * rng.uniform(-1, 1) if inner else 0.0 for _ in range(2)]
            vertices.append([i * h - size / 2 + shift[0], j * h - size / 2 + shift[1], 0.0])
    triangles = []
    for j in range(cells):
        for i in range(cells):
            a = j * (cells + 1) + i
            b, c, d = a + 1, a + cells + 2, a + cells + 1
            triangles += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    return vertices, triangles


def slit(vertices, triangles, cells, size, reach, width):
    """Opens the grid's middle row over |x| < reach to a lens that is `width` wide in its middle."""
    row = cells // 2
    upper = {}
    for i in range(cells + 1):
        v = row * (cells + 1) + i
        x = i * size / cells - size / 2
        if abs(x) > reach:
            continue
        vertices[v][0], vertices[v][1] = x, 0.0
        half = width / 2 * (1 - (x / reach) ** 2)
        if abs(x) < reach - 1e-9:
            upper[v] = len(vertices)
            vertices.append([x, half, 0.0])
            vertices[v][1] = -half
    out = []
    for t in triangles:
        above = sum(vertices[v][1] for v in t if v not in upper) > 0
        out.append(tuple(upper.get(v, v) for v in t) if above else t)
    return vertices, out


def write_obj(name, vertices, triangles):
    path = pathlib.Path(__file__).resolve().parent.parent / "meshes" / name
    with open(path, "w", encoding="ascii") as out:
        out.writelines(f"v {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in vertices)
        out.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)


def main():
    cells, size = 20, 0.08
    write_obj("skin.obj", *slit(*square(size, cells, 3), cells, size, 0.012, 0.0012))
    write_obj("cloth.obj", *square(0.16, 24, 5))


if __name__ == "__main__":
    main()
