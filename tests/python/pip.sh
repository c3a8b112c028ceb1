#!/usr/bin/env bash
# The Python package in fresh environments, without a network: installed by CMake, and by pip where scikit-build-core is there, from the
# source tree and from its sdist. The module is the one of the build folder. Usage: pip.sh SOURCE BUILD PYTHON; skipped without venv or NumPy.
set -euo pipefail
source=$1 build=$2 python=$3
"$python" -c 'import ensurepip, venv, numpy' 2>/dev/null || {
  echo 'skipped: needs python3-venv and python3-numpy'
  exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PYTHONPATH

# environment NAME: a fresh one, which sees what PYTHON has, also where that belongs to an environment; prints its interpreter.
environment() {
  "$python" -m venv --system-site-packages "$work/$1"
  "$python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))' >"$(folder "$work/$1/bin/python")/outer.pth"
  echo "$work/$1/bin/python"
}
folder() { "$1" -c 'import sysconfig; print(sysconfig.get_path("platlib"))'; }

# What pyproject.toml says of the version, for those who have no scikit-build-core (tomllib is in Python from 3.11 on).
(cd "$source" && "$python" - "$build") <<'PYTHON'
import pathlib
import re
import sys

cache = re.search(r"^CMAKE_PROJECT_VERSION:STATIC=(.*)$", pathlib.Path(sys.argv[1], "CMakeCache.txt").read_text(), re.M)[1]
try:
    import tomllib
except ImportError:
    sys.exit(print("left out: the version in pyproject.toml (Python 3.11 has tomllib)"))
project = tomllib.loads(pathlib.Path("pyproject.toml").read_text())
how = project["tool"]["scikit-build"]["metadata"]["version"]
found = how["result"].format(**re.search(how["regex"], pathlib.Path(how["input"]).read_text()).groupdict())
assert found == cache, f"pyproject.toml reads the version {found}, CMake {cache}"
missing = [file for file in project["project"]["license-files"] if not pathlib.Path(file).is_file()]
assert not missing, missing
PYTHON

# works PYTHON: the package of that environment, all of its files, runs.
works() {
  (cd "$work" && LD_LIBRARY_PATH=$build${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} "$1" - "$source/python/pliant") <<'PYTHON'
import pathlib
import sys

import pliant
import pliant.convert
import pliant.view

assert pliant.__file__.startswith(sys.prefix), pliant.__file__
assert "cpu" in pliant.backends()
here, there = pathlib.Path(pliant.__file__).parent, pathlib.Path(sys.argv[1])
files = {str(f.relative_to(there)) for pattern in ("*.py", "*.pyi", "py.typed") for f in there.rglob(pattern)}
missing = sorted(f for f in files if not (here / f).is_file())
assert files and not missing, f"not installed: {missing}"
PYTHON
}

by_cmake=$(environment cmake)
cmake --install "$build" --component python --prefix "$(folder "$by_cmake")" >/dev/null
works "$by_cmake"
echo "cmake --install --component python: works"

# refuses TEXT OPTION...: CMake says so and configures nothing.
refuses() {
  local configured=yes
  cmake -G Ninja -S "$source" -B "$work/none" "${@:2}" >"$work/none.log" 2>&1 || configured=no
  [ $configured = no ] && tr -s '\n ' ' ' <"$work/none.log" | grep -qF "$1" && return 0
  cat "$work/none.log"
  return 1
}
refuses 'The Python module needs pybind11 (Debian: pybind11-dev, or pip install pybind11)' -DPLIANT_PYTHON=ON -DPLIANT_PYTHON_REQUIRED=ON \
  -DPLIANT_TESTS=OFF -DPLIANT_EXAMPLES=OFF -DPLIANT_BENCH=OFF -DPython3_EXECUTABLE="$python" -DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON
refuses "PLIANT_PYTHON_BUILD: $work/python holds no package pliant" -DPLIANT_PYTHON_BUILD="$work"

by_pip=$(environment pip)
"$by_pip" -c 'import scikit_build_core' 2>/dev/null || {
  echo 'left out: pip install, since scikit-build-core is not installed (pip install scikit-build-core)'
  exit 0
}
install() { PLIANT_PYTHON_BUILD=$build "$@" -m pip --disable-pip-version-check install --quiet --no-index --no-build-isolation --no-deps "$from"; }
from=$source install "$by_pip"
works "$by_pip"
"$by_pip" - <<'PYTHON'
import importlib.metadata

import pliant

assert pliant.__version__ == importlib.metadata.version("pliant")
for extra, needs in (("opencl", "pocl-binary-distribution"), ("view", "viser"), ("gym", "gymnasium"), ("convert", "meshio"), ("convert", "usd-core")):
    found = [r for r in importlib.metadata.requires("pliant") if needs in r and f'extra == "{extra}"' in r.replace("'", '"')]
    assert found, f"{needs} is optional"
named = {file.name for file in importlib.metadata.files("pliant")}
assert {"LICENSE", "copyright"} <= named, named
print("pip install: pliant", pliant.__version__, "from", pliant.__file__)
PYTHON

(cd "$source" && "$by_pip" -c 'import sys, scikit_build_core.build as b; b.build_sdist(sys.argv[1])' "$work" >"$work/sdist.log" 2>&1) || {
  cat "$work/sdist.log"
  exit 1
}
from=$(echo "$work"/pliant-*.tar.gz)
if tracked=$(git -C "$source" ls-files 2>/dev/null); then
  missing=$(comm -23 <(sort <<<"$tracked") <(tar -tzf "$from" | sed 's|^[^/]*/||' | sort))
  [ -z "$missing" ] || { echo "not in the sdist: $missing"; exit 1; }
fi
from_sdist=$(environment sdist)
install "$from_sdist"
works "$from_sdist"
echo "$(basename "$from"): the same"
