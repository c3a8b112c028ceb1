"""Many Worlds at once, pliant.Batch: the bits of single Worlds, failures, arguments; and the environments, where gymnasium is installed."""
import importlib.util
import inspect
import os
import runpy
import subprocess
import sys

from common import SOURCE, box  # first: exits where NumPy is missing
import numpy as np
import pliant

VERTICES, TRIANGLES = box(0.06, 0.04, 0.06)
CORES = os.sched_getaffinity(0)
SURFACES = [(VERTICES, TRIANGLES)]
SCENE = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0],
         "bodies": [{"name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02}, "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}],
                     "material": {"young": 3000, "poisson": 0.4, "damping": 20}}],
         "tools": [{"name": "ball", "shape": {"sphere": 0.01}, "path": [[0, 0.03, 0.051, 0.03]]}]}
YOUNG = [2000.0, 3000, 4500, 6000, 8000, 12000, 20000]


def batch(n, **options):
    return pliant.Batch(SCENE, n, surfaces=SURFACES, **options)


def error_of(call, code=5):
    try:
        call()
    except pliant.Error as error:
        assert error.code == code and "\n" not in str(error), (error.code, error)
        return str(error)
    raise AssertionError("no pliant.Error")


def place(i):
    return [0.03 + 0.002 * i, 0.047, 0.03]


def alone(i):
    """What the batch of the next test does to its member i, with a World."""
    world = pliant.World(SCENE, surfaces=SURFACES, backend="cpu", normals=False)
    world.change(material={"young": YOUNG[i]})
    world.step(30)
    world.drive_tool("ball", place(i), seconds=0.05)
    world.advance(0.1)
    if i == 1:
        world.change(gravity=[0, 0, 0])
    world.step(20)
    return world


def test_bits_of_single_worlds():
    singles = [alone(i) for i in range(7)]
    hashes = [w.hash() for w in singles]
    assert len(set(hashes)) == 7, "members differ"
    for n in (1, 2, 7):
        for threads in (1, 2, 4):
            with batch(n, threads=threads, vary={"young": YOUNG[:n]}) as b:
                for _ in range(2):  # the second time after a reset, which brings vary back
                    b.step(30)
                    b.drive_tool("ball", [place(i) for i in range(n)], seconds=0.05)
                    b.advance(0.1)
                    if n > 1:
                        b.change(1, gravity=[0, 0, 0])
                    b.step(20)
                    assert b.hashes() == hashes[:n], (n, threads)
                    assert np.array_equal(b.tool_forces("ball"), [w.tool_forces()["ball"]["force"] for w in singles[:n]])
                    b.reset()


def test_what_varies():
    def softer(i):
        return [{"material": {"young": YOUNG[i]}}, {"gravity": [0, -1.0 - i, 0]}]

    with batch(3, threads=2, vary=softer) as a, batch(3, threads=1, vary=[softer(i) for i in range(3)]) as b, \
            batch(3, threads=1, vary={"young": YOUNG[:3], "gravity": [[0, -1, 0], [0, -2, 0], [0, -3, 0]]}) as c, batch(1) as plain:
        for each in (a, b, c, plain):
            each.step(40)
        assert a.hashes() == b.hashes() == c.hashes() and len({*a.hashes(), *plain.hashes()}) == 4
        c.reset([2, 0], vary={"young": YOUNG[3:6]})
        c.step(40)
        for i, young in ((0, YOUNG[3]), (2, YOUNG[5])):
            single = pliant.World(SCENE, surfaces=SURFACES, backend="cpu")
            single.change(material={"young": young})
            single.step(40)
            assert c[i].hash() == single.hash(), "the changes of before are gone"
        assert c[2].step_number == 40 and c[1].step_number == 80, "only those members are at the start again"
        c.reset(1)
        c.step(40)
        assert c[1].hash() == a[1].hash(), "the others vary as before"


