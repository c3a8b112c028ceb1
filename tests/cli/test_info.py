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

    def test_shipped_scene(self):
        self.assertGreater(self.json("info", harness.SCENES / "beam_tet.json")["elements"], 100)


if __name__ == "__main__":
    harness.main()
