"""Find a stiff inclusion by touch: the cross-entropy method on 32 palpation environments at a time.

From the build folder: PYTHONPATH=build/release/python python3 examples/python/palpate_search.py   (needs gymnasium: pip install "pliant[gym]")
"""
import sys
import time

import numpy as np

import pliant.gym

SEED = int(sys.argv[1]) if len(sys.argv) > 1 else 3
ENVIRONMENTS, ELITE, GENERATIONS = 32, 6, 6

# %% All environments begin with the same seed, so they have the same tissue.
environments = pliant.gym.make_vec(ENVIRONMENTS, steps=26)
random = np.random.default_rng(SEED)


def fly_and_press(places):
    """One episode each of the policy "to this place (x, z), then down"; the sum of rewards, the largest force that was felt [N]."""
    observations, _ = environments.reset(seed=[SEED] * ENVIRONMENTS)
    returns, over = np.zeros(ENVIRONMENTS), False
    while not over:
        missing = places - observations[:, [0, 2]]
        there = np.linalg.norm(missing, axis=1) < 1e-3
        actions = np.stack([missing[:, 0] / 0.004, np.where(there, -1.0, 1.0), missing[:, 1] / 0.004], axis=1)
        observations, rewards, terminated, truncated, infos = environments.step(actions.clip(-1, 1).astype(np.float32))
        returns += rewards
        over = np.all(terminated | truncated)
    return returns, infos


# %% A Gaussian over places: sample, keep the best, fit again. The first one covers the block.
start = time.perf_counter()
mean, spread = np.zeros(2), np.full(2, 0.018)
for generation in range(GENERATIONS):
    places = np.clip(random.normal(mean, spread, (ENVIRONMENTS, 2)), pliant.gym.LOW[[0, 2]], pliant.gym.HIGH[[0, 2]])
    returns, infos = fly_and_press(places)
    elite = places[np.argsort(-returns)[:ELITE]]
    mean, spread = elite.mean(axis=0), elite.std(axis=0) + 0.0005
    print(f"generation {generation}: largest force {returns.max():.3f} N, median {np.median(returns):.3f} N; at {np.round(1e3 * mean, 1)} mm")
truth = infos["inclusion"][0]
distance = np.linalg.norm(mean - truth)
print(f"found ({1e3 * mean[0]:.1f}, {1e3 * mean[1]:.1f}) mm, the inclusion is at ({1e3 * truth[0]:.1f}, {1e3 * truth[1]:.1f}) mm: "
      f"{1e3 * distance:.1f} mm apart, after {GENERATIONS * ENVIRONMENTS} episodes in {time.perf_counter() - start:.1f} s")
environments.close()
