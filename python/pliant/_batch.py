"""Many Worlds of one scene, stepped together over the cores: see "Many worlds" in docs/embedding.md."""
import collections
import contextlib
import os
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from pliant._core import Error, World

_USAGE, _STATE = 5, 8
_FAILURES = (1, 4, 7)  # what happens to a member: internal, diverged, device; other codes are mistakes of the caller
_CHANGE_KEYS = ("body", "inclusion", "gravity", "material", "model", "fixed")  # of an entry of `changes`; all others belong to a material


class ToolStates(NamedTuple):
    """What one tool of each member feels, and where it is."""

    force: np.ndarray  # [N], shape [n, 3]
    torque: np.ndarray  # [N m], shape [n, 3]
    area: np.ndarray  # [m^2], shape [n]
    penetration: np.ndarray  # [m], shape [n]
    position: np.ndarray  # [m], shape [n, 3]
    turn: np.ndarray  # quaternion x y z w, shape [n, 4]


def _error(text, code=_USAGE):
    error = Error(text)
    error.code = code
    return error


def _whole(value, name, least):
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and value >= least:
        return int(value)
    raise _error(f"{name} is a whole number from {least} on, not {value!r}")


def _numbers(given, name, *shapes):
    """`given` as an array of float64 of one of the shapes."""
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        array = None
    if array is None or array.shape not in shapes:
        got = "something else" if array is None else str(list(array.shape))
        raise _error(f"{name}: allowed are numbers of the shape {' or '.join(str(list(s)) for s in shapes)}, not {got}")
    return array


def _rows_to_use(rows, name):
    """Which rows have numbers; rows of NaN leave a member alone, and a row that is NaN in part is a mistake."""
    missing = np.isnan(rows)
    partly = missing.any(axis=1) & ~missing.all(axis=1)
    if partly.any():
        raise _error(f"{name}[{partly.argmax()}] is NaN in part: a row of NaN leaves its member alone")
    return ~missing.any(axis=1)


