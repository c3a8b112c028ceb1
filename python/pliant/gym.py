"""Environments of Gymnasium: pip install "pliant[gym]". Importing this module registers "Pliant/Palpation-v0" and "Pliant/Retraction-v0".

Retraction: a layer of tissue is pulled and cut off its bed (RetractionEnv).
Palpation: a ball at the end of a probe feels its way over a block of tissue with a stiff inclusion below its surface, at another place in each episode.
"""
import numpy as np

try:
    import gymnasium
    from gymnasium.utils import seeding
    from gymnasium.vector.utils import batch_space
except ImportError:
    raise ImportError('pliant.gym needs gymnasium: pip install "pliant[gym]", or pip install gymnasium') from None

from pliant import Batch
from pliant._retraction import RetractionEnv  # registers itself, too

__all__ = ["PalpationEnv", "PalpationVectorEnv", "RetractionEnv", "make_vec"]

ID = "Pliant/Palpation-v0"
SIZE = (0.075, 0.03, 0.075)  # of the block [m]; its top is the plane y = 0, its bottom is held
RADIUS = 0.006  # of the ball [m]
CLEARANCE = 0.002  # between ball and tissue where it begins, and the most that it is lifted [m]
DEPTH = 0.004  # the deepest that it presses [m]
MOTION = np.array([0.004, 0.0015, 0.004])  # the largest in one step of the environment, along each axis [m]
SECONDS = 0.02  # that one step of the environment takes [s]
MARGIN = 0.009  # from the sides of the block, where the ball does not go [m]
LOW = np.array([MARGIN - SIZE[0] / 2, RADIUS - DEPTH, MARGIN - SIZE[2] / 2])  # of the ball's centre
HIGH = np.array([SIZE[0] / 2 - MARGIN, RADIUS + CLEARANCE, SIZE[2] / 2 - MARGIN])
OBSERVED = (np.array([*LOW, *3 * [-100], 0], np.float32), np.array([*HIGH, *3 * [100], RADIUS], np.float32))  # bounds of an observation


def block():
    """The surface of the block: vertices and triangles."""
    x, y, z = SIZE[0] / 2, SIZE[1], SIZE[2] / 2
    vertices = np.array([[a, b, c] for c in (-z, z) for b in (-y, 0) for a in (-x, x)])
    triangles = np.array([[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4],
                          [2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]])
    return vertices, triangles


def scene(inclusion, start, young=4000.0, ratio=10.0, spacing=0.0075):
    """A scene with the inclusion at (x, z) and the ball at `start`; the inclusion's modulus is `ratio` times that of the block [Pa]."""
    def material(modulus):
        return {"law": "neo-hookean", "young": modulus, "poisson": 0.4, "density": 1000, "damping": 60}

    sphere = [[float(inclusion[0]), -0.0085, float(inclusion[1])], 0.009]
    return {"format": "pliant-scene/1", "name": "A ball palpates a block with a stiff inclusion",
            "bodies": [{"name": "tissue", "surface": "memory:0", "lattice": {"spacing": spacing}, "element": "hex8", "material": material(young),
                        "inclusions": [{"sphere": sphere, "material": material(young * ratio)}],
                        "fixed": [{"plane": [[0, 1e-4 - SIZE[1], 0], [0, -1, 0]]}]}],
            "tools": [{"name": "probe", "shape": {"sphere": RADIUS}, "path": [[0, *map(float, start)]]}]}


