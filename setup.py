"""pip install . : configures and builds the Python module with CMake. Needs what ./dev build needs, python3-dev and pybind11-dev.

PLIANT_PYTHON_BUILD names a build folder that holds the module already; it is then taken from there.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent


def version():
    text = (SOURCE / "include/pliant/version.h").read_text()
    return ".".join(re.search(rf"PLIANT_VERSION_{part} (\d+)", text)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def cmake_build(folder):
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DPLIANT_TESTS=OFF", "-DPLIANT_EXAMPLES=OFF", "-DPLIANT_BENCH=OFF", "-DPLIANT_PYTHON=ON",
               f"-DPython3_EXECUTABLE={sys.executable}"]
    subprocess.run(["cmake", "-S", SOURCE, "-B", folder, *options], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "pliant_python", "-j", str(os.cpu_count() or 1)], check=True)


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        ready = os.environ.get("PLIANT_PYTHON_BUILD")
        folder = Path(ready) if ready else Path(self.build_temp).resolve() / "cmake"
        if not ready:
            cmake_build(folder)
        modules = sorted((folder / "python").glob("pliant*.so"))
        if not modules:
            raise SystemExit(f"{folder}/python holds no module pliant: it was left out, see what CMake says about pybind11 above")
        out = Path(self.get_ext_fullpath(ext.name)).resolve()
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_bytes(modules[0].read_bytes())


setup(name="pliant", version=version(), description="Soft-tissue deformation on OpenCL and on a bit-exact CPU reference",
      python_requires=">=3.9", install_requires=["numpy"], ext_modules=[Extension("pliant", [])], cmdclass={"build_ext": CMakeBuild},
      packages=[])
