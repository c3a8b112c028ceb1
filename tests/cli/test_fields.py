"""run --fields: stresses, strains, energies and contact pressures in the files of frames, against closed forms and each other."""
import itertools
import json
import math
import struct

import harness
from test_files import read_vtu

LINEAR = [[0.2, 0.1, 0], [0, -0.05, 0.07], [0, 0, 0.1]]
MATERIAL = {"law": "neo-hookean", "lambda": 2000, "mu": 1000, "density": 1000}


def read_glb(file):
    """The JSON of a .glb, and a function that gives an accessor's numbers."""
    data = file.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    top = json.loads(data[20:20 + size])

    def numbers(index):
        accessor = top["accessors"][index]
        count = accessor["count"] * {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        at = 28 + size + top["bufferViews"][accessor["bufferView"]]["byteOffset"]
        return struct.unpack_from(f"<{count}{'f' if accessor['componentType'] == 5126 else 'I'}", data, at)

    return top, numbers


def keys(place):
    """The corners of a grid of 2e-6 m around a place: two places that rounding has parted have one in common."""
    sides = [(math.floor(5e5 * c), math.floor(5e5 * c) + 1) for c in place]
    return list(itertools.product(*sides))


def expected():
    """By textbook, of the deformation gradient I + LINEAR: the fields of a homogeneous body."""
    f = [[LINEAR[i][j] + (i == j) for j in range(3)] for i in range(3)]
    b = [[sum(f[i][k] * f[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
    c = [[sum(f[k][i] * f[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    jac = f[0][0] * f[1][1] * f[2][2]  # of a triangular one
    sigma = [[1000 / jac * (b[i][j] - (i == j)) + 2000 * (jac - 1) * (i == j) for j in range(3)] for i in range(3)]
    norm = lambda m: math.sqrt(sum((m[i][j] - (m[0][0] + m[1][1] + m[2][2]) / 3 * (i == j)) ** 2 for i in range(3) for j in range(3)))
    green = [[(c[i][j] - (i == j)) / 2 for j in range(3)] for i in range(3)]
    energy = 500 * (b[0][0] + b[1][1] + b[2][2] - 3) - 1000 * math.log(jac) + 1000 * (jac - 1) ** 2
    return {"stress": [sigma[0][0], sigma[1][1], sigma[2][2], sigma[0][1], sigma[1][2], sigma[0][2]],
            "mises": [math.sqrt(1.5) * norm(sigma)], "green_strain": [math.sqrt(2 / 3) * norm(green)], "energy": [energy]}


class Fields(harness.CliTest):
    def run_fields(self, scene, fields, *arguments):
        return self.json("run", scene, "--backend", "cpu", "--out", "out", "--fields", fields, *arguments)

    def test_of_a_homogeneous_body_are_the_closed_forms(self):
        for element, count in (("hex8", 125), ("tet4", 750), ("hex8full", 125)):
            scene = self.scene(dt=0.0001, gravity=[0, 0, 0], body={"element": element, "material": MATERIAL, "fixed": [], "prescribed": [],
                                                                   "initial": [{"all": True, "displacement": {"linear": LINEAR}}]})
            self.run_fields(scene, "mises,stress,green_strain,energy,mises", "--steps", 0)
            root, volume = read_vtu(self.folder / "out" / "scene_00000000.vtu")
            _, surface = read_vtu(self.folder / "out" / "scene_surface_00000000.vtu")
            components = {a.get("Name"): a.get("NumberOfComponents") for a in root.iter("DataArray")}
            self.assertEqual((components["stress"], components["mises"]), ("6", "1"))
            self.assertNotIn("stress", surface)  # of elements alone
            for name, values in expected().items():
                self.assertEqual(len(volume[name]), count * len(values))
                for i, value in enumerate(volume[name]):
                    self.assertAlmostEqual(value, values[i % len(values)], delta=2e-4 * abs(values[0]), msg=name)
                if name != "stress":
                    self.assertEqual(len(surface[name]), len(surface["displacement"]) // 3)
                    self.assertTrue(all(abs(v - values[0]) < 2e-4 * values[0] for v in surface[name]), name)
            # The corners of the cells, so that whoever reads the file has the elements.
            corners = 4 if element == "tet4" else 8
            self.assertEqual((len(volume["connectivity"]), volume["offsets"][-1]), (corners * count, corners * count))

    def test_no_bit_changes_and_nothing_unasked_is_written(self):
        scene = self.scene(dt=0.002)
        plain = self.json("run", scene, "--backend", "cpu", "--steps", 25, "--out", "plain")
        self.assertEqual(self.run_fields(scene, "mises,pressure,model", "--steps", 25, "--format", "vtu,gltf")["deep_hash"], plain["deep_hash"])
        self.assertEqual(set(read_vtu(self.folder / "plain" / "scene_00000025.vtu")[1]) & {"mises", "model", "contact_pressure"}, set())

    def test_contact_pressure_and_models(self):
        """A ball presses from above, so the lower half feels nothing. The lower two of five layers of the other body are elements."""
        tool = {"name": "ball", "shape": {"sphere": 0.03}, "path": [[0, 0, 0.079, 0], [0.2, 0, 0.07, 0]]}
        scene = self.scene(dt=0.001, gravity=[0, 0, 0], body={"prescribed": []}, tools=[tool])
        self.run_fields(scene, "pressure", "--seconds", 0.2, "--every", 1000)
        _, volume = read_vtu(self.folder / "out" / "scene_00000200.vtu")
        _, surface = read_vtu(self.folder / "out" / "scene_surface_00000200.vtu")
        self.assertNotIn("contact_pressure", volume)
        pressure, x, u = surface["contact_pressure"], surface["Points"], surface["displacement"]
        self.assertGreater(max(pressure), 10)
        self.assertTrue(all(p == 0 for i, p in enumerate(pressure) if x[3 * i + 1] - u[3 * i + 1] < 0))
        scene = self.scene(name="hybrid", body={"model": {"type": "hybrid", "width": 1, "region": {"box": [[-1, -1, -1], [1, -0.01, 1]]}}})
        self.run_fields(scene, "model", "--steps", 1)
        _, volume = read_vtu(self.folder / "out" / "hybrid_00000001.vtu")
        self.assertEqual((sum(volume["model"]), len(volume["model"])), (50, 125))

    def test_attributes_of_an_animation(self):
        """In every frame the attribute plus what the frame's target adds to it is the value of the VTU file, at the same places."""
        # It is strained from the start, so that the values of the first frame are not 0.
        stretched = {"fixed": [], "prescribed": [], "initial": [{"all": True, "displacement": {"linear": LINEAR}}]}
        self.run_fields(self.scene(dt=0.002, body=stretched), "mises,model", "--steps", 60, "--every", 30, "--format", "vtu,gltf")
        top, numbers = read_glb(self.folder / "out" / "scene.glb")
        primitive = top["meshes"][0]["primitives"][0]
        self.assertEqual(top["accessors"][primitive["attributes"]["_MODEL"]]["type"], "VEC3")
        for frame, step in enumerate((0, 30, 60)):
            place, value = numbers(primitive["attributes"]["POSITION"]), numbers(primitive["attributes"]["_MISES"])
            self.assertEqual(len(place), 3 * len(value))
            if frame > 0:
                target = primitive["targets"][frame - 1]
                place = [a + b for a, b in zip(place, numbers(target["POSITION"]))]
                value = [a + b for a, b in zip(value, numbers(target["_MISES"]))]
            _, surface = read_vtu(self.folder / "out" / f"scene_surface_{step:08}.vtu")
            points = surface["Points"]
            at = {key: v for i, v in enumerate(surface["mises"]) for key in keys(points[3 * i:3 * i + 3])}
            for i, v in enumerate(value):
                found = [at[key] for key in keys(place[3 * i:3 * i + 3]) if key in at]
                self.assertGreater(len(found), 0)
                self.assertAlmostEqual(v, found[0], delta=2e-3)
            self.assertGreater(max(value), 50)

    def test_refused(self):
        scene = self.scene()
        for arguments, words in ((["--fields", "misses", "--out", "out"], ["--fields: got \"misses\"", "allowed are mises, stress", "did you mean mises?"]),
                                 (["--fields", "mises"], ["needs --out DIR"]),
                                 (["--fields", "mises", "--out", "out", "--format", "obj"], ["needs --format vtu or gltf"])):
            self.refused("run", scene, *arguments, words=words)
        static = self.scene("static", body={"element": "tet4"}, solver={"type": "static"})
        self.refused("run", static, "--fields", "mises", "--out", "out", words=["--fields", "static"])
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    harness.main()
