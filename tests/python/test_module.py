"""The Python module from the build folder: views, errors, and the example."""
import gc
import os
import re
import runpy
import tempfile
import time

from common import SOURCE, box  # first: exits where NumPy is missing
import numpy as np
import pliant

VERTICES, TRIANGLES = box(0.1, 0.08, 0.06)


def block(**options):
    scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{
        "name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02},
        "material": {"young": 3000, "poisson": 0.45, "damping": 5}, "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}]}]}
    return pliant.World(scene, surfaces=[(VERTICES, TRIANGLES)], backend="cpu", **options)


def error_of(call):
    try:
        call()
    except pliant.Error as error:
        return error
    raise AssertionError("no pliant.Error")


def test_the_package():
    from pliant import _core

    folder = os.path.dirname(pliant.__file__)
    assert os.path.dirname(_core.__file__) == folder, "the compiled part stands beside the Python files"
    public = {name for name in vars(_core) if not name.startswith("_")}
    assert public == set(pliant.__all__) - {"Batch"} and all(getattr(pliant, name) is getattr(_core, name) for name in public), public
    assert {getattr(pliant, name).__module__ for name in public} == {"pliant"}, "what users see has one name"
    assert repr(pliant.World) == "<class 'pliant.World'>" and pliant.World.step.__doc__.endswith("-> pliant.StepReport\n")
    assert pliant.__version__ == _core.__version__


def test_the_stub_names_what_is_there():
    import ast
    from pathlib import Path

    stub = Path(pliant.__file__).with_suffix(".pyi")
    assert stub.with_name("py.typed").exists()
    classes = {c.name: c for c in ast.parse(stub.read_text()).body if isinstance(c, ast.ClassDef) and not c.name.startswith("_")}
    compiled = [name for name in pliant.__all__ if isinstance(getattr(pliant, name), type) and name not in ("Batch", "Error")]
    assert {"World", "Frame", "StepReport", "HapticLoop", "ManualDevice"} <= set(compiled)
    for name in compiled:
        said = {f.name: f.args for f in classes[name].body}
        held = {n for n in vars(getattr(pliant, name)) if not n.startswith("_")}
        assert {n for n in said if not n.startswith("_")} == held, (name, said.keys() ^ held)
        for call, arguments in said.items():
            text = getattr(getattr(pliant, name), call).__doc__ if call in held else None
            if not (text or "").startswith(call + "("):
                continue  # a property
            allowed = [a.arg for a in arguments.posonlyargs + arguments.args + arguments.kwonlyargs][1:]
            assert re.findall(r"(\w+): ", text.split("\n")[0].split(" -> ")[0])[1:] == allowed, call
    infos = {"_WorldInfo": block().info, "_BodyInfo": block().info["bodies"][0], "_CutResult": block().cut(np.zeros((0, 3, 3)))}
    world = block()
    world.frame()
    infos["_PickedPoint"] = world.pick([0.01, 1, 0.02], [0, -1, 0])
    for name, held in infos.items():
        stubs = next(c for c in ast.parse(stub.read_text()).body if getattr(c, "name", "") == name)
        assert [f.target.id for f in stubs.body] == list(held), name


def test_views():
    world = block()
    frame = world.frame()
    x = frame.positions
    assert x.shape == (8, 3) and x.dtype == np.float32 and x.strides == (16, 4)
    assert frame.triangles.shape == (12, 3) and frame.normals.shape == (8, 3)
    assert np.allclose(x, VERTICES, atol=1e-6)
    assert not x.flags.owndata and not x.flags.writeable
    assert x.__array_interface__["data"] == frame.positions.__array_interface__["data"], "each access shows the same memory"
    before = x.copy()
    for _ in range(10):
        world.step(20)
        world.frame()
    del frame, world
    gc.collect()
    assert np.array_equal(x, before), "a view keeps its frame"


def test_a_view_outlives_a_world_that_is_busy():
    world = block()
    assert world.step_async(1_000_000_000)
    x = world.frame().positions
    before = x.copy()
    del world  # stops the worker after its batch
    gc.collect()
    held = [block() for _ in range(4)]  # memory that was freed would be taken again
    for other in held:
        other.step(10)
        other.frame()
    assert np.array_equal(x, before)


def test_lists_will_do_for_a_surface():
    scene = {"format": "pliant-scene/1", "bodies": [{"name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02},
                                                     "material": {"young": 3000, "poisson": 0.45}}]}
    assert pliant.World(scene, [(VERTICES.tolist(), TRIANGLES.tolist())], backend="cpu").info["nodes"] == block().info["nodes"]


def test_steps():
    a, b = block(), block()
    report = a.step(100)
    assert report.done == 100 and not report.diverged and a.step_number == 100
    assert b.step_async(100)
    b.wait()
    assert b.poll() and a.hash() == b.hash()
    assert a.displacements().shape == (a.info["nodes"], 3)
    assert a.displacements().min() < -1e-3
    a.reset()
    assert a.time == 0 and not np.any(a.displacements())


def test_divergence_is_reported_and_the_last_good_state_stays():
    world = block(dt=0.05)
    report = world.step(10000)
    assert report.diverged and "block" in report.message
    assert np.isfinite(world.frame().positions).all()
    assert error_of(lambda: world.step(1)).code == 4
    world.reset()
    assert world.step(1).step == 1


def test_errors():
    assert error_of(lambda: pliant.World("no/such/scene.json")).code == 6
    assert error_of(lambda: pliant.World({"format": "?"})).code == 2
    world = block()
    assert error_of(lambda: world.step(-1)).code == 5
    assert error_of(lambda: world.grab(0)).code == 8
    assert error_of(lambda: world.displacements(3)).code == 5
    assert error_of(lambda: pliant.World({}, surfaces=[(VERTICES[:, :2], TRIANGLES)])).code == 5
    assert error_of(lambda: pliant.World({}, surfaces=[(VERTICES, TRIANGLES + 2**32)])).code == 5
    assert error_of(lambda: pliant.World({}, surfaces=[(VERTICES, TRIANGLES + 0.5)])).code == 5
    for wrong in (lambda: world.step("many"), lambda: pliant.World(3), lambda: world.grab(2**40)):
        try:
            wrong()
        except TypeError:
            continue
        raise AssertionError("no TypeError")


def type_error_of(call):
    try:
        call()
    except TypeError as error:
        assert "\n" not in str(error) and "std::" not in str(error), error
        return str(error)
    raise AssertionError("no TypeError")


def test_wrong_calls_are_told_in_words_of_python():
    world = block()
    assert type_error_of(lambda: block(cuting=True)) == (
        "World() has no argument 'cuting'; allowed are: 'scene', 'surfaces', 'folder', 'backend', 'dt', 'normals', 'interactive', 'cutting'")
    assert type_error_of(lambda: world.advance_async(steps=20)) == "World.advance_async() has no argument 'steps'; allowed are: 'seconds'"
    assert type_error_of(lambda: world.hash(deep=True)) == "World.hash() has no argument 'deep'; allowed are: none"
    wrong_type = type_error_of(lambda: world.step("many"))  # versions of pybind11 describe an int in different words
    assert wrong_type.startswith("World.step() takes (steps: ") and wrong_type.endswith(" = 1), got (str)"), wrong_type
    assert type_error_of(lambda: world.grab()).startswith("World.grab() takes (vertex: ")
    assert type_error_of(lambda: world.push(0, force="up")).endswith("got (int, force: str)")
    assert "World() takes (scene: object" in type_error_of(pliant.World)
    assert "JSON" in type_error_of(lambda: pliant.World({"format": object()})), "errors of Python itself stay as they are"
    assert pliant.World.step.__doc__.startswith("step(self: pliant.World, steps: ")
    assert world.step(steps=2).done == 2 and world.step().done == 1


def test_prepared_for_cuts():
    a, b = block(cutting=True), block()
    sheet = np.array([[[-1, 0.045, -1], [-1, 0.045, 3], [3, 0.045, -1]]])
    for world in (a, b):
        world.step(20)
        world.cut(sheet)
        world.step(20)
    assert a.hash() == b.hash() and a.pieces() == 2


def test_seconds_in_the_background():
    world = block()
    for i in range(300):
        assert world.advance_async(1 / 60)
        world.wait()
    assert -1e-5 * world.dt < 5 - world.time < world.dt * (1 + 1e-5)
    assert world.advance_async(seconds=0)
    world.wait()


def test_two_consumers():
    world = block()
    seen, uploaded = {1: None, 3: None}, {1: np.zeros((0, 3), np.float32), 3: np.zeros((0, 3), np.float32)}
    for i in range(12):
        world.step(10)
        if i == 5:
            world.cut(np.array([[[-1, 0.045, -1], [-1, 0.045, 3], [3, 0.045, -1]]]))
        for every in (1, 3):
            if i % every:
                continue
            seen[every], (first, count), triangles = world.frame_since(seen[every])
            buffer = np.resize(uploaded[every], seen[every].positions.shape)
            buffer[first:first + count] = seen[every].positions[first:first + count]
            uploaded[every] = buffer
            assert np.array_equal(buffer, seen[every].positions), (every, i)
            assert (triangles[1] > 0) == (i in ({1: (0, 5), 3: (0, 6)}[every])), (every, i)
    assert world.poll()
    again, vertices, triangles = world.frame_since(seen[1])
    assert vertices[1] == 0 and triangles[1] == 0
    assert again.body_vertices == [(0, len(again.positions))]


def test_push_a_node():
    world = block(interactive=True)
    world.push_node(0, 5, [0.1, 0, 0])
    world.step(50)
    assert not np.array_equal(world.displacements(), block(interactive=True).displacements())


def test_probes():
    scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{
        "name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45}}],
        "probes": [{"name": "a", "point": [0.05, 0.02, 0.03], "quantities": ["stress", "displacement"]},
                   {"name": "b", "all": True, "quantities": ["energy", "velocity"]}]}
    world = pliant.World(scene, [(VERTICES, TRIANGLES)], backend="cpu")
    world.step(50)
    now = world.probes()
    assert {name: list(quantities) for name, quantities in now.items()} == {"a": ["stress", "displacement"], "b": ["energy", "velocity"]}
    assert now["a"]["stress"].shape == (6,) and now["b"]["energy"].shape == (2,)
    assert np.allclose(now["b"]["velocity"], [0, -9.81 * world.time, 0], rtol=0.05, atol=1e-6), "it falls"
    assert np.allclose(now["b"]["velocity"], world.velocities().mean(axis=0), rtol=1e-12, atol=1e-15)
    assert np.array_equal(world.probes()["a"]["displacement"], now["a"]["displacement"])
    assert block().probes() == {}
    scene["probes"][0]["point"] = [5, 0, 0]
    assert error_of(lambda: pliant.World(scene, [(VERTICES, TRIANGLES)], backend="cpu")).code == 2


def test_tools():
    world = block(interactive=True)
    hand = world.grab(7, radius=0.03)
    world.move_grab(hand, [0.11, 0.08, 0.06])
    world.advance(0.5)
    assert world.frame().positions[7, 0] > 0.105
    world.release(hand)


def test_pick():
    world = block(interactive=True)
    assert world.pick([0.01, 1, 0.02], [0, -1, 0]) is None, "there was no frame"
    frame = world.frame()
    found = world.pick(origin=np.array([0.01, 1, 0.02]), direction=(0, -3, 0))
    corners = frame.triangles[found["triangle"]]
    assert found["body"] == 0 and np.isclose(found["distance"], 0.92) and np.allclose(found["point"], [0.01, 0.08, 0.02])
    assert np.allclose(found["weights"] @ frame.positions[corners], found["point"]) and np.array_equal(found["normal"], [0, 1, 0])
    away = np.linalg.norm(frame.positions[corners] - found["point"], axis=1)
    assert found["vertex"] == corners[away.argmin()]
    assert world.pick([0.01, 1, 0.02], [0, 1, 0]) is None
    world.grab(found["vertex"])
    assert error_of(lambda: world.pick([0, 1, 0], [0, 0, 0])).code == 5
    assert type_error_of(lambda: world.pick([0, 1, 0])).startswith("World.pick() takes (origin: ")


def test_interpenetrations():
    body = {"lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45}}
    scene = {"format": "pliant-scene/1", "bodies": [{"name": "low", "surface": "memory:0", **body}, {"name": "high", "surface": "memory:1", **body}],
             "probes": [{"name": "both", "between": ["low", "high"]}]}
    higher = VERTICES + [0.09, 0.07, 0.04]
    world = pliant.World(scene, [(VERTICES, TRIANGLES), (higher, TRIANGLES)], backend="cpu:double")
    (found,) = world.interpenetrations()
    assert (found["first"], found["second"], found["tool"]) == ("low", "high", False)
    assert np.isclose(found["volume"], 2e-6, rtol=1e-9) and np.allclose(found["centroid"], [0.095, 0.075, 0.05])
    assert np.allclose(found["area"], 5e-4) and np.isclose(found["depth"], 0.01) and found["deepest"].shape == (3,)
    assert np.array_equal(world.probes()["both"]["interpenetration"][:4], [found["volume"], *found["centroid"]])
    assert block().interpenetrations() == []


def test_a_tool_takes_another_surface():
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) * 0.02
    faces = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    world = block()
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "box.obj"), "w") as out:
            out.write("\n".join(lines))
        world.add_tool({"name": "box", "shape": {"mesh": "box.obj"}, "path": [[0, 0.05, 0.105, 0.03]]}, folder=folder)
        world.set_tool_mesh("box", corners, faces, world.time + 0.05)
    world.set_tool_mesh("box", corners * [1, 1.9, 1], faces, world.time + 0.1)  # 18 mm longer at both ends
    world.advance(0.3)
    assert world.tool_forces()["box"]["force"][1] > 0.1
    values = world.vertex_values("mises")
    assert values.shape == (len(world.frame().positions),) and values.dtype == np.float32 and values.max() > 0
    assert error_of(lambda: world.vertex_values("stress")).code == 5
    vertices, _ = world.tool_surface("box")
    assert np.isclose(vertices[:, 1].min(), -0.038)
    assert error_of(lambda: world.set_tool_mesh("box", corners, faces[1:], 1)).code == 2
    assert error_of(lambda: world.set_tool_mesh("box", corners, faces, 0.1)).code == 5


