#!/usr/bin/env bash
# pip install from a source tree into a fresh environment, without a network; the module is the one of the build folder.
# Usage: pip.sh SOURCE BUILD PYTHON; skipped without venv, setuptools, wheel or NumPy.
set -euo pipefail
source=$1 build=$2 python=$3
"$python" -c 'import ensurepip, setuptools, venv, wheel, numpy' 2>/dev/null || {
  echo 'skipped: needs python3-venv, python3-setuptools, python3-wheel and python3-numpy'
  exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/source/include/pliant" "$work/source/python"  # pip builds inside the tree
cp "$source/setup.py" "$source/pyproject.toml" "$work/source"
cp -r "$source/python/pliant" "$work/source/python"
cp "$source/include/pliant/version.h" "$work/source/include/pliant"
"$python" -m venv --system-site-packages "$work/venv"
PLIANT_PYTHON_BUILD=$build "$work/venv/bin/python" -m pip --disable-pip-version-check install --quiet --no-index --no-build-isolation \
  "$work/source"

# Without pybind11 one line names it. (Configuring looks for nothing else first.)
CMAKE_ARGS=-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON "$work/venv/bin/python" - "$source" "$work" <<'PYTHON'
import os
import subprocess
import sys

source, work = sys.argv[1:]
done = subprocess.run([sys.executable, "setup.py", "-q", "build_ext", "--build-temp", f"{work}/temp", "--build-lib", f"{work}/lib"], cwd=source,
                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=dict(os.environ, PLIANT_PYTHON_BUILD=""))
lines = done.stdout.strip().splitlines()
assert done.returncode != 0 and len(lines) == 1 and lines[0].endswith("needs pybind11 (Debian: pybind11-dev, or pip install pybind11)"), done.stdout
print(lines[0])
PYTHON

cd "$work"
unset PYTHONPATH
"$work/venv/bin/python" - <<'PYTHON'
import importlib.metadata
import sys

import pliant
import pliant.convert
import pliant.view

assert pliant.__file__.startswith(sys.prefix), pliant.__file__
assert pliant.__version__ == importlib.metadata.version("pliant")
assert "cpu" in pliant.backends()
for extra, needs in (("view", "viser"), ("gym", "gymnasium"), ("convert", "meshio"), ("convert", "usd-core")):
    found = [r for r in importlib.metadata.requires("pliant") if needs in r and f'extra == "{extra}"' in r.replace("'", '"')]
    assert found, f"{needs} is optional"
print("pliant", pliant.__version__, "from", pliant.__file__)
PYTHON
