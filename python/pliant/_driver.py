"""An OpenCL driver from pip, for machines that have none: the package pocl-binary-distribution holds PoCL, which compiles kernels for the processor."""
import glob
import importlib.util
import os

# Either names the drivers that ocl-icd, the loader in the wheel, is to use.
_CHOICES = ("OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH")


def find():
    """The driver's library, or None where pip has not installed it."""
    spec = importlib.util.find_spec("pocl_binary_distribution")
    if spec is None or spec.origin is None:
        return None
    site = os.path.dirname(os.path.dirname(spec.origin))
    found = glob.glob(os.path.join(site, "pyopencl", ".libs", "libpocl*.so*"))  # where its wheel puts the library
    found = sorted(file for file in found if "libpocl-devices" not in file)
    return found[0] if found else None


def offer(vendors="/etc/OpenCL/vendors"):
    """Lets the OpenCL loader find that driver, unless the environment names drivers or the folder `vendors` lists some. Returns its library or None.

    It sets OCL_ICD_VENDORS, so that all that uses ocl-icd in this process and its children sees this driver alone.
    Works until OpenCL is first used in the process (`pliant.backends`, a World on another backend than `cpu`).
    """
    if any(name in os.environ for name in _CHOICES) or glob.glob(os.path.join(vendors, "*.icd")):
        return None
    driver = find()
    if driver is not None:
        os.environ["OCL_ICD_VENDORS"] = driver
    return driver
