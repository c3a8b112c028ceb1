"""What a scene can choose and give, through the command: inside of surfaces, rotations, motion at the start, contradictions."""
import harness

CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


class Selections(harness.CliTest):
    def surface(self, name, lower, upper, faces=FACES, scale=1):
        lines = ["v " + " ".join(str((low + (high - low) * c) / scale) for low, high, c in zip(lower, upper, corner)) for corner in CUBE]
        lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
        (self.folder / name).write_text("\n".join(lines) + "\n")
        return name

    def hash(self, scene, *arguments):
        return self.json("run", scene, "--backend", "cpu", "--steps", 50, *arguments)["hash"]

    def test_inside_of_a_surface_is_the_box(self):
        """For nodes, elements and triangles, in lattices and their tetrahedra; the surface shares the body's scale and translate."""
        stiff = {"young": 9000, "poisson": 0.3}
        low, part = [[-1, -1, -1], [1, -0.049, 1]], [[-0.021, -0.051, -0.051], [0.051, 0.021, 0.051]]
        self.surface("low.obj", *low)
        self.surface("part.obj", *part)
        self.surface("less.obj", [-0.001, -0.051, -0.051], part[1])
        for element in ("hex8", "tet4"):
            def scene(name, bottom, inside):
                return self.scene(name, body={"element": element, "fixed": [bottom], "inclusions": [{**inside, "material": stiff}],
                                              "forces": [{**inside, "force": [0, 0, 0.01]}], "pressures": [{**inside, "pressure": 10}],
                                              "initial": [{**inside, "velocity": [0.01, 0, 0]}]})
            boxes = self.hash(scene("boxes", {"box": low}, {"box": part}))
            self.assertEqual(self.hash(scene("surfaces", {"surface": "low.obj"}, {"surface": "part.obj"})), boxes)
            self.assertNotEqual(self.hash(scene("other", {"surface": "low.obj"}, {"surface": "less.obj"})), boxes)
        body = {"scale": 0.5, "translate": [0.01, 0.01, 0.01], "lattice": {"spacing": 0.01}, "prescribed": []}
        half = [[0.5 * c + 0.01 for c in corner] for corner in part]
        self.surface("full.obj", *part)
        self.assertEqual(self.hash(self.scene(body={**body, "fixed": [{"surface": "full.obj"}]})),
                         self.hash(self.scene(body={**body, "fixed": [{"box": half}]})))

    def test_refused_surfaces(self):
        for file, words in ((self.surface("open.obj", [-1, -1, -1], [1, 0, 1], FACES[1:]), ["/bodies/0/fixed/0/surface", "4 open edges"]),
                            (self.surface("away.obj", [1, 1, 1], [2, 2, 2]), ["/bodies/0/fixed/0", "no node in this set"]),
                            ("none.obj", ["none.obj"])):
            self.refused("run", self.scene(body={"fixed": [{"surface": file}]}), "--backend", "cpu", words=words)

    def test_an_empty_set_tells_where_the_body_is(self):
        """The cube reaches from -0.05 to 0.05; what each entry is compared with lies on its faces, or in the middles of its parts."""
        corners = "between [-0.05, -0.05, -0.05] and [0.05, 0.05, 0.05] m"
        self.surface("away.obj", [0.06, -0.01, -0.01], [0.08, 0.01, 0.01])
        box, sphere = {"box": [[0.08, -1, -1], [1, 1, 1]]}, {"sphere": [[0.25, 0.05, 0.05], 0.1]}
        plane, surface = {"plane": [[0, 0.07, 0], [0, 2, 0]]}, {"surface": "away.obj"}
        for where, away in ((box, "0.03 m away"), (sphere, "the nearest node is at [0.05, 0.05, 0.05] m, 0.1 m away"),
                            (plane, "0.02 m away"), (surface, "0.01 m away")):
            for entry in ("fixed", "forces"):
                scene = self.scene(body={entry: [{**where, **({"force": [0, 0, 1]} if entry == "forces" else {})}]})
                self.refused("run", scene, "--backend", "cpu", words=[f"/bodies/0/{entry}/0: no node in this set", corners, away])
            scene = self.scene(probes=[{"name": "p", **where}])
            self.refused("run", scene, "--backend", "cpu", words=["/probes/0: no node in this set", corners, away])
            # Not their centres: the surface begins a hundredth from the face, the centres of triangles lie in it.
            scene = self.scene(body={"pressures": [{**where, "pressure": 10}]})
            self.refused("run", scene, "--backend", "cpu", words=["no surface triangle has its centre in this set", corners, "the nearest centre is at"])
        stiff = {"material": {"young": 9000, "poisson": 0.3}}
        for keys in ({"inclusions": [{**box, **stiff}]}, {"model": {"type": "hybrid", "width": 1, "region": box}}):
            self.refused("run", self.scene(body=keys), "--backend", "cpu", words=["-0.05", "0.05", "the nearest centre is at [0.04, ", "0.04 m away"])
        self.refused("run", self.scene(body={"fixed": [{"nodes": [999]}]}), "--backend", "cpu", words=["node 999 does not exist", corners])
        self.refused("run", self.scene(), "--probe", "tip=0.08,0,0", "--backend", "cpu",
                     words=["the nearest, 'cube', is 0.03 m away and lies " + corners])

    def test_contradictions_are_refused(self):
        top = {"plane": [[0, 0.049, 0], [0, 1, 0]]}
        for more, words in (({"displacement": [None, 0.01, None]}, ["moves it by -0.01 m", "moves it by 0.01 m", "the y component"]),
                            ({"rotate": {"axis": [0, 1, 0], "angle": 10}}, ["/bodies/0/prescribed/0 holds it", "/bodies/0/prescribed/1 rotates it"])):
            down = {**top, "displacement": [0, -0.01, 0], "curve": "smooth", "duration": 0.2}
            self.refused("run", self.scene(body={"prescribed": [down, {**top, **more}]}), "--backend", "cpu",
                         words=["scene.json: /bodies/0/prescribed/1: got the", "body 'cube'", *words])
        self.refused("run", self.scene(body={"fixed": [{"all": True, "axes": "y"}]}), "--backend", "cpu",
                     words=["/bodies/0/fixed/0 holds it", "/bodies/0/prescribed/0 moves it by -0.01 m"])

    def test_a_static_solution_refuses_half_a_turn(self):
        def scene(angle):
            turn = {"plane": [[0, 0.049, 0], [0, 1, 0]], "rotate": {"axis": [0, 1, 0], "angle": angle}}
            return self.scene(body={"prescribed": [turn], "element": "tet4"}, solver={"type": "static"}, gravity=[0, 0, 0])
        self.refused("run", scene(180), words=["body 'cube'", "180 degrees", "relaxation"])
        self.pliant("run", scene(20), "--quiet")
        self.refused("run", self.scene(body={"initial": [{"all": True, "velocity": [0, 0, 1]}]}, solver={"type": "static"}),
                     words=["/bodies/0/initial", "static"])

    def test_backends_agree(self):
        """Gravity with a curve, fields, rotation: the same bits after every pass on the processor and on a device."""
        backend = self.opencl()
        if backend["bit_exact"]:
            done = self.json("compare", harness.SCENES / "wring.json", "--backends", "cpu,opencl:0", "--steps", 40, "--every", "pass")
            self.assertTrue(done["identical"])
        self.json("run", harness.SCENES / "wring.json", "--backend", "cpu:check", "--steps", 20)


if __name__ == "__main__":
    harness.main()
