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
mkdir -p "$work/source/include/pliant"  # pip builds inside the tree
cp "$source/setup.py" "$source/pyproject.toml" "$work/source"
cp "$source/include/pliant/version.h" "$work/source/include/pliant"
"$python" -m venv --system-site-packages "$work/venv"
PLIANT_PYTHON_BUILD=$build "$work/venv/bin/python" -m pip --disable-pip-version-check install --quiet --no-index --no-build-isolation \
  "$work/source"
cd "$work"
unset PYTHONPATH
"$work/venv/bin/python" - <<'PYTHON'
import importlib.metadata
import sys

import pliant

assert pliant.__file__.startswith(sys.prefix), pliant.__file__
assert pliant.__version__ == importlib.metadata.version("pliant")
assert "cpu" in pliant.backends()
print("pliant", pliant.__version__, "from", pliant.__file__)
PYTHON
