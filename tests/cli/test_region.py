"""Selections by the tags of mesh files: what a region chooses is what a box around it chooses, to the bit."""
import itertools
import json

import harness

STIFF = {"young": 30000, "poisson": 0.3}
EDGE = 0.01


def bar(nx=8, ny=3, nz=3):
    """Nodes [m] and tetrahedra of a bar, six for each cubic cell, with the cell's place along x."""
    def node(x, y, z):
        return (x * (ny + 1) + y) * (nz + 1) + z
    nodes = [(EDGE * x, EDGE * y, EDGE * z) for x in range(nx + 1) for y in range(ny + 1) for z in range(nz + 1)]
    tets, places = [], []
    for cell in itertools.product(range(nx), range(ny), range(nz)):
        for order in itertools.permutations(range(3)):
            at, corners = list(cell), [node(*cell)]
            for axis in order:
                at[axis] += 1
                corners.append(node(*at))
            if order in ((0, 2, 1), (1, 0, 2), (2, 1, 0)):
                corners[2:] = corners[:1:-1]
            tets.append(corners)
            places.append(cell[0])
    end = [(a, b, c) for y in range(ny) for z in range(nz)
           for a, b, c in ((node(nx, y, z), node(nx, y + 1, z), node(nx, y + 1, z + 1)),
                           (node(nx, y, z), node(nx, y + 1, z + 1), node(nx, y, z + 1)))]
    return nodes, tets, places, end


def gmsh(nodes, tets, tags, faces, face_tag):
    cells = [(2, face_tag, f) for f in faces] + [(4, t, c) for t, c in zip(tags, tets)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 7 "end"', '3 3 "tumour"', "$EndPhysicalNames", "$Nodes",
                      str(len(nodes))] + [f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(nodes)] +
                     ["$EndNodes", "$Elements", str(len(cells))] +
                     [f"{i + 1} {kind} 2 {tag} 1 " + " ".join(str(n + 1) for n in c) for i, (kind, tag, c) in enumerate(cells)] +
                     ["$EndElements", ""])


def vtk(nodes, tets, tags, faces, face_tag, name="material"):
    cells = [(5, face_tag, f) for f in faces] + [(10, t, c) for t, c in zip(tags, tets)]
    return "\n".join(["# vtk DataFile Version 3.0", "bar", "ASCII", "DATASET UNSTRUCTURED_GRID", f"POINTS {len(nodes)} double"] +
                     [f"{x!r} {y!r} {z!r}" for x, y, z in nodes] +
                     [f"CELLS {len(cells)} {sum(len(c) + 1 for _, _, c in cells)}"] + [f"{len(c)} " + " ".join(map(str, c)) for _, _, c in cells] +
                     [f"CELL_TYPES {len(cells)}"] + [str(kind) for kind, _, _ in cells] +
                     [f"CELL_DATA {len(cells)}", f"SCALARS {name} int 1", "LOOKUP_TABLE default"] + [str(tag) for _, tag, _ in cells] + [""])


def vtu(nodes, tets, tags, faces, face_tag):
    cells = [(5, face_tag, f) for f in faces] + [(10, t, c) for t, c in zip(tags, tets)]
    ends = list(itertools.accumulate(len(c) for _, _, c in cells))
    def array(kind, name, values, more=""):
        return f'<DataArray type="{kind}" Name="{name}" format="ascii"{more}>{" ".join(map(repr, values))}</DataArray>'
    return "".join(['<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>',
                    f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{len(cells)}"><Points>',
                    array("Float64", "Points", [x for p in nodes for x in p], ' NumberOfComponents="3"'), "</Points><Cells>",
                    array("Int64", "connectivity", [n for _, _, c in cells for n in c]), array("Int64", "offsets", ends),
                    array("UInt8", "types", [kind for kind, _, _ in cells]), "</Cells><CellData>",
                    array("Float64", "pressure", [0.5] * len(cells)), array("Int32", "MaterialIds", [tag for _, tag, _ in cells]),
                    "</CellData></Piece></UnstructuredGrid></VTKFile>"])


