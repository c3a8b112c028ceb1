"""pip install . : configures and builds the compiled part of the Python package with CMake. Needs what ./dev build needs, python3-dev and pybind11.

CMAKE_ARGS are further options of CMake.
PLIANT_PYTHON_BUILD names a build folder that holds that part already; it is then taken from there.
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent


def version():
    text = (SOURCE / "include/pliant/version.h").read_text()
    return ".".join(re.search(rf"PLIANT_VERSION_{part} (\d+)", text)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def pybind11_options():
    """Where pip has put pybind11, as it does from pyproject.toml; CMake itself finds the one of the system."""
    try:
        import pybind11
    except ImportError:
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def cmake(*arguments):
    """The output is shown only of a call that fails, and only the reason where CMake gives one."""
    try:
        done = subprocess.run(["cmake", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    except FileNotFoundError:
        raise SystemExit("pliant: cmake is missing (Debian: cmake)") from None
    if done.returncode == 0:
        return
    reason = re.search(r"^CMake Error at .*\n\n?((?:  .*\n)+)", done.stdout, re.M)
    if not reason:
        print(done.stdout)
    raise SystemExit("pliant: " + (" ".join(reason[1].split()) if reason else f"cmake {arguments[0]} failed, see above"))


def cmake_build(folder):
    generator = ["-G", "Ninja"] if shutil.which("ninja") and "CMAKE_GENERATOR" not in os.environ else []
    options = [*generator, "-DCMAKE_BUILD_TYPE=Release", "-DPLIANT_TESTS=OFF", "-DPLIANT_EXAMPLES=OFF", "-DPLIANT_BENCH=OFF", "-DPLIANT_PYTHON=ON",
               "-DPLIANT_PYTHON_REQUIRED=ON", f"-DPython3_EXECUTABLE={sys.executable}", *pybind11_options(),
               *shlex.split(os.environ.get("CMAKE_ARGS", ""))]
    cmake("-S", str(SOURCE), "-B", str(folder), *options)
    cmake("--build", str(folder), "--target", "pliant_python", "-j", str(os.cpu_count() or 1))


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        ready = os.environ.get("PLIANT_PYTHON_BUILD")
        folder = Path(ready) if ready else Path(self.build_temp).resolve() / "cmake"
        if not ready:
            cmake_build(folder)
        modules = sorted((folder / "python/pliant").glob("_core*.so"))
        if not modules:
            raise SystemExit(f"pliant: {folder}/python holds no package pliant: that build has left it out")
        out = Path(self.get_ext_fullpath(ext.name)).resolve()
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_bytes(modules[0].read_bytes())


setup(name="pliant", version=version(), description="Soft-tissue deformation on OpenCL and on a bit-exact CPU reference",
      license_files=["LICENSE", "cmake/copyright"],
      python_requires=">=3.9", install_requires=["numpy"], extras_require={"view": ["viser>=1.1"], "gym": ["gymnasium>=1.0"],
                      "convert": ["meshio>=5", "usd-core>=23"]},
      ext_modules=[Extension("pliant._core", [])], cmdclass={"build_ext": CMakeBuild},
      packages=["pliant", "pliant.convert", "pliant.view"], package_dir={"pliant": "python/pliant"}, package_data={"pliant": ["__init__.pyi", "py.typed"]})
