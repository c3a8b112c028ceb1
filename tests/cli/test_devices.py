"""pliant devices."""
import harness


class Devices(harness.CliTest):
    def test_every_backend_has_a_verdict(self):
        backends = {b["name"]: b for b in self.json("devices")["backends"]}
        self.assertTrue(backends["cpu"]["bit_exact"])
        self.assertFalse(backends["cpu:double"]["bit_exact"])
        for backend in backends.values():
            self.assertEqual(backend["bit_exact"], backend["tolerance_reason"] == "", backend)
        text = self.pliant("devices").stdout
        self.assertIn("bit-exact", text)
        self.assertIn("tolerance (", text)
        self.assertEqual(self.pliant("devices", "--quiet").stdout, "")


if __name__ == "__main__":
    harness.main()