def test_rigid_tools():
    world = block()
    assert world.tool_forces() == {}
    ball = {"name": "ball", "shape": {"sphere": 0.02}, "path": [[0, 0.05, 0.101, 0.03]], "friction": 0.2}
    assert world.add_tool(ball) == "ball"
    assert error_of(lambda: world.add_tool(ball)).code == 5
    assert error_of(lambda: world.add_tool({"shape": {"cone": 1}})).code == 2
    world.drive_tool("ball", [0.05, 0.095, 0.03], seconds=0.1)
    world.advance(0.3)
    assert world.tool_forces()["ball"]["force"][1] > 0.01 and world.tool_forces()["ball"]["parked"] is False
    world.park_tool("ball")
    assert world.tool_forces()["ball"]["parked"] is True
    assert "begins inside body 'block'" in str(error_of(lambda: world.place_tool("ball", [0.05, 0.04, 0.03])))
    world.place_tool("ball", [0.05, 0.2, 0.03])
    world.park_tool("ball")
    world.unpark_tool("ball")
    assert np.array_equal(world.tool_forces()["ball"]["position"], [0.05, 0.2, 0.03])
    vertices, triangles = world.tool_surface("ball")
    assert np.allclose(np.linalg.norm(vertices, axis=1), 0.02) and triangles.shape[1] == 3 and triangles.max() < len(vertices)
    world.remove_tool("ball")
    assert world.tool_forces() == {} and error_of(lambda: world.remove_tool("ball")).code == 5