@contextlib.contextmanager
def _one_core():
    """A World made (or made anew) in here steps with the calling thread alone: the reference takes as many threads as it may use cores.

    A batch has its own threads, and a thousand Worlds with threads of their own would be in each other's way.
    """
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    cores = os.sched_getaffinity(0)  # of the calling thread
    pick = sorted(cores)[threading.get_ident() // 64 % len(cores)]
    os.sched_setaffinity(0, {pick})
    try:
        yield
    finally:
        os.sched_setaffinity(0, cores)


def _varied(vary, n):
    """For each member the list of its changes, dicts of keywords of World.change."""
    if vary is None:
        return [[] for _ in range(n)]
    if callable(vary):
        each = [vary(i) for i in range(n)]
    elif isinstance(vary, dict):
        each = _from_arrays(vary, n)
    else:
        each = list(vary)
        if len(each) != n:
            raise _error(f"vary has {len(each)} entries for {n} members")
    changes = [[c] if isinstance(c, dict) else [] if c is None else list(c) for c in each]
    for i, list_of_member in enumerate(changes):
        for c in list_of_member:
            if not isinstance(c, dict):
                raise _error(f"vary of member {i}: a change is a dict of the keywords of World.change, not {c!r}")
    return changes


def _from_arrays(vary, n):
    """{"body": "liver", "young": array of n} as changes; `gravity` has the shape [n, 3]."""
    changes = [{} for _ in range(n)]
    for key, given in vary.items():
        if key in ("body", "inclusion") and np.ndim(given) == 0:
            rows = [given] * n
        elif key == "gravity":
            rows = _numbers(given, f"vary[{key!r}]", (n, 3)).tolist()
        elif key in _CHANGE_KEYS:
            raise _error(f"vary[{key!r}]: with arrays, vary has 'body', 'inclusion', 'gravity' and keys of a material; use a function for others")
        else:
            rows = _numbers(given, f"vary[{key!r}]", (n,)).tolist()
        for change, row in zip(changes, rows):
            if key in _CHANGE_KEYS:
                change[key] = row
            else:
                change.setdefault("material", {})[key] = row
    return changes


class Batch:
    """n Worlds of a scene. Every member has the bits of a World that does the same alone, whatever n and the number of threads.

    scene: a file or a dict, as World takes it. vary: what differs from member to member, applied at the start and after each reset: a function of
    the member's number that gives a dict of keywords of World.change or a list of them, a sequence of n such, or a dict of arrays with n rows such
    as {"young": [1000, 2000, 4000]}. threads: as many as the process may use cores, if None. The other arguments are World's.

    A member that diverges is left at its last good state: `failed` and `errors` say so, and no call moves it until it is reset.
    """

    def __init__(self, scene, n, *, vary=None, backend="cpu", threads=None, surfaces=(), folder="", dt=0.0, normals=False, interactive=False,
                 cutting=False):
        n = _whole(n, "n", 1)
        if threads is None:
            threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        self.threads = _whole(threads, "threads", 1)
        self._options = {"surfaces": list(surfaces), "folder": folder, "backend": backend, "dt": dt, "normals": normals, "interactive": interactive,
                         "cutting": cutting}
        self._changes = _varied(vary, n)
        self._worlds = [None] * n
        self._failed = np.zeros(n, dtype=bool)
        self.errors = [""] * n  # the message of a member that failed
        self._pool = ThreadPoolExecutor(self.threads - 1, "pliant-batch") if self.threads > 1 else None
        try:
            self._do(lambda i: self._make(i, scene), range(n), stop_at_errors=True)
        except BaseException:
            self.close()
            raise

    # --- members ---------------------------------------------------------------------------------------------------------------
    def __len__(self):
        return len(self._worlds)

    def __getitem__(self, member):
        return self._worlds[member]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Lets the Worlds and the threads go; the batch has no members then."""
        self._worlds = []
        if self._pool:
            self._pool.shutdown()
            self._pool = None

    @property
    def failed(self):
        """Whether each member has diverged or its device was lost: bool, shape [n], a copy."""
        return self._failed.copy()

    @property
    def times(self):
        """[s], shape [n]"""
        return np.array([w.time for w in self._open()])

    def _open(self):
        if not self._worlds:
            raise _error("the batch is closed", _STATE)
        return self._worlds

    def _members(self, members):
        n = len(self._open())
        if members is None:
            return list(range(n))
        given = np.atleast_1d(np.asarray(members))
        if given.dtype == bool and given.shape == (n,):
            given = np.flatnonzero(given)
        if given.size == 0:
            return []
        if given.ndim != 1 or given.dtype.kind not in "iu" or given.min() < -n or given.max() >= n:
            raise _error(f"members are numbers from 0 to {n - 1} or {n} booleans, not {members!r}")
        return list(dict.fromkeys((given % n).tolist()))  # each once: no two threads may be at one World

    # --- threads ---------------------------------------------------------------------------------------------------------------
    def _do(self, work, members, stop_at_errors=False):
        """work(member) for each, over the threads; afterwards the first member's error is raised, the others being done."""
        left, errors = collections.deque(members), {}

        def serve():
            with contextlib.suppress(IndexError):
                while True:
                    member = left.popleft()
                    try:
                        work(member)
                    except Exception as error:
                        errors[member] = error
                        if stop_at_errors:
                            left.clear()

        helpers = [self._pool.submit(serve) for _ in range(min(self.threads, len(left)) - 1)]
        try:
            serve()
        finally:
            left.clear()  # where Control-C has ended this thread's part
            for helper in helpers:
                helper.result()
        if errors:
            member = min(errors)
            if isinstance(errors[member], Error):
                raise _error(f"member {member}: {errors[member]}", errors[member].code) from errors[member]
            raise errors[member]

    def _make(self, member, scene):
        with _one_core():
            self._worlds[member] = World(scene, **self._options)
        self._vary(member)

    def _vary(self, member):
        for change in self._changes[member]:
            with _one_core():
                self._worlds[member].change(**change)
        self._failed[member], self.errors[member] = False, ""

    def _move(self, call):
        """call(World) moves each member that has not failed; what happens to it is noted and stops no other."""

        def move(member):
            try:
                report = call(self._worlds[member])
                message = (report.message or "it has diverged") if report.diverged else ""
            except Error as error:
                if error.code not in _FAILURES:
                    raise
                message = str(error)
            if message:
                self._failed[member], self.errors[member] = True, message

        self._do(move, self._alive(self._members(None)))

    def _alive(self, members):
        return [i for i in members if not self._failed[i]]

    # --- what Worlds do --------------------------------------------------------------------------------------------------------
    def step(self, steps=1):
        """That many steps of each member."""
        steps = _whole(steps, "steps", 0)
        self._move(lambda world: world.step(steps))

    def advance(self, seconds):
        """As many steps of each member as fit: all then show the same time, whatever their steps are."""
        seconds = float(_numbers(seconds, "seconds", ()))
        if not 0 <= seconds < np.inf:
            raise _error(f"seconds is a finite number from 0 on, not {seconds}")
        self._move(lambda world: world.advance(seconds))

    def drive_tool(self, name, positions, turns=None, seconds=1 / 60):
        """A tool of each member moves there: positions [n, 3] [m], turns [n, 4], quaternions x y z w. A row of NaN leaves its member alone."""
        n = len(self._open())
        positions = _numbers(positions, "positions", (n, 3))
        used = _rows_to_use(positions, "positions")
        turns = np.tile([0.0, 0, 0, 1], (n, 1)) if turns is None else _numbers(turns, "turns", (n, 4))
        used &= _rows_to_use(turns, "turns")
        self._do(lambda i: self._worlds[i].drive_tool(name, positions[i], turns[i], seconds), self._alive(np.flatnonzero(used).tolist()))

    def tool_states(self, name):
        """What a tool of each member feels, and where it is: ToolStates, a tuple of arrays with names."""
        rows = []
        for member, world in enumerate(self._open()):
            tools = world.tool_forces()
            if name not in tools:
                raise _error(f"member {member} has no tool {name!r}; it has {', '.join(map(repr, tools)) or 'none'}")
            rows.append([tools[name][field] for field in ToolStates._fields])
        return ToolStates(*(np.array(column) for column in zip(*rows)))

    def tool_forces(self, name):
        """[N], shape [n, 3]; torque, penetration and more are in tool_states."""
        return self.tool_states(name).force

    def positions(self, out=None):
        """Of all vertices of the surface [m]: float32, shape [n, vertices, 3]. out: an array of that kind to be filled in."""
        vertices = {w.info["vertices"] for w in self._open()} if out is None else {np.shape(out)[1] if np.ndim(out) == 3 else -1}
        if out is None:
            out = np.empty((len(self._worlds), max(vertices), 3), np.float32)
        if not isinstance(out, np.ndarray) or out.dtype != np.float32 or out.ndim != 3 or out.shape[0] != len(self._worlds) or out.shape[2] != 3:
            raise _error(f"out is an array of float32 of the shape [{len(self._worlds)}, vertices, 3]")

        def fill(member):
            now = self._worlds[member].frame().positions
            if now.shape != out.shape[1:]:
                raise _error(f"it has {len(now)} vertices, not {out.shape[1]}; members that were cut are read one by one, batch[i].frame()")
            out[member] = now

        self._do(fill, range(len(self._worlds)))
        return out

    def vertices(self, ids):
        """Positions of a few vertices [m]: float32, shape [n, len(ids), 3]."""
        ids = np.asarray(ids)
        if ids.ndim != 1 or ids.dtype.kind not in "iu":
            raise _error("ids is a list of vertex numbers")
        out = np.empty((len(self._open()), len(ids), 3), np.float32)

        def fill(member):
            now = self._worlds[member].frame().positions
            if len(ids) and (ids.min() < 0 or ids.max() >= len(now)):
                raise _error(f"vertices are numbered from 0 to {len(now) - 1}")
            out[member] = now[ids]

        self._do(fill, range(len(self._worlds)))
        return out

    def hashes(self):
        """World.hash of each member: a list of ints."""
        return [w.hash() for w in self._open()]

    def reset(self, members=None, vary=None):
        """Back to the start of the scene, with the changes of `vary`, those of the constructor if None. members: numbers or n booleans; None: all.

        What `change` has changed since is as in the scene again.
        """
        members = self._members(members)
        if vary is not None:
            changes = _varied(vary, len(self._worlds))
            for i in members:
                self._changes[i] = changes[i]

        def reset(member):
            with _one_core():  # a device that was lost is opened anew
                self._worlds[member].reset()
            self._vary(member)

        self._do(reset, members)

    def replace(self, members, scenes):
        """Makes members anew from other scenes, one for each; the other arguments are those of the constructor."""
        members, scenes = self._members(members), list(scenes)
        if len(scenes) != len(members):
            raise _error(f"{len(scenes)} scenes for {len(members)} members")
        by_member = dict(zip(members, scenes))
        self._do(lambda i: self._make(i, by_member[i]), members)

    def change(self, members=None, **change):
        """World.change of some members, or of all: batch.change(3, material={"young": 2000}). It holds until the next reset."""

        def apply(member):
            with _one_core():
                self._worlds[member].change(**change)

        self._do(apply, self._alive(self._members(members)))
