"""pip install . : configures and builds the Python module with CMake. Needs what ./dev build needs, python3-dev and pybind11-dev."""
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


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        build = Path(os.environ.get("PLIANT_PYTHON_BUILD", Path(self.build_temp).resolve() / "cmake"))
        out = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        subprocess.run(["cmake", "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_POSITION_INDEPENDENT_CODE=ON",
                        "-DPLIANT_TESTS=OFF", "-DPLIANT_EXAMPLES=OFF", "-DPLIANT_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "pliant_python", "-j", str(os.cpu_count() or 1)], check=True)
        out.mkdir(parents=True, exist_ok=True)
        module = next((build / "python").glob("pliant*.so"))
        (out / Path(self.get_ext_filename(ext.name)).name).write_bytes(module.read_bytes())


setup(name="pliant", version=version(), description="Soft-tissue deformation on OpenCL and on a bit-exact CPU reference",
      python_requires=">=3.9", install_requires=["numpy"], ext_modules=[Extension("pliant", [])], cmdclass={"build_ext": CMakeBuild},
      packages=[])