def test_arrays():
    with batch(2, threads=2, vary={"young": [2000, 9000]}) as b:
        assert len(b) == 2 and isinstance(b[1], pliant.World) and b.threads == 2
        b.advance(0.05)
        assert np.allclose(b.times, 0.05, atol=max(b[0].dt, b[1].dt))
        x = b.positions()
        assert x.shape == (2, 8, 3) and x.dtype == np.float32
        assert all(np.array_equal(x[i], b[i].frame().positions) for i in range(2)) and not np.array_equal(x[0], x[1])
        out = np.zeros_like(x)
        assert b.positions(out=out) is out and np.array_equal(out, x)
        assert np.array_equal(b.vertices([7, 2]), x[:, [7, 2]]) and b.vertices(np.zeros(0, int)).shape == (2, 0, 3)
        b.drive_tool("ball", [[np.nan] * 3, [0.03, 0.046, 0.03]], seconds=0.02)
        b.advance(0.04)  # the last step of 0.02 s may end before
        states = b.tool_states("ball")
        assert np.array_equal(states.position, [[0.03, 0.051, 0.03], [0.03, 0.046, 0.03]]), "a row of NaN leaves its member alone"
        assert states.force.shape == states.torque.shape == (2, 3) and states.penetration.shape == states.area.shape == (2,)
        assert states.force[0, 1] == 0 < states.force[1, 1] and states.turn.tolist() == [[0, 0, 0, 1]] * 2
        b.drive_tool("ball", states.position, turns=[[0, 1, 0, 0]] * 2, seconds=0.02)
        b.advance(0.04)
        assert np.allclose(b.tool_states("ball").turn, [[0, 1, 0, 0]] * 2)


def test_a_failure_stops_no_other():
    with batch(4, threads=2, dt=0.003, vary={"young": [2000, 3e6, 3000, 3e6]}) as b, batch(4, threads=1, dt=0.003) as calm:
        b.step(300)
        calm.step(300)
        assert b.failed.tolist() == [False, True, False, True] and not calm.failed.any()
        assert "block" in b.errors[1] and b.errors[0] == "" and b[0].step_number == 300 and b[2].hash() == calm[2].hash()
        stands, said = (b[1].step_number, b[1].hash()), b.errors[1]
        b.step(10)
        b.drive_tool("ball", np.tile([0.03, 0.06, 0.03], (4, 1)))
        b.advance(0.01)
        b.drive_tool("bell", [[np.nan] * 3, [0, 1, 0], [np.nan] * 3, [0, 1, 0]])
        b.change([1, 3], material={"young": -1})
        assert (b[1].step_number, b[1].hash()) == stands and b.errors[1] == said and b[0].step_number > 310, "what failed is left alone"
        assert np.isfinite(b.positions()).all()
        b.reset(b.failed, vary={"young": [3000] * 4})
        assert not b.failed.any() and b.errors == [""] * 4
        b.step(300)
        assert b[1].hash() == calm[1].hash() and not b.failed.any()


def test_other_scenes():
    heavy = dict(SCENE, gravity=[0, -20, 0])
    with batch(3, threads=2, vary={"young": YOUNG[:3]}) as b, pliant.Batch(heavy, 3, surfaces=SURFACES, vary={"young": YOUNG[:3]}) as other:
        b.step(5)
        b.replace([1, -1], [heavy, heavy])
        other.step(5)
        assert b[0].step_number == 5 and b[1].step_number == 0
        b.step(5)
        assert b.hashes()[1:] == other.hashes()[1:] and b.hashes()[0] != other.hashes()[0]


def test_a_mistake_while_stepping_is_no_failure():
    class Busy:
        def step(self, steps):
            error = pliant.Error("two threads at once")
            error.code = 8
            raise error

    with batch(3, threads=2) as b:
        b._worlds[1] = Busy()
        assert error_of(lambda: b.step(2), 8) == "member 1: two threads at once"
        assert not b.failed.any() and b[0].step_number == b[2].step_number == 2, "the others have stepped"


