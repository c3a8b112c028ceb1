"""Texture coordinates of a surface: through cuts, in OBJ and glTF files, after a resumed run, in a region that moves."""
import json
import math
import random
import struct

import harness
from test_fields import read_glb

SIDE, EXACT = 3, 1e-6
BLADE = {"name": "b", "path": [[0, 0.013, 0.08, -0.1, 0.013, 0.08, 0.1], [0.2, 0.017, -0.08, -0.1, 0.017, -0.08, 0.1]]}


def grid_cube():
    """Triangles of a cube of 0.1 m, 3 x 3 squares a face, wound outward."""
    triangles = []
    for axis in range(3):
        for high in (0, 1):
            def point(i, j):
                p = [0, 0, 0]
                p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = high * SIDE, i, j
                return tuple(0.1 * c / SIDE - 0.05 for c in p)
            for i in range(SIDE):
                for j in range(SIDE):
                    a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
                    triangles += [t if high else t[::-1] for t in ((a, b, c), (a, c, d))]
    return triangles


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def weights(triangle, p):
    """Barycentric coordinates of a point, and its distance to the plane."""
    e, f, d = sub(triangle[1], triangle[0]), sub(triangle[2], triangle[0]), sub(p, triangle[0])
    n = cross(e, f)
    v, w = dot(cross(d, f), n) / dot(n, n), dot(cross(e, d), n) / dot(n, n)
    return (1 - v - w, v, w), abs(dot(d, n)) / dot(n, n) ** 0.5


def read_obj(file):
    """Per triangle its group, and positions, texture coordinates and normals of its corners."""
    lists, out, group = {"v": [], "vt": [], "vn": []}, [], None
    for line in file.read_text().splitlines():
        key, *words = line.split()
        if key in lists:
            lists[key].append([float(w) for w in words])
        elif key == "g":
            group = words[0]
        elif key == "f":
            corners = [[int(i) - 1 for i in w.split("/")] for w in words]
            out.append((group, *[[lists[k][c[n]] for c in corners] for n, k in enumerate(("v", "vt", "vn"))]))
    return out


