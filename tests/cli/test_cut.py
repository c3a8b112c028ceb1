#!/usr/bin/env python3
"""Blades through the command: what the files of a run show of a cut."""
import json
import re
import struct

from harness import SCENES, CliTest, main
from test_picture import glb

BLADE = {"name": "knife", "path": [[0, 0.013, 0.08, -0.1, 0.013, 0.08, 0.1], [0.05, 0.013, -0.08, -0.1, 0.013, -0.08, 0.1]]}


def vtu(path):
    """The arrays of a file that Pliant wrote, by name."""
    data = path.read_bytes()
    start = data.index(b"<AppendedData")
    start = data.index(b"_", start) + 1
    arrays = {}
    for kind, name, offset in re.findall(r'type="(\w+)" Name="([^"]+)".*?offset="(\d+)"', data[:start].decode()):
        at = start + int(offset)
        (size,) = struct.unpack("<Q", data[at : at + 8])
        letter, width = {"Float32": ("f", 4), "Int32": ("i", 4), "UInt8": ("B", 1)}[kind]
        arrays[name] = struct.unpack(f"<{size // width}{letter}", data[at + 8 : at + 8 + size])
    return arrays


class Moduli(CliTest):
    def test_frames_have_the_modulus_of_each_element(self):
        scene = json.loads((SCENES / "palpate_nodule.json").read_text())
        scene["bodies"][0]["mesh"] = str(SCENES / scene["bodies"][0]["mesh"])
        scene["tools"] = []
        scene["blades"] = [{"name": "knife", "path": [[0, -0.1, 0.03, -0.1, -0.1, 0.03, 0.1], [0.02, 0.2, 0.01, -0.1, 0.2, 0.01, 0.1]]}]
        file = self.folder / "nodule.json"
        file.write_text(json.dumps(scene))
        self.pliant("run", file, "--backend", "cpu", "--seconds", 0.03, "--every", "10ms", "--out", self.folder / "out")
        frames = sorted(set((self.folder / "out").glob("*.vtu")) - set((self.folder / "out").glob("*_surface_*.vtu")))
        first, last = vtu(frames[0]), vtu(frames[-1])
        text = (SCENES / "meshes/nodule_tet.vtu").read_text()
        given = [float(x) for x in re.search(r'Name="E"[^>]*>([^<]*)<', text).group(1).split()]
        for found, expected in zip(first["young"], given):
            self.assertAlmostEqual(found / expected, 1, delta=1e-6)
        self.assertEqual(set(first["fill"]), {1.0})
        self.assertGreater(len(last["young"]), len(given))
        self.assertLessEqual(set(last["young"]), set(first["young"]))


