"""What the tests of benchmarks share."""
import functools
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

PLIANT = os.environ.get("PLIANT", "pliant")
SOURCE = Path(os.environ.get("PLIANT_SOURCE", Path(__file__).resolve().parents[2]))


def schema_errors(value, schema):
    """What in `value` the schema docs/schema/`schema`.json does not allow."""
    spec = importlib.util.spec_from_file_location("harness", SOURCE / "tests" / "cli" / "harness.py")
    harness = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(harness)
    return harness.schema_errors(value, json.loads((SOURCE / "docs" / "schema" / f"{schema}.json").read_text()))


@functools.cache
def python_with_matplotlib():
    """This Python, or the system's, whose packages Debian installs; None if neither has matplotlib."""
    for python in (sys.executable, "/usr/bin/python3"):
        if Path(python).exists() and subprocess.run([python, "-c", "import matplotlib"], capture_output=True).returncode == 0:
            return python
    return None
