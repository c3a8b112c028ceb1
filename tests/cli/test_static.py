"""pliant run of scenes with a static solver."""
import json

import harness


class Static(harness.CliTest):
    def solve(self, scene, *arguments, expect=0):
        done = self.pliant("run", scene, "--json", "-", *arguments, expect=expect)
        value = json.loads(done.stdout)
        schema = json.loads((harness.SOURCE / "docs" / "schema" / "run_static.json").read_text())
        self.assertEqual(harness.schema_errors(value, schema), [])
        return value

    def test_finds_the_state_in_which_relaxation_ends(self):
        static = self.scene("static", {"element": "hex8full"}, solver={"type": "static", "tolerance": 1e-10})
        dynamic = self.scene("dynamic", {"element": "hex8full"}, relaxation={"tolerance": 1e-7})
        solved = self.solve(static, "--out", "out", "--format", "vtu,obj")
        self.assertEqual(self.names("out"), ["static.vtu", "static_surface.obj", "static_surface.vtu"])
        self.assertEqual(solved["bodies"][0]["element"], "hex8full")
        self.assertLessEqual(solved["bodies"][0]["residual"], 1e-10)
        self.pliant("run", dynamic, "--backend", "cpu:double", "--out", "rest", "--format", "obj")
        last = [name for name in self.names("rest") if name.endswith(".obj")][-1]

        def vertices(file):
            lines = (line.split() for line in (self.folder / file).read_text().splitlines())
            return [[float(x) for x in line[1:4]] for line in lines if line and line[0] == "v"]

        ours, theirs = vertices("out/static_surface.obj"), vertices(f"rest/{last}")
        self.assertEqual(len(ours), len(theirs))
        self.assertLess(max(abs(a - b) for p, q in zip(ours, theirs) for a, b in zip(p, q)), 1e-7)

    def test_hex8_is_solved_as_hex8full_and_order_2_gives_tet10(self):
        keys = {"solver": {"type": "static"}}
        full = self.solve(self.scene("a", {"element": "hex8full"}, **keys))
        self.assertEqual(self.solve(self.scene("b", {"element": "hex8"}, **keys))["hash"], full["hash"])
        quadratic = self.solve(self.scene("c", {"element": "tet4anp"}, solver={"type": "static", "order": 2}))
        self.assertEqual(quadratic["bodies"][0]["element"], "tet10")
        self.assertAlmostEqual(quadratic["strain_energy"] / full["strain_energy"], 1, delta=0.05)

    def pressed(self, element, order):
        """A cube of 0.1 m on three rollers under 1 kPa, as six tetrahedra or one hexahedron."""
        corners = [[0.1 * (n & 1), 0.1 * (n >> 1 & 1), 0.1 * (n >> 2 & 1)] for n in range(8)]
        paths = [(1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1)]
        tets = element == "tet4"
        cells = [[0, a, b, 7] for a, b in paths] if tets else [[0, 1, 3, 2, 4, 5, 7, 6]]
        lines = ["# vtk DataFile Version 3.0", "cube", "ASCII", "DATASET UNSTRUCTURED_GRID", "POINTS 8 double"]
        lines += [" ".join(map(repr, x)) for x in corners]
        lines += [f"CELLS {len(cells)} {sum(len(c) + 1 for c in cells)}"]
        lines += [" ".join(map(str, [len(c), *c])) for c in cells]
        lines += [f"CELL_TYPES {len(cells)}"] + ["10" if tets else "12"] * len(cells)
        (self.folder / f"{element}.vtk").write_text("\n".join(lines) + "\n")
        rollers = [{"box": [[-1, -1, -1], [0 if c == axis else 1 for c in range(3)]], "axes": "xyz"[axis]} for axis in range(3)]
        body = {"name": "b", "mesh": f"{element}.vtk", "element": element, "material": {"young": 10000, "poisson": 0.3},
                "fixed": rollers, "pressures": [{"box": [[-1, -1, 0.0999], [1, 1, 1]], "pressure": 1000}]}
        file = self.folder / "pressed.json"
        file.write_text(json.dumps({"format": "pliant-scene/1", "bodies": [body],
                                    "solver": {"type": "static", "linear": True, **({"order": 2} if order == 2 else {})}}))
        return file

    def test_pressure_is_uniform_and_its_reactions_balance_it(self):
        for element, order, nodes in [("tet4", 1, 8), ("tet4", 2, 27), ("hex8full", 1, 8)]:
            solved = self.solve(self.pressed(element, order), "--out", "out")["bodies"][0]
            self.assertAlmostEqual(solved["largest_displacement"], 0.01 * (1 + 2 * 0.3**2)**0.5, delta=1e-11)
            self.assertEqual([r["at"] for r in solved["reactions"]], [f"/bodies/0/fixed/{c}" for c in range(3)])
            for axis, load in enumerate([0, 0, -10]):
                self.assertAlmostEqual(solved["applied"][axis], load, delta=1e-9)
                self.assertAlmostEqual(sum(r["force"][axis] for r in solved["reactions"]), -load, delta=1e-9)
            # The file has every node, so that what it holds adds up, too.
            self.assertIn(f'NumberOfPoints="{nodes}"'.encode(), (self.folder / "out" / "pressed.vtu").read_bytes())

    def test_linear_is_one_iteration(self):
        solved = self.solve(self.scene(solver={"type": "static", "linear": True}))
        self.assertEqual(solved["iterations"], 1)
        self.assertTrue(solved["linear"])
        steps = self.solve(self.scene(solver={"type": "static", "load_steps": 3}))
        self.assertEqual(steps["bodies"][0]["load_steps"], 3)

    def test_what_has_no_meaning_at_rest_is_refused(self):
        keys = {"solver": {"type": "static"}}
        self.refused("run", self.scene(**keys), "--steps", "3", words=["--steps", "static"])
        self.refused("run", self.scene(**keys), "--backend", "cpu", words=["--backend", "static"])
        self.refused("run", self.scene(relaxation=True, **keys), words=["/relaxation"])
        self.refused("run", self.scene(focus={"path": [[0, 0, 0, 0]]}, **keys), words=["/focus"])
        self.refused("run", self.scene(body={"model": {"type": "flsm"}}, **keys), words=["/bodies/0/model/type", "flsm"])
        self.refused("run", self.scene(body={"element": "tet4anp"}, **keys), words=["/bodies/0/element", "tet4anp", "order"])
        self.refused("run", self.scene(body={"fixed": [], "prescribed": []}, **keys), words=["rigid body"])
        self.refused("run", self.scene(solver={"type": "statik"}), words=["/solver/type", "static"])
        self.refused("run", self.scene(solver={"type": "dynamic", "linear": True}), words=["/solver/linear"])
        self.refused("run", self.scene(solver={"type": "static", "load_steps": 0}), words=["/solver/load_steps"])

    def test_no_convergence_is_exit_code_4(self):
        crushed = {"material": {"law": "saint-venant-kirchhoff", "young": 3000, "poisson": 0.4}, "prescribed": [],
                   "forces": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "force": [0, -100, 0]}]}
        done = self.pliant("run", self.scene(body=crushed, solver={"type": "static"}), "--json", "r.json", expect=4)
        self.assertIn("did not converge", done.stderr)
        self.assertFalse(json.loads((self.folder / "r.json").read_text())["converged"])


if __name__ == "__main__":
    harness.main()
