"""What the tests of the Python package share: without NumPy they are skipped."""
import os
import sys

try:
    import numpy as np
except ImportError:
    print("skipped: NumPy is not installed (Debian: python3-numpy)")
    sys.exit(77)

SOURCE = os.environ["PLIANT_SOURCE"]


def box(x, y, z):
    """Vertices and triangles of a box from the origin [m]."""
    vertices = np.array([[a, b, c] for c in (0, z) for b in (0, y) for a in (0, x)])
    return vertices, np.array([[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4],
                               [2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]])