def test_cuts():
    world = block()
    before = world.frame()
    assert before.cut_faces.size == 0
    sheet = np.array([[[-1, 0.045, -1], [-1, 0.045, 3], [3, 0.045, -1]]])  # from side to side, 4.5 cm above the ground
    result = world.cut(sheet)
    assert result["changed"] and result["edges"] > 0 and not result["pending"]
    after = world.frame()
    assert after.topology_version > before.topology_version
    assert after.cut_faces.shape == (len(after.triangles),) and after.cut_faces.any() and after.cut_faces.dtype == np.uint8
    assert after.dirty_triangles[1] == len(after.triangles)
    assert len(before.triangles) == 12, "a frame stays as it was"
    assert world.pieces() == 2
    assert error_of(lambda: world.cut(sheet[0])).code == 5
    world.move_blade("knife", [0, 0, 0], [0, 0, 0.1])
    world.lift_blade("knife")


def test_the_attempts_of_a_blade():
    path = [[0, -0.065, 0.01, 0.003, -0.065, 0.03, 0.003], [0.6, 0.0, 0.01, 0.003, 0.0, 0.03, 0.003]]
    material = {"law": "neo-hookean", "young": 20000, "poisson": 0.4, "density": 1000, "damping": 60, "toughness": 40000}
    scene = {"format": "pliant-scene/1", "bodies": [{"name": "block", "surface": "meshes/block.obj", "lattice": {"spacing": 0.01}, "material": material,
                                                    "fixed": [{"box": [[-1, -0.0201, -1], [1, -0.0199, 1]]}]}],
             "blades": [{"name": "scalpel", "cuts": "by-force", "edge": 5e-4, "path": path}]}
    world = pliant.World(scene, folder=os.path.join(SOURCE, "scenes"), backend="cpu")
    world.advance(0.59)
    attempts = world.cut_attempts()
    assert len(attempts) >= 3 and world.cut_attempts() == []
    last = attempts[-1]
    assert set(last) == {"blade", "body", "stroke", "from", "to", "time", "position", "rest", "gave_way"}
    assert (last["blade"], last["body"], last["gave_way"]) == ("scalpel", "block", True) and last["from"] != last["to"]
    assert 0 < last["time"] < 0.59 and last["rest"].shape == (3,)