class _Episodes:
    """The episodes of n probes, each with its own tissue and its own random numbers."""

    def __init__(self, n, steps, threads, **tissue):
        if not isinstance(steps, int) or steps < 1:
            raise ValueError(f"steps is a whole number from 1 on, not {steps!r}")
        self.steps, self.tissue, self.batch, self.threads = steps, tissue, None, threads
        self.random = [None] * n
        self.inclusions, self.targets = np.zeros((n, 2)), np.zeros((n, 3))
        self.begun = [None] * n  # (inclusion, start) of the World that is there
        self.best, self.best_places = np.zeros(n), np.zeros((n, 2))  # the largest force that was felt, and where
        self.taken = np.zeros(n, dtype=np.int64)

    @staticmethod
    def spaces():
        return gymnasium.spaces.Box(*OBSERVED, dtype=np.float32), gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)

    def begin(self, members):
        """Another place of the inclusion and of the ball for each, from its random numbers."""
        if len(members) == 0:
            return
        for i in members:
            self.inclusions[i] = self.random[i].uniform(LOW[[0, 2]] + 0.004, HIGH[[0, 2]] - 0.004)
            self.targets[i] = self.random[i].uniform(LOW, HIGH)
            self.targets[i, 1] = HIGH[1]
        places = [(*self.inclusions[i], *self.targets[i]) for i in members]
        if self.batch is None:
            self.batch = self._first(dict(zip(members, places)))
        else:
            same = [i for i, place in zip(members, places) if self.begun[i] == place]
            self.batch.reset(np.array(same, dtype=int))  # takes a fraction of the time that a World takes to be made
            others = [(i, place) for i, place in zip(members, places) if self.begun[i] != place]
            self.batch.replace(np.array([i for i, _ in others], dtype=int), [self._scene(place) for _, place in others])
        for i, place in zip(members, places):
            self.begun[i] = place
        self.best[members], self.taken[members] = 0, 0
        self.best_places[members] = self.targets[members][:, [0, 2]]

    def _scene(self, place):
        return scene(place[:2], place[2:], **self.tissue)

    def _first(self, places):
        n = len(self.random)
        batch = Batch(self._scene(places[0]), n, threads=self.threads, surfaces=[block()])
        batch.replace(np.arange(1, n), [self._scene(places[i]) for i in range(1, n)])
        return batch

    def move(self, members, actions):
        """One step of those members: rewards [n], whether the episode is over because the tissue diverged, and because of its length."""
        n = len(self.random)
        moving = np.zeros(n, dtype=bool)
        moving[members] = True
        moves = np.nan_to_num(np.clip(np.asarray(actions, dtype=np.float64).reshape(n, 3), -1, 1)) * MOTION
        self.targets[moving] = np.clip(self.targets[moving] + moves[moving], LOW, HIGH)
        self.batch.drive_tool("probe", self.targets, seconds=SECONDS)
        self.batch.advance(SECONDS)
        self.taken[moving] += 1
        states = self.batch.tool_states("probe")
        failed = self.batch.failed & moving
        gained = np.where(moving & ~failed, states.force[:, 1] - self.best, 0.0).clip(min=0)
        self.best += gained
        self.best_places[gained > 0] = states.position[gained > 0][:, [0, 2]]
        return gained, failed, moving & ~failed & (self.taken >= self.steps)

    def observations(self):
        states = self.batch.tool_states("probe")
        return np.clip(np.column_stack([states.position, states.force, states.penetration]).astype(np.float32), *OBSERVED)

    def infos(self):
        """Of all members: the truth, and what was found."""
        distance = np.linalg.norm(self.best_places - self.inclusions, axis=1)
        return {"inclusion": self.inclusions.copy(), "best_force": self.best.copy(), "best_place": self.best_places.copy(), "distance": distance}

    def close(self):
        if self.batch is not None:
            self.batch.close()
            self.batch = None