def test_wrong_calls():
    assert "n is a whole number from 1 on, not 0" == error_of(lambda: batch(0))
    assert error_of(lambda: batch(2, threads=0)).startswith("threads")
    assert error_of(lambda: batch(2, vary={"young": [1, 2, 3]})) == "vary['young']: allowed are numbers of the shape [2], not [3]"
    assert error_of(lambda: batch(2, vary=[{}])) == "vary has 1 entries for 2 members"
    assert "a dict" in error_of(lambda: batch(2, vary=lambda i: [3]))
    assert "use a function" in error_of(lambda: batch(2, vary={"material": [{}, {}]}))
    assert error_of(lambda: batch(3, threads=2, vary={"young": [1000, -1, -2]}), 2).startswith("member 1: ")
    assert error_of(lambda: pliant.Batch("no/such/scene.json", 3), 6).startswith("member 0: ")
    with batch(2) as b:
        assert error_of(lambda: b.drive_tool("ball", [0, 0, 0])) == "positions: allowed are numbers of the shape [2, 3], not [3]"
        assert error_of(lambda: b.drive_tool("ball", [["a"] * 3] * 2)).endswith("not something else")
        assert "positions[1] is NaN in part" in error_of(lambda: b.drive_tool("ball", [[0, 1, 0], [0, np.nan, 0]]))
        assert error_of(lambda: b.drive_tool("bell", np.ones((2, 3)))).startswith("member 0: ")
        assert error_of(lambda: b.tool_forces("bell")) == "member 0 has no tool 'bell'; it has 'ball'"
        assert "float32" in error_of(lambda: b.positions(out=np.zeros((2, 8, 3))))
        assert "vertices" in error_of(lambda: b.positions(out=np.zeros((2, 9, 3), np.float32)))
        assert "from 0 to 7" in error_of(lambda: b.vertices([8]))
        for wrong in (2, [0.5], [True], "all"):
            assert "members are" in error_of(lambda: b.reset(wrong)), wrong
        assert "0 scenes for 1" in error_of(lambda: b.replace([0], []))
        assert error_of(lambda: b.step(-1)) and error_of(lambda: b.advance(np.nan)) and error_of(lambda: b.step(0.5))
        assert not b.failed.any(), "a mistake of the caller is no failure"
        b.reset([])
    assert error_of(b.step, 8) == "the batch is closed" and len(b) == 0


def test_worlds_need_no_threads_of_their_own():
    with batch(6, threads=2) as b:
        before = len(os.listdir("/proc/self/task"))
        with batch(6, threads=2) as other:
            other.step(2)
            assert len(os.listdir("/proc/self/task")) <= before + 1, "its own helper"
        assert os.sched_getaffinity(0) == CORES
        b.step(1)


def test_the_first_worlds_may_be_made_at_once():
    """pybind11's look for NumPy and the interpreter's lock waited for each other, for ever."""
    text = ("import sys; sys.setswitchinterval(1e-6); sys.path.insert(0, sys.argv[1]); import test_batch; "
            "b = test_batch.batch(8, threads=4); b.step(); print(len(b))")
    for _ in range(10):  # with NumPy 2 a third of them hung
        done = subprocess.run([sys.executable, "-c", text, os.path.dirname(os.path.abspath(__file__))], timeout=60, capture_output=True, text=True)
        assert done.stdout == "8\n", done.stderr


def test_the_stub_has_the_arguments():
    import ast

    with open(os.path.join(os.path.dirname(pliant.__file__), "__init__.pyi")) as file:
        (stub,) = [c for c in ast.parse(file.read()).body if getattr(c, "name", "") == "Batch"]
    said = {f.name: [a.arg for a in f.args.args + f.args.kwonlyargs] for f in stub.body if isinstance(f, ast.FunctionDef)}
    held = {n for n in vars(pliant.Batch) if not n.startswith("_")} | {"__init__", "__len__", "__getitem__", "__enter__", "__exit__"}
    assert said.keys() == held, said.keys() ^ held
    for name, arguments in said.items():
        if callable(getattr(pliant.Batch, name)):
            kinds = inspect.signature(getattr(pliant.Batch, name)).parameters.values()
            assert arguments == [p.name for p in kinds if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)], name