class Regions(harness.CliTest):
    def mesh(self, write=gmsh, file="bar.msh"):
        """A bar whose cells 2, 3 and 4 along x have the tag 3, the others 1, and the face at its end the tag 7."""
        nodes, tets, places, end = bar()
        (self.folder / file).write_text(write(nodes, tets, [3 if 2 <= p <= 4 else 1 for p in places], end, 7))
        return file

    def bar_scene(self, name, file, inside, at_end, keys=None, **body):
        """`inside`, `at_end`: selections of the tagged cells and of the end."""
        conditions = {"fixed": [{"plane": [[0.001, 0, 0], [-1, 0, 0]]}], "inclusions": [{**inside, "material": STIFF}],
                      "forces": [{**at_end, "force": [0.002, -0.004, 0]}], "pressures": [{**at_end, "pressure": 20}, {**inside, "pressure": 10}],
                      "initial": [{**inside, "velocity": [0, 0, 0.02]}]}
        return self.scene(name, body={"surface": None, "lattice": None, "mesh": file, "element": "tet4", "prescribed": [], **conditions, **body},
                          **(keys or {}))

    def hash(self, scene, steps=60):
        return self.json("run", scene, "--backend", "cpu", "--steps", steps, "--quiet")["hash"]

    INSIDE = {"box": [[0.0199, -1, -1], [0.0501, 1, 1]]}
    END = {"box": [[0.0799, -1, -1], [1, 1, 1]]}

    def test_every_entry_in_every_format(self):
        boxes = self.hash(self.bar_scene("boxes", self.mesh(), self.INSIDE, self.END))
        for write, file, inside, end in ((gmsh, "bar.msh", 3, 7), (gmsh, "bar.msh", "tumour", "end"), (vtk, "bar.vtk", 3, 7), (vtu, "bar.vtu", 3, 7)):
            self.mesh(write, file)
            self.assertEqual(self.hash(self.bar_scene("tags", file, {"region": inside}, {"region": end})), boxes, (file, inside))
        self.assertNotEqual(self.hash(self.bar_scene("other", "bar.msh", {"region": 1}, {"region": 7})), boxes)
        self.mesh(lambda *mesh: vtk(*mesh, name="part"), "part.vtk")
        data = {"data": "part"}
        self.assertEqual(self.hash(self.bar_scene("data", "part.vtk", {"region": 3, **data}, {"region": 7, **data})), boxes)
        self.refused("run", self.bar_scene("none", "part.vtk", {"region": 3}, {"region": 7}), "--backend", "cpu",
                     words=["/bodies/0/inclusions/0/region", '"part", expected one of the usual names'])

    def test_scaled_and_moved(self):
        """A region goes with the file wherever a scene puts it."""
        placed = {"scale": 2, "translate": [0.3, 0, 0], "fixed": [{"box": [[-1, -1, -1], [0.301, 1, 1]]}]}
        scaled = {key: {"box": [[2 * c + (0.3 if a == 0 else 0) for a, c in enumerate(corner)] for corner in where["box"]]}
                  for key, where in (("inside", self.INSIDE), ("at_end", self.END))}
        file = self.mesh()
        self.assertEqual(self.hash(self.bar_scene("tags", file, {"region": 3}, {"region": 7}, **placed)),
                         self.hash(self.bar_scene("boxes", file, **scaled, **placed)))

    def test_through_a_cut(self):
        """A cut makes new nodes and copies of elements; they belong to the regions of what they were."""
        blade = {"name": "b", "path": [[0, 0.035, 0.05, -0.02, 0.035, 0.05, 0.05], [0.02, 0.034, -0.02, -0.02, 0.034, -0.02, 0.05]]}
        file = self.mesh()
        runs = []
        for inside, end in (({"region": 3}, {"region": 7}), (self.INSIDE, self.END)):
            held = {"fixed": [{"plane": [[0.001, 0, 0], [-1, 0, 0]]}, {**inside, "axes": "z"}]}
            scene = self.bar_scene("cut", file, inside, end, {"blades": [blade]}, **held, initial=[])
            runs.append(self.json("run", scene, "--backend", "cpu", "--seconds", 0.04, "--quiet"))
        self.assertEqual(runs[0]["deep_hash"], runs[1]["deep_hash"])
        self.assertGreater(runs[0]["cut_edges"], 10)
        self.assertEqual(runs[0]["pieces"], 2)

    def test_static_and_probes(self):
        file = self.mesh()
        static = [json.loads(self.pliant("run", self.bar_scene("s", file, inside, end, {"solver": {"type": "static"}}, initial=[]), "--json", "-").stdout)
                  for inside, end in (({"region": 3}, {"region": 7}), (self.INSIDE, self.END))]
        self.assertEqual(static[0]["bodies"], static[1]["bodies"])
        probes = [{"name": name, **where} for name, where in (("a", {"region": "tumour"}), ("b", self.INSIDE))]
        run = self.json("run", self.bar_scene("p", file, self.INSIDE, self.END, {"probes": probes}), "--backend", "cpu", "--steps", 20)
        self.assertEqual(run["probes"][0]["position"], run["probes"][1]["position"])

    def test_a_shipped_mesh_with_tags_of_its_own(self):
        """Half of the gall bladder becomes another tissue by the second column of its tags."""
        lines = (harness.SCENES / "meshes" / "gallbladder_tet.msh").read_text().splitlines()
        first = lines.index("$Nodes") + 2
        count = int(lines[first - 1])
        place = {int(line.split()[0]): [float(x) for x in line.split()[1:]] for line in lines[first:first + count]}
        low, high = min(p[0] for p in place.values()), max(p[0] for p in place.values())
        middle, tissue = (low + high) / 2, 0
        for i in range(lines.index("$Elements") + 2, lines.index("$EndElements")):
            words = lines[i].split()
            if words[1] == "4" and sum(place[int(n)][0] for n in words[-4:]) / 4 > middle:
                words[3], tissue = "5", tissue + 1
                lines[i] = " ".join(words)
        (self.folder / "organ.msh").write_text("\n".join(lines) + "\n")
        def scene(where):
            return self.scene(body={"surface": None, "lattice": None, "mesh": "organ.msh", "element": "tet4", "prescribed": [],
                                    "fixed": [{"box": [[-9, -9, -9], [low + 0.1 * (high - low), 9, 9]]}],
                                    "inclusions": [{**where, "material": STIFF}]})
        self.assertGreater(tissue, 1000)
        info = self.json("info", scene({"region": 5}))
        tags = [a for a in info["bodies"][0]["regions"] if a["usual"]][0]
        self.assertEqual(tags["data"], "gmsh:physical")
        self.assertIn({"region": 5, "dimension": 3, "cells": tissue}, tags["regions"])
        self.assertEqual(self.hash(scene({"region": 5}), 20), self.hash(scene({"box": [[middle, -9, -9], [9, 9, 9]]}), 20))

    def test_info_lists_them(self):
        scene = self.bar_scene("scene", self.mesh(), {"region": 3}, {"region": "end"},
                               {"probes": [{"name": "in", "region": "tumour", "quantities": ["force", "energy"]}, {"name": "at", "point": [0.001, 0.002, 0.003]}]})
        info = self.json("info", scene)
        physical = info["bodies"][0]["regions"][0]
        self.assertEqual(physical, {"data": "gmsh:physical", "usual": True, "numbers": 3, "regions": [
            {"region": 1, "dimension": 3, "cells": 270}, {"region": 3, "dimension": 3, "cells": 162, "name": "tumour"},
            {"region": 7, "dimension": 2, "cells": 18, "name": "end"}]})
        self.assertEqual(info["probes"], [{"name": "in", "body": "cube", "quantities": ["force", "energy"], "nodes": 64},
                                          {"name": "at", "body": "cube", "quantities": ["position", "displacement", "velocity"], "point": [0.001, 0.002, 0.003]}])
        text = self.pliant("info", scene).stdout
        self.assertIn('regions of "gmsh:physical": 1 (270 elements), 3 "tumour" (162 elements), 7 "end" (18 faces)', text)
        self.assertIn('regions of "gmsh:geometrical" (with "data"): 1 (432 elements), 1 (18 faces)', text)
        self.assertIn("probe in: force, energy of 64 nodes of body cube", text)
        lattice = self.json("info", self.scene())
        self.assertNotIn("regions", lattice["bodies"][0])
        self.assertEqual(lattice["probes"], [])

    def test_refused(self):
        file = self.mesh()
        there = 'expected one of 1 (270 elements), 3 "tumour" (162 elements), 7 "end" (18 faces)'
        for where, words in (({"region": 4}, ["/bodies/0/inclusions/0/region: got 4: no such region of elements in", there]),
                             ({"region": "liver"}, ['got "liver"', there]), ({"region": 7}, ["got 7", there]),
                             ({"region": 1.5}, ["got 1.5, expected a tag of the mesh file"]), ({"region": ""}, ['/region: got ""']),
                             ({"region": 3, "data": "x"}, ['expected an array "x"']), ({"region": 3, "dimension": 1}, ["/dimension: got 1"]),
                             ({"all": True, "data": "x"}, ['/data: got "x", expected no "data" with "all"']),
                             ({"region": 3, "all": True}, ["got region, all, expected exactly one of box"])):
            self.refused("run", self.bar_scene("scene", file, where, self.END, initial=[], pressures=[]), "--backend", "cpu",
                         words=["scene.json: ", *words])
        for key, entry in (("initial", {"velocity": [0, 0, 1]}), ("forces", {"force": [0, 0, 1]}), ("pressures", {"pressure": 1}), ("fixed", {})):
            scene = self.bar_scene("scene", file, {"region": 3}, self.END, **{"initial": [], "pressures": [], "forces": [], key: [{"region": 4, **entry}]})
            self.refused("run", scene, "--backend", "cpu", words=[f"scene.json: /bodies/0/{key}/0/region: got 4", there])
        probe = {"name": "p", "region": 4}
        self.refused("run", self.bar_scene("scene", file, {"region": 3}, self.END, {"probes": [probe]}), "--backend", "cpu",
                     words=["/probes/0/region: got 4", there])
        self.refused("info", self.scene(body={"fixed": [{"region": 1}]}),
                     words=["/bodies/0/fixed/0/region: got 1, expected no region in a body that is a surface", 'closed "surface"'])


if __name__ == "__main__":
    harness.main()
