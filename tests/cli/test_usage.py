"""Commands and options that do not exist, and help."""
import harness


class Usage(harness.CliTest):
    def test_version_and_help(self):
        self.assertRegex(self.pliant("--version").stdout, r"^pliant \d+\.\d+\.\d+\n$")
        for command in ("devices", "info", "run", "compare"):
            self.assertIn(command, self.pliant("--help").stdout)
            self.assertIn("--json", self.pliant(command, "--help").stdout)

    def test_unknown_command_names_the_nearest(self):
        self.refused("rum", words=["unknown command \"rum\"", "did you mean run?", "devices, info, run, compare"])
        self.refused("comapre", words=["did you mean compare?"])
        self.refused(words=["no command given", "devices"])

    def test_unknown_option_names_the_nearest(self):
        self.refused("run", "x.json", "--stpes", "3", words=["unknown option \"--stpes\"; did you mean --steps?"])
        self.refused("run", "x.json", "y.json", words=["unexpected argument \"y.json\""])
        self.refused("run", words=["scene is required"])
        self.refused("--jsn", words=["unknown option \"--jsn\""])

    def test_values_out_of_range(self):
        scene = self.scene()
        self.refused("run", scene, "--steps", "-1", words=["--steps is -1"])
        self.refused("run", scene, "--steps", "many", words=["--steps"])
        self.refused("run", scene, "--steps", "99999999999999999999", words=["--steps"])
        self.refused("run", scene, "--seconds", "nan", words=["--seconds"])
        self.refused("run", scene, "--seconds", "1", "--steps", "1", words=["--steps"])
        self.refused("run", scene, "--dt", "0", words=["--dt is 0 s", "more than 0"])
        self.refused("run", scene, "--every", "5", words=["--out"])
        self.refused("run", scene, "--out", "o", "--every", "0", words=["--every is 0"])
        for every in ("-5", "5 s", "5m", "0s", "-1ms", "nans", "1e-30s", "infs", "s"):
            self.refused("run", scene, "--out", "o", f"--every={every}", words=["--every is " + every, "16ms", "1 or more steps"])
        self.refused("run", scene, "--checkpoint", "c", "--checkpoint-every", "0", words=["--checkpoint-every is 0 s", "more than 0"])
        self.refused("run", scene, "--checkpoint-every", "5", words=["--checkpoint-every", "needs --checkpoint"])
        self.refused("run", scene, "--out", "o", "--format", "jpg", words=["\"jpg\"", "vtu, obj"])
        self.refused("run", scene, "--backend", "gpu", words=["\"gpu\"", "opencl:N"])
        self.refused("run", scene, "--backend", "opencl:999", words=["opencl"])
        self.refused("compare", scene, "--every", "frame", words=["\"frame\"", "pass, step"])
        self.refused("compare", scene, "--backends", "cpu", words=["expected two"])
        self.assertEqual(self.names(), ["scene.json"])

    def test_help_and_messages_list_what_there_is(self):
        help_text = " ".join(self.pliant("run", "--help").stdout.split())
        for word in ("vtu (", "obj (", "png (", "gltf ("):
            self.assertIn(word, help_text)
        bench = " ".join(self.pliant("bench", "kernels", "--help").stdout.split())
        for word in ("tet4 (", "tet4anp (", "hex8 (", "hex8full (", "neo-hookean", "stable-neo-hookean", "yeoh", "mooney-rivlin"):
            self.assertIn(word, bench)

    def test_bad_scenes(self):
        self.refused("run", "missing.json", words=["missing.json", "no such file"])
        self.refused("info", self.scene(gravty=[0, 0, 0]), words=["gravty", "gravity"])
        self.refused("info", self.scene(body={"surface": "nowhere.obj"}), words=["nowhere.obj"])
        self.refused("run", self.scene(body={"fixed": [{"box": [[9, 9, 9], [10, 10, 10]]}]}), words=["/bodies/0/fixed/0"])


if __name__ == "__main__":
    harness.main()
