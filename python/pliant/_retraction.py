"""Retraction and cut as an environment of Gymnasium, "Pliant/Retraction-v0"; pliant.gym registers it.

A layer of tissue is to be cut off the layer below it, along a seam: one hand holds its edge and pulls, the other draws a blade along the seam,
which moves as the tissue gives way.
"""
import gymnasium
import numpy as np

from pliant import World

ID = "Pliant/Retraction-v0"
SIZE = (0.06, 0.024, 0.03)  # of the block [m]: x along the seam, y from its foot up, z across
SPACING = 0.006  # of the lattice [m]
BED = 0.015  # thickness of what stays [m]; y = 0 is on it
SEAM = 0.0015  # most that the seam lies above or below y = 0 [m]
STIFFNESS = (3000.0, 8000.0)  # Young's modulus is drawn between these [Pa]
PULL = 0.002  # most that the hand moves along an axis in one step of the environment [m]
ADVANCE = np.array([0.0025, 0.0015])  # most that the blade moves along x and y [m]
SECONDS = 0.02  # that one step of the environment takes [s]
START = 0.005  # most that the blade begins above or below the seam [m]
NEAR = 0.003  # a cut this near the seam, at rest, is on it [m]
GENTLE = 0.25  # force of the hand that tissue bears [N]
VIEW = (0.008, 2.5)  # the blade works as deep as the layer stands open: so far [m], and by so much further for each metre that its edge is lifted
STATIONS = np.linspace(-SIZE[0] / 2, SIZE[0] / 2, 6)  # where the seam is seen [m]
HAND = (np.array([-SIZE[0] / 2 - 0.02, -BED]), np.array([SIZE[0] / 2 + 0.02, 0.06]))  # where the hand and the blade may be, x and y [m]


def surface():
    """The block: vertices and triangles, a grid of cells on each side so that there is an edge to grasp."""
    vertices, triangles = [], []
    low, size = np.array([-SIZE[0] / 2, -BED, -SIZE[2] / 2]), np.array(SIZE)
    counts = np.round(size / SPACING).astype(int)
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            first = len(vertices)
            for i in range(counts[u] + 1):
                for j in range(counts[v] + 1):
                    place = np.zeros(3)
                    place[axis], place[u], place[v] = side, i / counts[u], j / counts[v]
                    vertices.append(low + place * size)
            for i in range(counts[u]):
                for j in range(counts[v]):
                    a = first + i * (counts[v] + 1) + j
                    quad = [a, a + counts[v] + 1, a + counts[v] + 2, a + 1]
                    quad = quad if side else quad[::-1]
                    triangles += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    return np.array(vertices), np.array(triangles)


def scene():
    return {"format": "pliant-scene/1", "name": "A layer of tissue is pulled and cut off the layer below it",
            "bodies": [{"name": "tissue", "surface": "memory:0", "lattice": {"spacing": SPACING}, "element": "hex8",
                        "material": {"law": "neo-hookean", "young": STIFFNESS[0], "poisson": 0.4, "density": 1000, "damping": 60},
                        "fixed": [{"plane": [[0, 1e-4 - BED, 0], [0, -1, 0]]}]}]}


