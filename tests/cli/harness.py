"""Runs the pliant command, and checks its JSON against the schemas in docs/schema."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PLIANT = os.environ.get("PLIANT", "pliant")
SOURCE = Path(os.environ.get("PLIANT_SOURCE", Path(__file__).resolve().parents[2]))
SCENES = SOURCE / "scenes"
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def has_type(value, name):
    if name == "integer":
        return isinstance(value, int) and not isinstance(value, bool)
    if name == "number":
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    return isinstance(value, TYPES[name])


def schema_errors(value, schema, where=""):
    """The part of JSON Schema that docs/schema uses."""
    names = schema.get("type", [])
    names = [names] if isinstance(names, str) else names
    if names and not any(has_type(value, name) for name in names):
        return [f"{where}: {value!r} is no {names}"]
    errors = []
    if "enum" in schema and value not in schema["enum"]:
        errors.append(f"{where}: {value!r} is none of {schema['enum']}")
    if isinstance(value, str) and "pattern" in schema and not re.search(schema["pattern"], value):
        errors.append(f"{where}: {value!r} does not match {schema['pattern']}")
    if has_type(value, "number") and "minimum" in schema and value < schema["minimum"]:
        errors.append(f"{where}: {value} is below {schema['minimum']}")
    if isinstance(value, dict):
        known = schema.get("properties", {})
        errors += [f"{where}/{key}: missing" for key in schema.get("required", []) if key not in value]
        for key, item in value.items():
            if key in known:
                errors += schema_errors(item, known[key], f"{where}/{key}")
            elif schema.get("additionalProperties") is False:
                errors.append(f"{where}/{key}: not in the schema")
            elif isinstance(schema.get("additionalProperties"), dict):
                errors += schema_errors(item, schema["additionalProperties"], f"{where}/{key}")
    if isinstance(value, list):
        for i, item in enumerate(value):
            errors += schema_errors(item, schema.get("items", {}), f"{where}/{i}")
    return errors


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="pliant-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def pliant(self, *arguments, expect=0, **options):
        done = subprocess.run([PLIANT, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=500, **options)
        if expect is not None:
            self.assertEqual(done.returncode, expect, f"pliant {arguments}\nstdout: {done.stdout}\nstderr: {done.stderr}")
        return done

    def json(self, command, *arguments, expect=0, **options):
        """Standard output must be one JSON object that fits the command's schema, and nothing else."""
        done = self.pliant(command, *arguments, "--json", "-", expect=expect, **options)
        value = json.loads(done.stdout)
        schema = json.loads((SOURCE / "docs" / "schema" / f"{command}.json").read_text())
        self.assertEqual(schema_errors(value, schema), [])
        return value

    def refused(self, *arguments, words=(), **options):
        """Exit code 2, nothing on standard output, and one message that holds the words."""
        done = self.pliant(*arguments, expect=2, **options)
        self.assertEqual(done.stdout, "")
        messages = [line for line in done.stderr.splitlines() if not line.startswith(("pliant: backend ", "pliant: tolerance "))]
        self.assertEqual(len(messages), 1, done.stderr)
        self.assertTrue(messages[0].startswith("pliant: "), done.stderr)
        for word in words:
            self.assertIn(word, messages[0])
        return messages[0]

    def scene(self, name="scene", body=None, **keys):
        """A soft cube of 125 cells that is pressed from above, as a file; `keys` and `body` replace parts of it, None leaves one out."""
        cube = {
            "name": "cube",
            "surface": str(SCENES / "meshes" / "cube.obj"),
            "lattice": {"spacing": 0.02},
            "element": "hex8",
            "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000, "damping": 5},
            "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}],
            "prescribed": [
                {"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, -0.01, 0], "curve": "smooth", "duration": 0.2}
            ],
        }
        cube.update(body or {})
        scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "duration": 0.3, "bodies": [{key: value for key, value in cube.items() if value is not None}]}
        scene.update(keys)
        file = self.folder / f"{name}.json"
        file.write_text(json.dumps(scene))
        return file

    def names(self, folder="."):
        return sorted(p.name for p in (self.folder / folder).iterdir())

    def opencl(self):
        """The first OpenCL device as `pliant devices` describes it, or skip."""
        for backend in json.loads(self.pliant("devices", "--json", "-").stdout)["backends"]:
            if backend["name"] == "opencl:0":
                return backend
        self.assertNotIn("PLIANT_REQUIRE_OPENCL", os.environ, "there is no OpenCL device, and PLIANT_REQUIRE_OPENCL is set")
        self.skipTest("there is no OpenCL device")


def main():
    unittest.main(verbosity=2)