class Cut(CliTest):
    def scene_with_blade(self, **keys):
        return self.scene(body={"prescribed": []}, gravity=[0, 0, 0], blades=[BLADE], **keys)

    def test_elements_that_a_blade_left_whole(self):
        """The body reaches down to -0.05 in cells of 0.02: a blade that ends inside its last cell leaves the layer whole there."""
        for end, pieces, layer in ((-0.08, 2, 0), (-0.04, 1, 5), (0.01, 1, 5)):
            blade = {"name": "knife", "path": [[0, 0.013, 0.08, -0.1, 0.013, 0.08, 0.1], [0.05, 0.013, end, -0.1, 0.013, end, 0.1]]}
            scene = self.scene(body={"prescribed": []}, gravity=[0, 0, 0], blades=[blade])
            done = self.pliant("run", scene, "--backend", "cpu", "--seconds", 0.08)
            run = self.json("run", scene, "--backend", "cpu", "--seconds", 0.08)
            self.assertEqual((run["pieces"], run["cut_in_part"]), (pieces, layer), end)
            self.assertEqual(f", {layer} elements cut in part and still whole" in done.stdout, layer > 0, done.stdout)
        self.assertEqual(self.json("run", self.scene(), "--backend", "cpu", "--steps", 1)["cut_in_part"], 0)

    def test_vtu_marks_what_is_cut(self):
        self.pliant("run", self.scene_with_blade(), "--seconds", 0.08, "--every", 10, "--out", "out")
        surfaces = sorted((self.folder / "out").glob("*_surface_*.vtu"))
        cells = sorted(set((self.folder / "out").glob("*.vtu")) - set(surfaces))
        first, last = vtu(surfaces[0]), vtu(surfaces[-1])
        self.assertEqual(sum(first["cut"]), 0)
        self.assertEqual(len(first["cut"]), len(first["types"]))
        self.assertEqual(set(last["cut"]), {0.0, 1.0})
        self.assertEqual(len(last["cut"]), len(last["types"]))
        edges = {}
        for t in zip(*[iter(last["connectivity"])] * 3):
            for a, b in zip(t, t[1:] + t[:1]):
                edges[a, b] = edges.get((a, b), 0) + 1
        for (a, b), count in edges.items():
            self.assertEqual((count, edges.get((b, a))), (1, 1), "an open surface")
        first, last = vtu(cells[0]), vtu(cells[-1])
        self.assertEqual((len(first["cut"]), sum(first["cut"]), sum(first["piece"])), (125, 0, 0))
        self.assertEqual((len(last["cut"]), sum(last["cut"])), (150, 50))  # the 25 cells of one layer are there twice
        self.assertEqual(set(last["piece"]), {0.0, 1.0})
        self.assertAlmostEqual(sum(last["fill"]), sum(first["fill"]), places=4)

    def test_what_happened(self):
        far = {"name": "astray", "path": [[0, 0.5, 0.08, -0.1, 0.5, 0.08, 0.1], [0.05, 0.5, -0.08, -0.1, 0.5, -0.08, 0.1]]}
        late = {"name": "late", "path": [[1, 0.5, 0.08, -0.1, 0.5, 0.08, 0.1], [2, 0.5, -0.08, -0.1, 0.5, -0.08, 0.1]]}
        scene = self.scene(body={"prescribed": []}, gravity=[0, 0, 0], blades=[BLADE, far, late])
        run = self.json("run", scene, "--backend", "cpu", "--seconds", 0.08)
        # Across a layer of 25 cells: 36 edges of the lattice, 60 diagonals of faces, 25 of cells.
        self.assertEqual((run["cut_edges"], run["pieces"], run["broken_faces"]), (121, 2, 0))
        self.assertEqual((run["blades_without_contact"], run["blades_to_come"]), (["astray"], ["late"]))
        done = self.pliant("run", scene, "--backend", "cpu", "--seconds", 0.08)
        self.assertEqual(done.stderr.count("met nothing"), 1)
        self.assertIn("blade 'astray' met nothing", done.stderr)
        self.assertIn("blade 'late' has not cut yet: it begins at 1 s", done.stderr)
        self.assertNotIn("divided no edge", done.stderr)
        self.assertIn(", 121 edges cut, 2 pieces\n", done.stdout)
        # A blade that has left the body before the run is resumed has met it all the same.
        self.pliant("run", scene, "--backend", "cpu", "--seconds", 0.06, "--checkpoint", "c.pckpt")
        resumed = self.json("run", scene, "--backend", "cpu", "--seconds", 0.02, "--resume", "c.pckpt")
        self.assertEqual((resumed["cut_edges"], resumed["blades_without_contact"]), (121, ["astray"]))

    def test_what_flies_away_is_told(self):
        falling = self.scene(body={"prescribed": [], "fixed": []}, gravity=[0, -200, 0])
        for seconds, told in ((0.1, 0), (0.3, 1)):
            done = self.pliant("run", falling, "--backend", "cpu", "--seconds", seconds)
            self.assertEqual(done.stderr.count("nothing holds that part"), told, done.stderr)
        self.assertRegex(done.stderr, r"some of it is 5\.\d* m from its place at rest, 3\d\.?\d* times its size")

    def test_fewer_substeps_are_told(self):
        hybrid = {"material": {"young": 1000, "poisson": 0.4, "density": 1000},
                  "model": {"type": "hybrid", "substeps": 8, "goals": "held"},
                  "prescribed": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0.03, -0.07, 0], "curve": "smooth", "duration": 0.2}]}
        pressed = self.scene(body=hybrid, gravity=[0, 0, 0])
        result = self.json("run", pressed, "--backend", "cpu", "--seconds", 0.3)
        self.assertEqual(result["most_substeps"], 1)
        self.assertIn('hybrids went on with "substeps": 1', self.pliant("run", pressed, "--backend", "cpu", "--seconds", 0.3).stderr)
        hybrid["prescribed"][0]["displacement"] = [0, -0.001, 0]
        gently = self.scene(body=hybrid, gravity=[0, 0, 0])
        self.assertEqual(self.json("run", gently, "--backend", "cpu", "--seconds", 0.01)["most_substeps"], 0)

    def test_a_cut_too_short_for_the_elements(self):
        shallow = {"name": "scratch", "path": [[0, 0.013, 0.045, 0.001, 0.013, 0.045, 0.002], [0.01, 0.013, 0.044, 0.001, 0.013, 0.044, 0.002]]}
        scene = self.scene(body={"prescribed": []}, gravity=[0, 0, 0], blades=[shallow])
        done = self.pliant("run", scene, "--backend", "cpu", "--seconds", 0.02)
        self.assertIn("blade 'scratch' met tissue and divided no edge of an element", done.stderr)

    def test_tears_are_counted(self):
        """Each broken face is two triangles of the surface."""
        run = self.json("run", SCENES / "tear_sheet.json", "--backend", "cpu", "--out", "out", "--every", "10s")
        last = sorted((self.folder / "out").glob("*_surface_*.vtu"))[-1]
        self.assertGreater(run["broken_faces"], 50)
        self.assertEqual(2 * run["broken_faces"], sum(vtu(last)["cut"]))
        self.assertEqual((run["cut_edges"], run["max_displacement"] >= 0.024 - 1e-6), (0, True))
        volume = sorted(set((self.folder / "out").glob("*.vtu")) - set((self.folder / "out").glob("*_surface_*.vtu")))[-1]
        self.assertGreater(run["pieces"], 1)
        self.assertEqual(set(vtu(volume)["piece"]), set(range(run["pieces"])))

    def test_files_without_blades_have_no_arrays_of_cuts(self):
        self.pliant("run", self.scene(), "--steps", 2, "--out", "out")
        for file in (self.folder / "out").glob("*.vtu"):
            self.assertTrue({"cut", "piece"}.isdisjoint(vtu(file)), file)

    def test_gltf_has_a_mesh_per_topology(self):
        self.pliant("run", self.scene_with_blade(), "--seconds", 0.08, "--every", 10, "--out", "out", "--format", "gltf")
        document = glb(self.folder / "out" / "scene.glb")
        count = len(document["meshes"])
        self.assertGreater(count, 1)
        self.assertEqual(len(document["nodes"]), count)
        names = [material["name"] for material in document["materials"]]
        used = [{names[p["material"]] for p in mesh["primitives"]} for mesh in document["meshes"]]
        self.assertEqual(used[0], {"tissue"})
        self.assertEqual(used[-1], {"tissue", "cut"})
        data = (self.folder / "out" / "scene.glb").read_bytes()
        (text,) = struct.unpack("<I", data[12:16])

        def floats(accessor):
            view = document["bufferViews"][document["accessors"][accessor]["bufferView"]]
            at = 28 + text + view["byteOffset"]
            return struct.unpack(f"<{view['byteLength'] // 4}f", data[at : at + view["byteLength"]])

        # One mesh is there at a time: the steps of their scales follow each other without a gap.
        animation = document["animations"][0]
        shown = {}
        for channel in animation["channels"]:
            if channel["target"]["path"] != "scale":
                continue
            sampler = animation["samplers"][channel["sampler"]]
            self.assertEqual(sampler["interpolation"], "STEP")
            scale = dict(zip(floats(sampler["input"]), floats(sampler["output"])[::3]))
            begin = [t for t, s in scale.items() if s == 1]
            end = [t for t, s in scale.items() if s == 0 and t > begin[0]]
            shown[channel["target"]["node"]] = (begin, end)
        self.assertEqual(len(shown), count)
        for p in range(count - 1):
            self.assertEqual(shown[p][1], shown[p + 1][0])

    def test_bad_blades(self):
        for path, words in [
            ([[0, 0, 0, 0, 0, 0, 0], [1, 0, 1, 0, 0, 1, 1]], ["/blades/0/path/0"]),
            ([[0, 0, 0, 0, 0, 0, 1]], ["/blades/0/path"]),
            ([[1, 0, 0, 0, 0, 0, 1], [0, 0, 1, 0, 0, 1, 1]], ["/blades/0/path"]),
        ]:
            scene = json.loads(self.scene_with_blade().read_text())
            scene["blades"][0]["path"] = path
            file = self.folder / "bad.json"
            file.write_text(json.dumps(scene))
            self.refused("run", file, "--steps", 1, words=words)


if __name__ == "__main__":
    main()
