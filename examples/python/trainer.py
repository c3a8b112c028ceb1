"""A trainer at 60 Hz without a window: an organ on a table, a probe, a scalpel, a hand that lifts the flap, save, load and reset.

trainer.py [ORGAN.obj [SECONDS]]; from the build folder: PYTHONPATH=build/release/python python3 examples/python/trainer.py
"""
import os
import sys
import tempfile
import time

import numpy as np

import pliant

MESH = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "scenes/meshes/liver.obj")
SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else 20
RATE = 60

# %% The organ lies just above a table, and the probe waits above it.
height = np.array([line.split()[2] for line in open(MESH) if line.startswith("v ")], float)
scene = {
    "format": "pliant-scene/1",
    "gravity": [0, -9.81, 0],
    "contact": {"friction": 0.3},
    "bodies": [{
        "name": "organ",
        "surface": MESH,
        "translate": [0, 0.005 - height.min(), 0],
        "lattice": {"nodes": 2886},
        "material": {"young": 9000, "poisson": 0.45, "density": 1060, "damping": 15},
    }],
    "tools": [
        {"name": "table", "shape": {"half_space": [[0, 0, 0], [0, 1, 0]]}, "friction": 0.5},
        {"name": "probe", "shape": {"capsule": [[0, 0, 0], [0, 0.12, 0], 0.008]}, "friction": 0.2, "path": [[0, 0, np.ptp(height) + 0.1, 0]]},
    ],
}
world = pliant.World(scene, interactive=True, cutting=True)
folder = tempfile.TemporaryDirectory()
checkpoint = os.path.join(folder.name, "trainer.pck")

# %% What the trainee does at time t of 20; `low` and `high` are the corners of the organ's box at rest.
hand, done, events = None, set(), []


def once(part, t):
    new = t >= part and part not in done
    done.update({part} if new else set())
    return new


def act(t):
    global hand
    at = low + (high - low) * [0.6 - 0.25 * np.clip((t - 4) / 3, 0, 1), 1, 0.5]
    if 2 < t < 8:  # down, along, up again
        world.drive_tool("probe", at + [0, 0.06 - 0.078 * min(1, (t - 2) / 2, 8 - t), 0], [0, 0, 0, 1], 1 / RATE)
    if 9 < t < 11:  # a slice, from the side into the middle
        x, y = low[0] + (high[0] - low[0]) * (1.05 - 0.2 * (t - 9)), high[1] - 0.025
        world.move_blade("scalpel", [x, y, low[2] - 0.03], [x, y, high[2] + 0.03])
    if once(11, t):
        world.lift_blade("scalpel")
    if once(12, t):
        hit = world.pick([low[0] + 0.84 * (high[0] - low[0]), high[1] + 0.5, (low[2] + high[2]) / 2], [0, -1, 0])
        hand = hit and (world.grab(hit["vertex"]), np.array(hit["point"]))
    if hand and t < 15:
        world.move_grab(hand[0], hand[1] + np.array([-0.02, 0.03, 0]) * min(1, (t - 12) / 2))
    if once(15, t) and hand:
        world.release(hand[0])
        hand = None
    for part, call in ((16, lambda: world.save(checkpoint)), (17, lambda: world.load(checkpoint)), (18, world.reset)):
        if once(part, t):
            call()


# %% The loop of a program that draws: wait for the display, take the frame if there is a new one, act.
world.run_live(RATE, ahead=1)
start, stale, worst, force, seen = time.perf_counter(), 0, 0.0, 0.0, -1
for picture in range(int(SECONDS * RATE)):
    time.sleep(max(0, start + picture / RATE - time.perf_counter()))
    begun = time.perf_counter()
    stale += not world.poll()
    frame = world.frame()
    t = 20 * picture / (SECONDS * RATE)
    if t <= 2:
        low, high = frame.positions.min(axis=0), frame.positions.max(axis=0)
    act(t)
    samples = world.force_trace("probe", seen)
    if len(samples):
        seen, force = samples["step"][-1], max(force, np.linalg.norm(samples["force"], axis=1).max())
    news = world.events()
    events += news
    seen = -1 if any(e["kind"] in ("loaded", "reset") for e in news) else seen  # steps begin anew
    worst = max(worst, time.perf_counter() - begun)

# %% What it was like.
live = world.live_state()
world.stop_live()
print(f"{100 * stale / (SECONDS * RATE):.1f} % of the pictures showed nothing new; at the end {live['real_time']:.2f} of real time")
print(f"longest time in a picture {1e3 * worst:.2f} ms; at most {force:.2f} N on the probe")
for event in events + world.events():
    print(f"t = {event['time']:.2f} s: {event['kind']} {event['subject']} {event['text']}")