class Texture(harness.CliTest):
    def setUp(self):
        super().setUp()
        draw = random.Random(5)
        self.source = [(t, [[draw.uniform(0, 1), draw.uniform(0, 1)] for _ in t]) for t in grid_cube()]
        lines, number = [], 0
        for index, (corners, at) in enumerate(self.source):
            order = (0, 2, 1) if index in (7, 30) else (0, 1, 2)  # two are wound the wrong way round
            copies = 2 if index == 11 else 1                        # and one stands twice, the second time with other coordinates
            for copy in range(copies):
                for k in order:
                    lines += ["v {} {} {}".format(*corners[k]), "vt {} {}".format(*(c + copy for c in at[k]))]
                lines.append("f " + " ".join(f"{number + k}/{number + k}" for k in (1, 2, 3)))
                number += 3
        (self.folder / "textured.obj").write_text("\n".join(lines) + "\n")

    def textured(self, name="scene", body=None, **keys):
        # Without gravity nothing moves, so that places in the files are those at rest.
        body = {"surface": "textured.obj", "prescribed": [], **(body or {})}
        return self.scene(name, body=body, gravity=[0, 0, 0], dt=0.002, duration=0.24, **keys)

    def compare(self, corners, at):
        """The coordinates are affine on a triangle of the file that holds all of it; a sliver on an edge lies in two of them."""
        least = math.inf
        for triangle, own in self.source:
            places = [weights(triangle, p) for p in corners]
            if all(away < 1e-6 and min(inside) > -1e-5 for inside, away in places):
                wanted = [[dot(inside, c) for c in zip(*own)] for inside, _ in places]
                least = min(least, max(abs(a - b) for pair in zip(at, wanted) for a, b in zip(*pair)))
        self.assertLess(least, EXACT, f"{corners}: {at}")

    def check_obj(self, file, cut):
        faces = read_obj(file)
        self.assertEqual({f[0] for f in faces}, {"skin", "cut"} if cut else {"skin"})
        across = whole = 0
        for group, corners, at, normals in faces:
            n = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]))
            area = dot(n, n) ** 0.5
            for normal in normals:
                self.assertAlmostEqual(dot(normal, normal), 1, delta=1e-5)
                whole += area
                across += area if dot(n, normal) > 0.99 * area else 0
            if group == "skin":
                self.compare(corners, at)
            else:
                self.assertEqual(at, [[0, 0]] * 3)
        # All faces are flat. Slivers along edges have no direction and join what they touch.
        self.assertGreater(across, 0.85 * whole)
        return faces

    def test_through_a_cut(self):
        for element, model in (("hex8", None), ("tet4", None), ("hex8", {"type": "hybrid", "ratio": 0.5, "width": 1, "follow": "b"})):
            scene = self.textured(blades=[BLADE], body={"element": element, **({"model": model} if model else {})})
            run = self.json("run", scene, "--backend", "cpu", "--out", "out", "--every", "80ms", "--format", "obj")
            self.assertEqual(run["pieces"], 2)
            self.assertEqual(len(self.check_obj(self.folder / "out" / "scene_surface_00000000.obj", False)), len(self.source))
            faces = self.check_obj(self.folder / "out" / "scene_surface_00000080.obj", True)  # on the way
            self.assertGreater(len(faces), len(self.source))
            self.check_obj(self.folder / "out" / "scene_surface_00000120.obj", True)

    def test_the_second_of_two_bodies(self):
        """One beside it, whose file has no coordinates, has (0, 0); it is not cut."""
        scene = json.loads(self.textured(blades=[BLADE]).read_text())
        plain = {**scene["bodies"][0], "name": "plain", "surface": str(harness.SCENES / "meshes" / "cube.obj"), "translate": [0.3, 0, 0]}
        scene["bodies"] = [plain, scene["bodies"][0]]
        (self.folder / "two.json").write_text(json.dumps(scene))
        self.pliant("run", "two.json", "--backend", "cpu", "--out", "out", "--every", 1000, "--format", "obj")
        sides = [0, 0]
        for group, corners, at, _ in read_obj(self.folder / "out" / "two_surface_00000120.obj"):
            own = corners[0][0] < 0.2
            sides[own] += 1
            if group == "skin" and own:
                self.compare(corners, at)
            else:
                self.assertEqual(at, [[0, 0]] * 3)
        self.assertGreater(min(sides), 0)

    def test_a_resumed_run_has_the_same(self):
        scene = self.textured(blades=[BLADE])
        self.pliant("run", scene, "--backend", "cpu", "--out", "whole", "--every", 1000, "--format", "obj")
        self.pliant("run", scene, "--backend", "cpu", "--steps", 70, "--checkpoint", "half.pckpt")
        self.pliant("run", scene, "--backend", "cpu", "--resume", "half.pckpt", "--out", "half", "--every", 1000, "--format", "obj")
        whole, half = (read_obj(self.folder / name / "scene_surface_00000120.obj") for name in ("whole", "half"))
        self.assertEqual(sorted(map(str, whole)), sorted(map(str, half)))

    def test_animation(self):
        """The last mesh of the animation, cut; glTF counts v from the upper edge."""
        self.json("run", self.textured(blades=[BLADE]), "--backend", "cpu", "--out", "out", "--every", 40, "--format", "gltf")
        top, numbers = read_glb(self.folder / "out" / "scene.glb")
        skin, cut = top["meshes"][-1]["primitives"]
        self.assertEqual(top["accessors"][skin["attributes"]["TEXCOORD_0"]]["type"], "VEC2")
        place, at = numbers(skin["attributes"]["POSITION"]), numbers(skin["attributes"]["TEXCOORD_0"])
        self.assertEqual(len(place) // 3, len(at) // 2)
        for first in range(0, len(corners := numbers(skin["indices"])), 3):
            triangle = corners[first:first + 3]
            self.compare([place[3 * i:3 * i + 3] for i in triangle], [[at[2 * i], 1 - at[2 * i + 1]] for i in triangle])
        self.assertEqual({(at[2 * i], at[2 * i + 1]) for i in numbers(cut["indices"])}, {(0.0, 1.0)})

    def test_read_from_gltf(self):
        self.json("run", self.textured(), "--backend", "cpu", "--out", "a", "--steps", 0, "--format", "gltf")
        again = self.textured("again", body={"surface": "a/scene.glb"})
        self.json("run", again, "--backend", "cpu", "--out", "b", "--steps", 0, "--format", "obj")
        self.check_obj(self.folder / "b" / "again_surface_00000000.obj", False)

    def test_without_coordinates_nothing_is_added(self):
        self.json("run", self.scene(dt=0.002, blades=[BLADE]), "--backend", "cpu", "--out", "out", "--steps", 100, "--format", "obj,gltf")
        words = {line.split()[0] for line in (self.folder / "out" / "scene_surface_00000100.obj").read_text().splitlines()}
        self.assertEqual(words, {"v", "f"})
        top, _ = read_glb(self.folder / "out" / "scene.glb")
        self.assertEqual(set(top["meshes"][-1]["primitives"][0]["attributes"]), {"POSITION", "NORMAL"})

    def test_bad_coordinates_are_refused(self):
        self.json("run", self.textured(), "--backend", "cpu", "--out", "a", "--steps", 0, "--format", "gltf")
        top, _ = read_glb(self.folder / "a" / "scene.glb")
        data = bytearray((self.folder / "a" / "scene.glb").read_bytes())
        view = top["accessors"][top["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]]["bufferView"]
        struct.pack_into("<f", data, 28 + struct.unpack_from("<I", data, 12)[0] + top["bufferViews"][view]["byteOffset"], math.nan)
        (self.folder / "bad.glb").write_bytes(data)
        self.refused("run", self.textured("again", body={"surface": "bad.glb"}), "--backend", "cpu",
                     words=["bad.glb", "texture coordinates (nan, ", "finite ones are needed"])


if __name__ == "__main__":
    harness.main()