class PalpationEnv(gymnasium.Env):
    """Finds a stiff place by touch.

    Action: a motion of the ball along x, y and z, each from -1 to 1 in units of 4, 1.5 and 4 mm; y points out of the tissue.
    Observation: the ball's centre [m], the force on it [N] and how deep tissue penetrates it, a measure of numerical error [m]: float32, shape [7],
    cut off at 100 N and at the ball's radius.
    Reward: by how much the largest force (along y) of the episode has grown [N]. The ball is kept from going deeper than 4 mm,
    so the sum is large only where the tissue is stiff.
    An episode is truncated after `steps` steps; it is terminated only if the tissue diverges. info: "inclusion", the true place (x, z);
    "best_place", where the largest force was; "best_force"; and the "distance" between the places.
    Other arguments are those of scene().
    """

    metadata = {"render_modes": []}
    render_mode = None

    def __init__(self, steps=40, **tissue):
        self.episodes = _Episodes(1, steps, 1, **tissue)
        self.observation_space, self.action_space = _Episodes.spaces()

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.episodes.random[0] = self.np_random
        self.episodes.begin([0])
        return self.episodes.observations()[0], self._info()

    def step(self, action):
        if self.episodes.batch is None:
            raise gymnasium.error.ResetNeeded("call reset before step")
        if np.shape(action) != (3,):
            raise ValueError(f"an action has the shape [3], not {list(np.shape(action))}")
        gained, terminated, truncated = self.episodes.move([0], action)
        return self.episodes.observations()[0], float(gained[0]), bool(terminated[0]), bool(truncated[0]), self._info()

    def _info(self):
        return {key: value[0] for key, value in self.episodes.infos().items()}

    def close(self):
        self.episodes.close()


class PalpationVectorEnv(gymnasium.vector.VectorEnv):
    """num_envs of PalpationEnv on one Batch; each has the bits of a PalpationEnv with its seed.

    After an episode the next step begins another one and ignores the action (autoreset mode NEXT_STEP). threads: as Batch takes it.
    reset(options={"reset_mask": booleans}) begins only some.
    """

    metadata = {"render_modes": [], "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}
    render_mode = None

    def __init__(self, num_envs=1, steps=40, threads=None, **tissue):
        self.num_envs = num_envs
        self.episodes = _Episodes(num_envs, steps, threads, **tissue)
        self.single_observation_space, self.single_action_space = _Episodes.spaces()
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.over = np.zeros(num_envs, dtype=bool)

    def reset(self, *, seed=None, options=None):
        n = self.num_envs
        seeds = [None] * n if seed is None else [seed + i for i in range(n)] if isinstance(seed, (int, np.integer)) else list(seed)
        if len(seeds) != n:
            raise ValueError(f"{len(seeds)} seeds for {n} environments")
        mask = np.asarray((options or {}).get("reset_mask", np.ones(n)), dtype=bool)
        if mask.shape != (n,) or not (mask.all() or self.episodes.batch):
            raise ValueError(f"reset_mask is {n} booleans, all true at the first reset")
        for i in np.flatnonzero(mask):
            if seeds[i] is not None or self.episodes.random[i] is None:
                self.episodes.random[i] = seeding.np_random(None if seeds[i] is None else int(seeds[i]))[0]
        self.episodes.begin(np.flatnonzero(mask).tolist())
        self.over[mask] = False
        return self.episodes.observations(), self._info()

    def step(self, actions):
        if self.episodes.batch is None:
            raise gymnasium.error.ResetNeeded("call reset before step")
        if np.shape(actions) != (self.num_envs, 3):
            raise ValueError(f"actions have the shape {[self.num_envs, 3]}, not {list(np.shape(actions))}")
        begin, go_on = np.flatnonzero(self.over).tolist(), np.flatnonzero(~self.over)
        gained, terminated, truncated = self.episodes.move(go_on, actions)
        self.episodes.begin(begin)
        self.over = terminated | truncated
        return self.episodes.observations(), gained, terminated, truncated, self._info()

    def _info(self):
        everywhere = np.ones(self.num_envs, dtype=bool)  # Gymnasium marks which members have an entry
        return {name: entry for key, value in self.episodes.infos().items() for name, entry in ((key, value), ("_" + key, everywhere))}

    def close_extras(self, **_):
        self.episodes.close()


def make_vec(n, **options):
    """The same as gymnasium.make_vec("Pliant/Palpation-v0", n)."""
    return gymnasium.make_vec(ID, num_envs=n, vectorization_mode="vector_entry_point", **options)


if ID not in gymnasium.registry:
    gymnasium.register(ID, entry_point="pliant.gym:PalpationEnv", vector_entry_point="pliant.gym:PalpationVectorEnv")