def test_a_checkpoint_with_options_names_them():
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "state.pck")
        world = block(interactive=True, cutting=True)
        world.step(20)
        world.save(file)
        message = str(error_of(lambda: block().load(file)))
        assert message.endswith("not the same: interactive (on there, off here), cutting (on there, off here)"), message
        block(interactive=True, cutting=True).load(file)


def test_a_world_runs_freely():
    world = block(interactive=True)
    world.run_live(rate=100, speed=0.5)
    assert error_of(lambda: world.step(1)).code == 8
    before = world.live_state()
    assert before["running"] and world.busy()
    for _ in range(4000):
        if world.live_state()["frames"] > before["frames"] + 5:
            break
        time.sleep(0.005)
    assert world.live_state()["frames"] > before["frames"] + 5
    report = world.stop_live()
    assert report.step == world.step_number > 0 and not world.live_state()["running"]
    other = block(interactive=True)
    other.step(report.step)
    assert other.hash() == world.hash()
    world.cut([[[-1, 0.041, -1], [-1, 0.041, 3], [3, 0.041, -1]]])
    world.step(5)
    cut, pieces = world.events()
    assert cut["kind"] == "cut" and cut["amount"] > 4 and abs(cut["position"][1] - 0.041) < 0.03 and cut["text"]
    assert pieces["kind"] == "pieces" and pieces["amount"] == 2 and world.events() == []
    grab = world.grab(0)
    world.move_grab(grab, [-0.02, 0, 0])
    world.advance(0.05)
    trace = world.force_trace(grab)
    assert trace.dtype.names == ("step", "time", "force", "torque") and trace["force"].shape == (len(trace), 3) and len(trace) > 10
    assert len(world.force_trace(grab, int(trace["step"][-3]))) == 2
    assert error_of(lambda: world.force_trace("none")).code == 5
    world.recover()  # nothing to recover from


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
    example = runpy.run_path(os.path.join(SOURCE, "examples/python/pull_a_block.py"))
    assert example["path"][-1, 0] > 0.11, "the corner followed the hand"
    print("ok")
