"""pliant info: the figures of a cube that can be counted by hand."""
import harness


class Info(harness.CliTest):
    def test_cube(self):
        info = self.json("info", self.scene(), "--buffers")
        self.assertEqual((info["nodes"], info["elements"]), (216, 125))
        body = info["bodies"][0]
        self.assertAlmostEqual(body["volume"], 1e-3, delta=2e-5)
        self.assertAlmostEqual(body["surface_volume"], 1e-3, delta=1e-9)
        self.assertAlmostEqual(info["mass"], 1.0, delta=0.02)
        step = info["stable_step"]
        self.assertGreater(step["element_bound"], 0)
        self.assertGreaterEqual(step["iteration"], 0.98 * step["element_bound"])
        self.assertAlmostEqual(step["dt"], 0.9 * step["iteration"])
        self.assertTrue(step["automatic"])

    def test_memory_is_the_sum_of_the_buffers(self):
        info = self.json("info", self.scene(), "--buffers")
        memory = info["memory"]
        total = sum(b["bytes"] for b in info["buffers"])
        self.assertEqual(memory["total"]["bytes"], total)
        self.assertEqual(sum(memory[role]["bytes"] for role in ("constant", "state", "scratch", "control")), total)
        self.assertAlmostEqual(memory["total"]["bytes_per_node"], total / 216)
        self.assertAlmostEqual(memory["total"]["bytes_per_element"], total / 125)
        for buffer in info["buffers"]:
            size = {"real": 4, "real4": 16, "int32": 4}[buffer["type"]]
            self.assertEqual(buffer["bytes"], size * buffer["count"], buffer)

    def test_passes_are_listed_in_order(self):
        kernels = [p["kernel"] for p in self.json("info", self.scene())["passes"]]
        self.assertEqual(kernels, ["tled_hex8_brick_force", "brick_update", "node_prescribe"])
        text = self.pliant("info", self.scene(), "--buffers").stdout
        places = [text.index(kernel) for kernel in kernels]
        self.assertEqual(places, sorted(places))
        self.assertIn("node_u", text)

    def test_figures_in_other_units_are_told(self):
        def warnings(material=None, gravity=0.0, **body):
            material = {"young": 3000, "poisson": 0.4, "density": 1000, **(material or {})}
            return self.json("info", self.scene(body={"material": material, **body}, gravity=[0, gravity, 0]))["warnings"]

        self.assertEqual(warnings(gravity=-9.81), [])
        for given, words in (({"material": {"young": 5}}, ["modulus is 5 Pa", "5 kPa are 5000"]),
                             ({"material": {"density": 1}}, ["density is 1 kg/m^3", "1 g/cm^3 is 1000"]),
                             ({"scale": 1000, "lattice": {"spacing": 20}}, ["100 x 100 x 100 m large", "millimetres"]),
                             ({"gravity": -9810}, ["weight of a column", "327 times its Young's modulus"]),
                             ({"prescribed": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, -20, 0]}]},
                              ["entry 0 of \"prescribed\"", "20 m, 200 times the body's size of 0.1 m"])):
            said = warnings(**given)
            self.assertEqual(len(said), 1, said)
            for word in words:
                self.assertIn(word, said[0])

    def test_where_a_body_is(self):
        self.assertEqual(self.json("info", self.scene())["bodies"][0]["size"], [0.1, 0.1, 0.1])
        moved = self.scene(body={"translate": [1, 2, 3], "prescribed": [], "fixed": [{"all": True}]})
        box = self.json("info", moved)["bodies"][0]["box"]
        for corner, expected in zip(box, ([0.95, 1.95, 2.95], [1.05, 2.05, 3.05])):
            for value, wanted in zip(corner, expected):
                self.assertAlmostEqual(value, wanted)
        self.assertIn("0.1 x 0.1 x 0.1 m large, between [0.95, 1.95, 2.95] and [1.05, 2.05, 3.05] m\n", self.pliant("info", moved).stdout)

    def test_partition_of_a_hybrid(self):
        # The lower two of five layers of cells are operational: 2 layers of 36 nodes, 1 of interface, 3 of shape matching.
        model = {"type": "hybrid", "width": 1, "region": {"box": [[-1, -1, -1], [1, -0.01, 1]]}}
        scene = self.scene(body={"model": model})
        self.assertEqual(self.json("info", scene)["bodies"][0]["shape_matching"],
                         {"operational_nodes": 72, "interface_nodes": 36, "matching_nodes": 108, "regions": 144,
                          "substeps": 1, "ratio": 0.5})
        self.assertIn("72 operational, 36 interface and 108 matching nodes (ratio 0.5), 144 regions", self.pliant("info", scene).stdout)
        pure = self.json("info", self.scene(body={"model": {"type": "flsm"}}))["bodies"][0]["shape_matching"]
        self.assertEqual((pure["matching_nodes"], pure["regions"], pure["ratio"]), (216, 216, 0))
        self.assertNotIn("shape_matching", self.json("info", self.scene())["bodies"][0])

    def test_what_the_automatic_step_follows(self):
        blade = {"name": "b", "path": [[0, 0.013, 0.08, -0.1, 0.013, 0.08, 0.1], [1, 0.013, -0.08, -0.1, 0.013, -0.08, 0.1]]}
        flsm = {"type": "flsm", "stiffness": {"young": 3000}}
        for keys, text in ((dict(), "automatic: 0.9 of it, "), (dict(blades=[blade]), "of the element bound, limited by cuts"),
                           (dict(body={"model": flsm}), "limited by shape matching"), (dict(body={"model": {"type": "flsm"}}), "one frame")):
            said = self.pliant("info", self.scene(**keys)).stdout
            for other in ("automatic: 0.9 of it, ", "limited by cuts", "limited by shape matching", "one frame"):
                self.assertEqual(other in said, other in text, said)
            self.assertEqual("stable step: no finite element limits it" in said, "body" in keys, said)

    def cube(self, low, high, first=1):
        """The lines of an OBJ file: a box of twelve triangles."""
        lines = [f"v {high[0] if c & 1 else low[0]} {high[1] if c & 2 else low[1]} {high[2] if c & 4 else low[2]}" for c in range(8)]
        faces = ["023", "031", "457", "476", "015", "054", "267", "273", "046", "062", "137", "175"]
        return lines + ["f " + " ".join(str(first + int(c)) for c in face) for face in faces]

    def surface(self, lines, **lattice):
        (self.folder / "surface.obj").write_text("\n".join(lines) + "\n")
        return self.scene(body={"surface": "surface.obj", "lattice": lattice or {"spacing": 0.01}, "prescribed": [],
                                "fixed": [{"box": [[-1, -1, -1], [1, -0.04, 1]]}]})

    def test_a_sound_surface_has_no_warnings(self):
        self.assertEqual(self.json("info", self.scene())["warnings"], [])
        self.assertEqual(self.json("run", self.scene(), "--backend", "cpu", "--steps", "2")["warnings"], [])

    def test_a_bad_surface_is_told_and_run(self):
        lines = self.cube((-0.05, -0.05, -0.05), (0.05, 0.05, 0.05))
        lines += self.cube((0.003, -0.041, -0.042), (0.103, 0.059, 0.058), 9) + ["f 1 1 2", "f 1 3 4"]
        scene = self.surface(lines)
        info = self.json("info", scene)
        united = 2 - (0.047 * 0.091 * 0.092) / 1e-3
        self.assertAlmostEqual(info["mass"], united, delta=0.01 * united)
        surface = info["bodies"][0]["surface"]
        self.assertEqual((surface["degenerate_triangles"], surface["dropped_copies"], surface["holes"]), (1, 1, 0))
        self.assertGreater(surface["crossing_pairs"], 0)
        self.assertEqual(surface["searched"], 1)
        text = "\n".join(info["warnings"])
        for words in ("without area, dropped: 1, the first at (-0.05, -0.05, -0.05) m", "pass through each other", "the elements fill 0.00"):
            self.assertIn(words, text)
        done = self.pliant("run", scene, "--backend", "cpu", "--steps", "2")
        self.assertEqual([w for w in info["warnings"] if f"pliant: {w}\n" not in done.stderr], [])
        self.assertEqual(self.pliant("run", scene, "--backend", "cpu", "--steps", "2", "--quiet").stderr, "")
        self.assertEqual(self.json("run", scene, "--backend", "cpu", "--steps", "2")["warnings"], info["warnings"])

    def test_no_inside_is_refused(self):
        lines = self.cube((-0.05, -0.05, -0.05), (0.05, 0.05, 0.05))
        scene = self.surface(lines[:13])  # five triangles
        for command in (["info"], ["run", "--backend", "cpu", "--out", "frames"]):
            self.refused(command[0], scene, *command[1:], words=("surface.obj", "has no inside to fill", "mesh editor"))
        self.assertEqual([n for n in self.names() if n == "frames" and self.names("frames")], [])

    def test_wanted_nodes_and_far_too_fine_a_spacing(self):
        lines = self.cube((-0.05, -0.05, -0.05), (0.05, 0.05, 0.05))
        info = self.json("info", self.surface(lines, nodes=9))
        self.assertEqual(info["nodes"], 8)
        self.assertIn("requests 9 nodes; the nearest lattice found has 8 (-11.1 %)", info["warnings"][0])
        self.refused("info", self.surface(lines, spacing=2e-4), words=("at least 12500000", "at most 100000000 are allowed"))

    def test_shipped_scene(self):
        self.assertGreater(self.json("info", harness.SCENES / "beam_tet.json")["elements"], 100)


if __name__ == "__main__":
    harness.main()
