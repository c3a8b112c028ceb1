"""The OpenCL driver that pip can bring (pliant._driver): when it is offered, and, where it is installed, that it gives the bits of the twins."""
import importlib.util
import os
import subprocess
import sys
import tempfile

from common import box  # first: exits where NumPy is missing
import pliant
from pliant import _driver

SCENE = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0],
         "bodies": [{"name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.4}}]}
ABSENT = os.path.join(tempfile.gettempdir(), "no-such-folder")


def site_with_driver(folder):
    """A folder for sys.path, laid out as pip lays out the package."""
    for path in ("pocl_binary_distribution/__init__.py", "pyopencl/.libs/libpocl-1.so"):
        file = os.path.join(folder, path)
        os.makedirs(os.path.dirname(file))
        open(file, "w").close()
    return os.path.join(folder, "pyopencl/.libs/libpocl-1.so")


def offered(environment, vendors):
    """What offer() returns in this environment, and what it leaves there."""
    saved = dict(os.environ)
    try:
        for name in ("OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"):
            os.environ.pop(name, None)
        os.environ.update(environment)
        return _driver.offer(vendors), os.environ.get("OCL_ICD_VENDORS")
    finally:
        os.environ.clear()
        os.environ.update(saved)


def test_offers_only_what_is_needed():
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as vendors:
        library = site_with_driver(folder)
        sys.path.insert(0, folder)
        try:
            assert offered({}, ABSENT) == (library, library)
            assert offered({"OCL_ICD_VENDORS": "mine"}, ABSENT) == (None, "mine")
            assert offered({"OPENCL_VENDOR_PATH": "mine"}, ABSENT) == (None, None)
            open(os.path.join(vendors, "gpu.icd"), "w").close()
            assert offered({}, vendors) == (None, None), "the machine has a driver of its own"
            os.remove(library)
            assert offered({}, ABSENT) == (None, None), "the package without its library"
        finally:
            sys.path.remove(folder)
            sys.modules.pop("pocl_binary_distribution", None)


def test_the_machine_is_asked():
    """As at import: on a machine with drivers nothing changes."""
    if any(name.endswith(".icd") for name in (os.listdir("/etc/OpenCL/vendors") if os.path.isdir("/etc/OpenCL/vendors") else [])):
        assert offered({}, "/etc/OpenCL/vendors") == (None, None)


def hash_of(backend):
    world = pliant.World(SCENE, [box(0.06, 0.04, 0.06)], backend=backend)
    world.step(50)
    return world.hash()


def with_driver():
    """In a process of its own, since OpenCL reads its drivers once."""
    assert _driver.offer(ABSENT), "is offered where the machine has none"
    devices = [name for name in pliant.backends() if name.startswith("opencl")]
    assert devices, pliant.backends()
    assert {hash_of(name) for name in devices} == {hash_of("cpu")}
    print("the driver of pip:", ", ".join(devices), "with the bits of cpu")


def test_the_driver_of_pip():
    if importlib.util.find_spec("pocl_binary_distribution") is None:
        print("pocl-binary-distribution is not installed: its own bits are not tested")
        return
    environment = {k: v for k, v in os.environ.items() if k not in ("OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH")}
    subprocess.run([sys.executable, __file__, "driver"], check=True, env=environment)


if __name__ == "__main__":
    if sys.argv[1:] == ["driver"]:
        with_driver()
        sys.exit(0)
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
    print("ok")
