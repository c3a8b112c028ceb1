"""pliant compare: shipped scenes give the same bits, and what cannot be compared is refused."""
import harness


class Compare(harness.CliTest):
    def test_shipped_scenes(self):
        if not self.opencl()["bit_exact"]:
            self.skipTest("opencl:0 is in tolerance mode")
        for name in ("bunny", "liver", "beam", "beam_tet", "beam_anp", "inclusion", "two_bodies"):
            with self.subTest(scene=name):
                result = self.json("compare", harness.SCENES / f"{name}.json", "--steps", 20, "--backends", "opencl:0,cpu")
                self.assertTrue(result["identical"], result["first_difference"])
                self.assertIsNone(result["first_difference"])
                self.assertEqual(result["steps"], 20)
                self.assertEqual([b["name"] for b in result["backends"]], ["opencl:0", "cpu"])

    def test_the_device_that_run_takes(self):
        chosen = self.json("run", self.scene(), "--steps", 1)["backend"]
        if chosen == "cpu":
            self.skipTest("there is no bit-exact OpenCL device")
        result = self.json("compare", self.scene(), "--steps", 2)
        self.assertEqual([b["name"] for b in result["backends"]], [chosen, "cpu"])

    def test_every_step_looks_less_often(self):
        by_pass = self.json("compare", self.scene(), "--backends", "cpu,cpu", "--steps", 20)
        by_step = self.json("compare", self.scene(), "--backends", "cpu,cpu", "--steps", 20, "--every", "step")
        self.assertTrue(by_pass["identical"] and by_step["identical"])
        self.assertLess(by_step["values_compared"], by_pass["values_compared"])
        self.assertEqual(by_pass["passes"], 3)

    def test_double_is_refused(self):
        done = self.pliant("compare", self.scene(), "--backends", "cpu,cpu:double", expect=2)
        self.assertIn("computes in double", done.stderr)

    def test_without_opencl(self):
        env = {"OCL_ICD_VENDORS": str(self.folder)}
        if any(b["name"].startswith("opencl") for b in self.json("devices", env=env)["backends"]):
            self.skipTest("the OpenCL loader finds devices whatever the environment says")
        message = self.refused("compare", self.scene(), words=["--backends A,B"], env=env)
        self.assertRegex(message, "there is no OpenCL device|this build of Pliant has no OpenCL")


if __name__ == "__main__":
    harness.main()