def test_the_code_of_the_document():
    with open(os.path.join(SOURCE, "docs/embedding.md"), encoding="utf-8") as file:
        section = file.read().split("\n## Many worlds\n")[1]
    code = section.split("```python\n")[1].split("```")[0].replace('"scenes/', f'"{SOURCE}/scenes/')
    names = {}
    exec(compile(code, "docs/embedding.md", "exec"), names)
    assert names["x"].shape[0] == 8 and (np.diff(names["force"]) > 0).all() and names["force"][0] > 0


def test_the_modulus_is_fitted():
    example = runpy.run_path(os.path.join(SOURCE, "examples/python/fit_modulus.py"))
    assert abs(example["error"]) < 0.02, example["error"]


def test_without_gymnasium():
    text = "import sys; sys.modules['gymnasium'] = None; import pliant.gym"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True)
    assert done.stderr.strip().splitlines()[-1] == 'ImportError: pliant.gym needs gymnasium: pip install "pliant[gym]", or pip install gymnasium'
    assert "During handling" not in done.stderr, done.stderr


# --- with gymnasium ------------------------------------------------------------------------------------------------------------
def gym_environments_pass_the_checks():
    import warnings

    import gymnasium
    import pliant.gym
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(pliant.gym.ID)
        check_env(env.unwrapped)
    env.close()


def gym_vectors_have_the_bits_of_single_environments():
    import gymnasium
    import pliant.gym

    n, steps = 3, 6
    random = np.random.default_rng(1)
    actions = random.uniform(-1, 1, (2 * steps + 3, n, 3)).astype(np.float32) - np.float32([0, 0.5, 0])
    vectors = [pliant.gym.make_vec(n, steps=steps, threads=threads) for threads in (1, 2)]
    singles = [gymnasium.make(pliant.gym.ID, steps=steps) for _ in range(n)]
    firsts = [v.reset(seed=5)[0] for v in vectors]
    alone = np.stack([env.reset(seed=5 + i)[0] for i, env in enumerate(singles)])
    assert np.array_equal(firsts[0], alone) and np.array_equal(firsts[1], alone) and len(np.unique(alone[:, 0])) == n
    over, felt = np.zeros(n, bool), 0
    for action in actions:
        observations, rewards, terminated, truncated, infos = vectors[0].step(action)
        again = vectors[1].step(action)
        assert np.array_equal(observations, again[0]) and np.array_equal(rewards, again[1])
        for i, env in enumerate(singles):
            if over[i]:
                expected, reward, cut, info = env.reset()[0], 0, False, None
            else:
                expected, reward, _, cut, info = env.step(action[i])
            assert np.array_equal(expected, observations[i]) and reward == rewards[i] and cut == truncated[i]
            assert info is None or info["distance"] == infos["distance"][i]
        over, felt = truncated, felt + rewards.sum()
        assert not terminated.any()
    assert felt > 0.1, "probes have felt tissue"
    before = vectors[0].reset(seed=9)[0]
    mask = np.array([False, True, False])
    after = vectors[0].reset(seed=[None, 77, None], options={"reset_mask": mask})[0]
    assert np.array_equal(before[~mask], after[~mask]) and not np.array_equal(before[mask], after[mask])
    for env in (*vectors, *singles):
        env.close()


def gym_rewards_add_up_to_the_largest_force():
    import gymnasium
    import pliant.gym

    env = gymnasium.make(pliant.gym.ID, steps=8)
    for _ in range(2):
        first, info = env.reset(seed=4)
        assert info["best_force"] == 0 and np.allclose(info["best_place"], first[[0, 2]])
        rewards, forces = [], []
        for k in range(8):
            observation, reward, terminated, truncated, info = env.step(np.float32([0, -1 if k < 6 else 1, 0]))
            rewards.append(reward)
            forces.append(observation[4])
            assert truncated == (k == 7) and not terminated
        assert rewards[-2:] == [0, 0] and np.isclose(sum(rewards), info["best_force"]) and np.isclose(max(forces), info["best_force"])
        assert 0.05 < info["best_force"] < 1 and np.isclose(info["distance"], np.linalg.norm(first[[0, 2]] - info["inclusion"]), atol=1e-6)
        assert np.isclose(observation[1], pliant.gym.LOW[1] + 2 * pliant.gym.MOTION[1])
    env.close()


