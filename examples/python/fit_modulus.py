"""Fit Young's modulus to a force curve: 16 candidates at a time press the same ball into the same block.

From the build folder: PYTHONPATH=build/release/python python3 examples/python/fit_modulus.py
"""
import numpy as np

import pliant

# %% A block of 75 x 30 x 75 mm, held at its bottom, and a ball above it.
vertices = np.array([[x, y, z] for z in (0, 0.075) for y in (0, 0.03) for x in (0, 0.075)])
triangles = np.array([[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4],
                      [2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]])
scene = {
    "format": "pliant-scene/1",
    "bodies": [{
        "name": "block",
        "surface": "memory:0",
        "lattice": {"spacing": 0.0075},
        "material": {"young": 4000, "poisson": 0.4, "density": 1000, "damping": 60},
        "fixed": [{"plane": [[0, 1e-4, 0], [0, -1, 0]]}],
    }],
    "tools": [{"name": "ball", "shape": {"sphere": 0.01}, "path": [[0, 0.0375, 0.0405, 0.0375]]}],
}
surfaces = [(vertices, triangles)]


def force_curves(batch):
    """The force of each member while the ball goes 6.5 mm down in 0.2 s: [N], shape [members, 10]."""
    curves = []
    for y in np.linspace(0.0405, 0.034, 11)[1:]:
        batch.drive_tool("ball", np.tile([0.0375, y, 0.0375], (len(batch), 1)), seconds=0.02)
        batch.advance(0.02)
        curves.append(batch.tool_forces("ball")[:, 1])
    return np.array(curves).T


# %% The measurement: a block whose modulus is to be found, read by a gauge with a noise of 1 %.
TRUE = 5300.0
with pliant.Batch(scene, 1, surfaces=surfaces, vary={"young": [TRUE]}) as phantom:
    measured = force_curves(phantom)[0]
measured *= 1 + 0.01 * np.random.default_rng(1).standard_normal(len(measured))

# %% Forces grow with the modulus. So the signed misfit has one zero, and each round searches between the two candidates around it.
low, high = 1000.0, 30000.0
with pliant.Batch(scene, 16, surfaces=surfaces) as batch:
    for attempt in range(3):
        moduli = np.geomspace(low, high, len(batch))
        batch.reset(vary={"young": moduli})
        misfit = (force_curves(batch) - measured) @ measured / (measured @ measured)
        if batch.failed.any() or not misfit[0] < 0 < misfit[-1]:
            raise SystemExit(f"the modulus is not between {low:.0f} and {high:.0f} Pa")
        above = np.argmax(misfit > 0)
        low, high = moduli[above - 1], moduli[above]
        fitted = low - misfit[above - 1] * (high - low) / (misfit[above] - misfit[above - 1])  # the secant
        print(f"round {attempt}: between {low:.1f} and {high:.1f} Pa, by the secant {fitted:.1f} Pa")
error = fitted / TRUE - 1
print(f"fitted {fitted:.0f} Pa, true {TRUE:.0f} Pa: {100 * error:+.2f} %")
