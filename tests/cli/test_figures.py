"""Figures that users once found wrong, in small scenes of our own with the right ones: closed forms, or another method."""
import itertools
import math

import harness

GRAVITY = 9.81


def box(cells, size):
    """Nodes [m] and cells (corners in VTK's order) of a box."""
    def node(x, y, z):
        return (x * (cells[1] + 1) + y) * (cells[2] + 1) + z
    nodes = [tuple(s * i / n for s, i, n in zip(size, at, cells)) for at in itertools.product(*(range(n + 1) for n in cells))]
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    return nodes, [[node(x + a, y + b, z + c) for c in (0, 1) for a, b in ring] for x, y, z in itertools.product(*(range(n) for n in cells))]


def six_tets(cell):
    """Along the six ways over the edges of a cell from one corner to the opposite one."""
    corner = {(0, 0, 0): 0, (1, 0, 0): 1, (1, 1, 0): 2, (0, 1, 0): 3, (0, 0, 1): 4, (1, 0, 1): 5, (1, 1, 1): 6, (0, 1, 1): 7}
    for order in itertools.permutations(range(3)):
        at, tet = [0, 0, 0], [cell[0]]
        for axis in order:
            at[axis] = 1
            tet.append(cell[corner[tuple(at)]])
        if order in ((0, 2, 1), (1, 0, 2), (2, 1, 0)):
            tet[2], tet[3] = tet[3], tet[2]
        yield tet


def beam_tip(young, length, width, density, steps=2000):
    """How far the tip of a cantilever sinks under its weight [m]: Reissner's beam (1972), finite rotation with stretch and shear,
    nu = 0, by shooting with the curvature at the clamp and the midpoint rule."""
    bend, axial, shear = young * width ** 4 / 12, young * width ** 2, young / 2 * width ** 2 * 5 / 6
    weight, ds = density * GRAVITY * width ** 2, length / steps

    def shoot(curvature):
        angle, down = 0.0, 0.0
        for i in range(steps):
            half = angle + ds / 2 * curvature
            force = weight * (length - (i + 0.5) * ds)
            normal, across = force * math.sin(half), force * math.cos(half)
            down += ds * ((1 + normal / axial) * math.sin(half) + across / shear * math.cos(half))
            middle = curvature - ds / 2 * weight * (length - i * ds) * math.cos(angle) / bend
            curvature -= ds * across / bend
            angle += ds * middle
        return curvature, down
    low, high = 0.0, 4 / length
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if shoot(middle)[0] > 0 else (middle, high)
    return shoot(low)[1]


