"""Pull a block by one corner, read its surface without copies, and print how far the corner follows.

From the build folder: PYTHONPATH=build/release/python python3 examples/python/pull_a_block.py
"""
import numpy as np

import pliant

# %% A scene is a dict with the keys of docs/scene.md. Its surface comes from two arrays.
vertices = np.array([[x, y, z] for z in (0, 0.06) for y in (0, 0.08) for x in (0, 0.1)])
triangles = np.array([[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4],
                      [2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]])
scene = {
    "format": "pliant-scene/1",
    "gravity": [0, -9.81, 0],
    "bodies": [{
        "name": "block",
        "surface": "memory:0",
        "lattice": {"spacing": 0.01},
        "material": {"young": 3000, "poisson": 0.45, "density": 1000, "damping": 5},
        "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}],
    }],
}

# %% A world on the best backend of this machine.
world = pliant.World(scene, surfaces=[(vertices, triangles)], interactive=True)
print(f"{world.info['nodes']} nodes on {world.info['reason']}; a step of {1e3 * world.dt:.3f} ms")

# %% Take the corner and pull it 2 cm. The worker steps while Python does something else.
corner = 7
hand = world.grab(corner, radius=0.02)
world.move_grab(hand, vertices[corner] + [0.02, 0, 0])
path = []
for _ in range(60):
    world.advance_async(1 / 60)
    world.wait()
    path.append(world.frame().positions[corner].copy())  # positions is a view; a row that is kept is copied
path = np.array(path)
print("x of the corner [m], every 10 frames:", np.array2string(path[::10, 0], precision=4))

# %% Let go; how large is the displacement field?
world.release(hand)
u = world.displacements()
print(f"largest displacement of {len(u)} nodes: {1e3 * np.linalg.norm(u, axis=1).max():.2f} mm")