def retract_and_cut(env, seed, pull, steer=True):
    """A hand-written policy: pulls up steadily and draws the blade along the seam that it sees. The sum of rewards, the largest force, info."""
    from pliant import _retraction

    seen, _ = env.reset(seed=seed)
    total = most = 0.0
    while True:
        seam = seen[9:].reshape(-1, 2)
        blade = seen[4:6]
        height = np.interp(blade[0] + _retraction.ADVANCE[0], seam[:, 0], seam[:, 1])
        up = (height - blade[1]) / _retraction.ADVANCE[1] if steer else 0.0
        forward = 1.0 if abs(up) < 1 else 0.0  # at the height of the seam
        seen, reward, terminated, truncated, info = env.step(np.float32([0, pull if seen[1] < 0.045 else 0, forward, np.clip(up, -1, 1)]))
        assert env.observation_space.contains(seen)
        total, most = total + reward, max(most, info["force"])
        if terminated or truncated:
            return total, most, {**info, "truncated": truncated}


def gym_retraction_passes_the_checks():
    import warnings

    import gymnasium
    import pliant.gym
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("Pliant/Retraction-v0")
        check_env(env.unwrapped)
    assert isinstance(env.unwrapped, pliant.gym.RetractionEnv)
    env.close()
    several = gymnasium.make_vec("Pliant/Retraction-v0", num_envs=2, vectorization_mode="sync")
    first, _ = several.reset(seed=3)
    assert first.shape == (2, 21) and np.abs(first[0] - first[1]).max() > 1e-5, "each has its own tissue"
    several.close()


def gym_retraction_takes_a_hand_and_a_blade():
    import gymnasium

    env = gymnasium.make("Pliant/Retraction-v0").unwrapped
    for seed in range(3):
        gentle, force, info = retract_and_cut(env, seed, 0.4)
        assert info["off"] and gentle > 1.9 and info["cut"] > 0.95 and info["astray"] < 0.02 and force < 0.25, (gentle, force, info)
        assert retract_and_cut(env, seed, 0.4)[0] == gentle, "an episode is what its seed and actions make of it"
        idle, _, info = retract_and_cut(env, seed, 0.0)
        assert info["truncated"] and idle < 0.3 and not info["off"], "without the hand the blade sees nothing"
        hard, force, _ = retract_and_cut(env, seed, 1.0)
        assert force > 0.25 and hard < gentle, "and too much of it costs"
    seen, _ = env.reset(seed=1)
    env.blade[1] = env.seam + 0.006  # and from here straight on
    blind = [env.step(np.float32([0, 0.4 if k < 40 else 0, 1, 0])) for k in range(50)]
    astray, total = blind[-1][4]["astray"], sum(step[1] for step in blind)
    assert astray > 0.5 and total < -0.5 and not blind[-1][4]["off"], ("a cut elsewhere is no good", astray, total, blind[-1][4])
    env.close()


def gym_the_search_finds_the_inclusion():
    example = runpy.run_path(os.path.join(SOURCE, "examples/python/palpate_search.py"))
    assert example["distance"] < 0.005, example["distance"]


if __name__ == "__main__":
    with_gym = importlib.util.find_spec("gymnasium") is not None
    for name, test in list(globals().items()):
        if name.startswith("test_") or (with_gym and name.startswith("gym_")):
            if not sys.argv[1:] or name in sys.argv[1:]:
                test()
    print("ok" if with_gym else "ok; the environments were skipped: gymnasium is not installed (pip install gymnasium)")