class RetractionEnv(gymnasium.Env):
    """Cuts a layer of tissue off its bed, along the seam and without pulling too hard.

    Action: motions of the hand along x and y (2 mm) and of the blade along x and y (2.5 and 1.5 mm), each from -1 to 1. The hand holds the
    middle of the layer's front edge; the blade is a line across the tissue that begins in front of it, and goes 8 mm deep, and 2.5 mm further for each
    millimetre that the edge is lifted: nobody cuts where nothing is seen.
    Observation: places (x, y) of the hand's target, of the edge that it holds and of the blade [m], the force of the hand along x and y [N], the share
    of the seam that is cut, and the places of the seam at six stations from front to back, as the tissue has moved [m]: float32, shape [21].
    Reward: the share of the seam that was cut in this step, less twice the area that was cut elsewhere (as a share of the seam), less 0.05 for each newton
    above 0.25 N of the hand; 1 more when the layer comes off, which ends the episode. It is truncated after `steps` steps, and terminated where the
    tissue diverges. info: "cut" and "astray" (shares), "force" [N], "off", "seam" (its height at rest [m]), "young" [Pa].
    Each episode has another modulus (3 to 8 kPa), height of the seam (1.5 mm to either side) and first height of the blade (5 mm to either side of it).
    """

    metadata = {"render_modes": []}
    render_mode = None

    def __init__(self, steps=60):
        if not isinstance(steps, int) or steps < 1:
            raise ValueError(f"steps is a whole number from 1 on, not {steps!r}")
        self.steps, self.world = steps, None
        low = np.concatenate([HAND[0], HAND[0] - 0.1, HAND[0], [-10, -10, 0], np.tile(HAND[0] - 0.1, len(STATIONS))])
        high = np.concatenate([HAND[1], HAND[1] + 0.1, HAND[1], [10, 10, 1], np.tile(HAND[1] + 0.1, len(STATIONS))])
        self.observation_space = gymnasium.spaces.Box(low.astype(np.float32), high.astype(np.float32), dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (4,), np.float32)

    # --- one episode -----------------------------------------------------------------------------------------------------------
    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        if self.world is None:
            self.world = World(scene(), [surface()], backend="cpu", normals=False, interactive=True, cutting=True)
            rest = self.world.rest_positions()
            self.seam_nodes = np.array([[np.argmin(np.linalg.norm(rest - [x, y, SIZE[2] / 2], axis=1)) for y in (-SPACING / 2, SPACING / 2)]
                                        for x in STATIONS])
            self.seam_rest = rest[self.seam_nodes][:, :, :2]
        else:
            self.world.reset()
        self.young, self.seam, start = (float(self.np_random.uniform(*bounds)) for bounds in (STIFFNESS, (-SEAM, SEAM), (-START, START)))
        self.world.change(material={"young": self.young})
        frame = self.world.frame()
        edge = [-SIZE[0] / 2, SIZE[1] - BED, 0]
        self.edge = int(np.linalg.norm(frame.positions - edge, axis=1).argmin())
        self.hand, self.blade = frame.positions[self.edge].astype(np.float64), np.array([-SIZE[0] / 2 - 0.01, self.seam + start])
        self.grab = self.world.grab(self.edge, radius=0.009, max_force=4)
        self._sweep()  # the first call puts the blade there
        self.taken, self.cut, self.astray, self.off, self.force = 0, 0.0, 0.0, False, np.zeros(3)
        return self._observation(), self._info()

    def step(self, action):
        if self.world is None:
            raise gymnasium.error.ResetNeeded("call reset before step")
        if np.shape(action) != (4,):
            raise ValueError(f"an action has the shape [4], not {list(np.shape(action))}")
        moves = np.nan_to_num(np.clip(np.asarray(action, dtype=np.float64), -1, 1))
        self.hand[:2] = np.clip(self.hand[:2] + PULL * moves[:2], *HAND)
        deepest = max(self.blade[0], VIEW[0] - SIZE[0] / 2 + VIEW[1] * self._lifted())
        self.blade = np.clip(self.blade + ADVANCE * moves[2:], HAND[0], [min(HAND[1][0], deepest), HAND[1][1]])
        self.world.move_grab(self.grab, self.hand)
        self._sweep()
        failed = self.world.advance(SECONDS).diverged
        self.taken += 1
        self.force = self.world.grab_state(self.grab)["force"]
        before = self.cut, self.astray
        self._measure()
        too_much = max(0.0, float(np.linalg.norm(self.force)) - GENTLE)
        reward = self.cut - before[0] - 2 * (self.astray - before[1]) - 0.05 * too_much + (1.0 if self.off else 0.0)
        return self._observation(), reward, bool(failed or self.off), bool(self.taken >= self.steps and not failed and not self.off), self._info()

    def _lifted(self):
        return float(self.world.frame().positions[self.edge, 1]) - (SIZE[1] - BED)

    def _sweep(self):
        x, y = self.blade
        self.world.move_blade("scalpel", [x, y, -SIZE[2]], [x, y, SIZE[2]])

    def _measure(self):
        """Areas of the cut at rest, on the seam and elsewhere, as shares of the seam; whether the layer has come off."""
        frame = self.world.frame()
        if frame.cut_faces.size == 0:
            return
        a, b, c = (np.asarray(frame.rest, np.float64)[frame.triangles[frame.cut_faces == 1, k]] for k in range(3))
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 4  # of both faces of a cut the half
        on_seam = np.abs((a + b + c)[:, 1] / 3 - self.seam) < NEAR
        whole = SIZE[0] * SIZE[2]
        self.cut, self.astray = float(areas[on_seam].sum()) / whole, float(areas[~on_seam].sum()) / whole
        self.off = self.world.pieces() > 1 and self.cut > 0.9

    def _observation(self):
        seen = self.seam_rest + self.world.displacements()[self.seam_nodes][:, :, :2]
        share = self.seam / SPACING + 0.5
        seam = (1 - share) * seen[:, 0] + share * seen[:, 1]
        numbers = np.concatenate([self.hand[:2], self.world.frame().positions[self.edge, :2], self.blade, self.force[:2], [self.cut], seam.ravel()])
        return np.clip(numbers.astype(np.float32), self.observation_space.low, self.observation_space.high)

    def _info(self):
        return {"cut": self.cut, "astray": self.astray, "force": float(np.linalg.norm(self.force)), "off": self.off, "seam": self.seam, "young": self.young}

    def close(self):
        self.world = None


if ID not in gymnasium.registry:
    gymnasium.register(ID, entry_point="pliant._retraction:RetractionEnv")