class Figures(harness.CliTest):
    def mesh(self, name, nodes, cells):
        kind = {4: 10, 8: 12}[len(cells[0])]
        lines = ["# vtk DataFile Version 3.0", name, "ASCII", "DATASET UNSTRUCTURED_GRID", f"POINTS {len(nodes)} double"]
        lines += [" ".join(map(repr, x)) for x in nodes] + [f"CELLS {len(cells)} {sum(len(c) + 1 for c in cells)}"]
        lines += [f"{len(c)} " + " ".join(map(str, c)) for c in cells] + [f"CELL_TYPES {len(cells)}"] + [str(kind)] * len(cells)
        (self.folder / name).write_text("\n".join(lines) + "\n")
        return {"surface": None, "lattice": None, "prescribed": [], "mesh": name}

    def test_a_beam_of_slender_cells_bends_as_a_beam(self):
        """By half of its length, with cells four times, twice and once as long as wide; and dynamic relaxation in float gets there."""
        young, length, width = 1.6e6, 0.24, 0.012
        exact = beam_tip(young, length, width, 1000)
        self.assertGreater(exact, 0.4 * length)
        tip = {"name": "tip", "point": [length, width / 2, width / 2]}
        for cells, bound in ((10, 0.012), (20, 0.003), (40, 0.002)):
            body = self.mesh("beam.vtk", *box((cells, 2, 2), (length, width, width)))
            body.update(element="hex8", material={"young": young, "poisson": 0, "density": 1000}, fixed=[{"box": [[0, -1, -1], [0, 1, 1]]}])
            run = self.json("run", self.scene(body=body, relaxation={"tolerance": 1e-5, "max_steps": 60000}, probes=[tip]), "--backend", "cpu")
            self.assertTrue(run["converged"], cells)
            self.assertAlmostEqual(-run["probes"][0]["displacement"][1] / exact, 1, delta=bound, msg=str(cells))

    def test_reactions_of_every_order_are_the_stress_on_the_face(self):
        """A bar with free sides is pulled: P A of the closed form for linear and quadratic tetrahedra, full cells, and dynamic ones."""
        young, poisson, stretch = 10000, 0.3, 1.1
        mu, lame = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        def side_stress(s):
            return mu * (s - 1 / s) + lame * (stretch * s * s - 1) * stretch * s
        low, high = 0.8, 1.0
        for _ in range(80):
            middle = (low + high) / 2
            low, high = (middle, high) if side_stress(middle) < 0 else (low, middle)
        exact = 0.01 * (mu * (stretch - 1 / stretch) + lame * (stretch * low * low - 1) * low * low)
        nodes, cells = box((4, 2, 2), (0.2, 0.1, 0.1))
        tets = [tet for cell in cells for tet in six_tets(cell)]
        pulled = {"box": [[0.2, -1, -1], [0.2, 1, 1]]}
        for element, of, solver in (("tet4", tets, {"order": 1}), ("tet4", tets, {"order": 2}), ("hex8full", cells, {"order": 1}),
                                    ("tet4", tets, None), ("hex8", cells, None)):
            body = self.mesh("bar.vtk", nodes, of)
            rollers = [{"box": [[0 if a == axis else -1 for a in range(3)], [0 if a == axis else 1 for a in range(3)]], "axes": "xyz"[axis]}
                       for axis in range(3)]
            body.update(element=element, material={"young": young, "poisson": poisson}, fixed=rollers,
                        prescribed=[{**pulled, "displacement": [0.2 * (stretch - 1), None, None], "curve": "smooth", "duration": 0.05}])
            if solver is None:
                probe = {"name": "pulled", **pulled, "quantities": ["reaction"]}
                run = self.json("run", self.scene(body=body, gravity=[0, 0, 0], relaxation={"tolerance": 1e-8}, probes=[probe]), "--backend", "cpu:double")
                force = run["probes"][0]["reaction"][0]
            else:
                done = self.pliant("run", self.scene(body=body, gravity=[0, 0, 0], solver={"type": "static", **solver}), "--json", "-")
                force = harness.json.loads(done.stdout)["bodies"][0]["reactions"][-1]["force"][0]
            self.assertAlmostEqual(force / exact, 1, delta=1e-6, msg=f"{element} {solver}")

    def test_a_soft_cantilever_hangs_as_far_with_every_element(self):
        """Straight down: its tip moves by one and a half times its length; at the clamp it is pressed to half of its length."""
        found = {}
        for element, across in (("hex8", 5), ("hex8", 7), ("hex8full", 7)):
            body = self.mesh("beam.vtk", *box((5 * across, across, across), (0.1, 0.02, 0.02)))
            body.update(element=element, material={"young": 3000, "poisson": 0.45, "density": 1000, "damping": 10},
                        fixed=[{"box": [[0, -1, -1], [0, 1, 1]]}])
            run = self.json("run", self.scene(body=body, gravity=[0, 0, -9.81]), "--backend", "cpu", "--seconds", 1)
            found[element, across] = run["max_displacement"]
        for case, value in found.items():
            self.assertAlmostEqual(value / 0.153, 1, delta=0.015, msg=f"{case} of {found}")

    def test_a_hybrid_stands_under_its_own_weight(self):
        """As stiff as its material, it sags like finite elements as long as it is not too soft for its weight; and says where it is."""
        def sag(gravity, model, *more):
            body = {"material": {"young": 3000, "poisson": 0.45, "density": 1000, "damping": 8}, "prescribed": [], "lattice": {"spacing": 0.0125},
                    "model": model}
            done = self.pliant("run", self.scene(body=body, gravity=[0, -gravity, 0]), "--backend", "cpu", "--seconds", 2, "--json", "-", *more)
            return harness.json.loads(done.stdout)["max_displacement"], done.stderr
        model = {"type": "hybrid", "ratio": 0.4}
        reference = sag(2, None)[0]
        for more in ({}, {"substeps": 4, "goals": "extrapolated"}):
            found, said = sag(2, {**model, **more})
            self.assertAlmostEqual(found / reference, 1, delta=0.15, msg=str(more))
            self.assertNotIn("its weight strains", said)
        heavy, said = sag(9.81, {**model, "substeps": 4, "goals": "extrapolated"})
        self.assertIn("its weight strains", said)
        short = sag(9.81, {**model, "substeps": 4, "goals": "extrapolated"}, "--dt", 4e-4)[0]
        self.assertAlmostEqual(short / heavy, 1, delta=0.005, msg="a shorter step makes it softer or stiffer")


if __name__ == "__main__":
    harness.main()
