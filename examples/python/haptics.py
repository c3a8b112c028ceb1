"""A hand presses a soft block and feels it a thousand times a second.

haptics.py [SECONDS [DEVICE]], for example haptics.py 60 udp:5000; from the build folder:
PYTHONPATH=build/release/python python3 examples/python/haptics.py
"""
import sys
import time

import numpy as np

import pliant

SECONDS = float(sys.argv[1]) if len(sys.argv) > 1 else 10
DEVICE = sys.argv[2] if len(sys.argv) > 2 else None

# %% A block, and a ball that waits 2 mm above it.
vertices = np.array([[x, y, z] for z in (0, 0.1) for y in (0, 0.05) for x in (0, 0.1)])
triangles = np.array([[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4],
                      [2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]])
scene = {
    "format": "pliant-scene/1",
    "bodies": [{
        "name": "block",
        "surface": "memory:0",
        "lattice": {"spacing": 0.0125},
        "material": {"young": 10000, "poisson": 0.45, "damping": 40},
        "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}],
    }],
    "tools": [{"name": "probe", "shape": {"sphere": 0.012}, "path": [[0, 0.05, 0.064, 0.05]]}],
}
world = pliant.World(scene, surfaces=[(vertices, triangles)])

# %% The loop has a thread of its own, which never waits for Python.
manual = pliant.ManualDevice()  # moved below; a device in a hand moves by itself
with pliant.HapticLoop(world, "probe", DEVICE or manual) as loop:
    world.run_live()
    for i in range(int(100 * SECONDS)):
        manual.set_pose([0, -0.006 * (1 - np.cos(0.01 * i * np.pi)), 0])  # 12 mm down and up again, in two seconds
        world.frame()  # a viewer draws it
        time.sleep(0.01)
        if i % 10 == 9:
            now = loop.state().last
            print(f"t = {now.time:.2f} s: at y = {now.position[1]:.4f} m the hand feels {now.force[1]:.3f} N")
world.stop_live()

# %% Every tick is there, not only those that were printed.
ticks = loop.samples()
print(f"{len(ticks)} ticks; the greatest force is {ticks['force'][:, 1].max():.3f} N")
