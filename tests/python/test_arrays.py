"""Arrays of the Python module: whose memory they show, for how long, and their exchange by DLPack. PyTorch is tried where it is installed."""
import gc
import os
import tempfile

from common import SOURCE, box  # first: exits where NumPy is missing
import numpy as np
import pliant

VERTICES, TRIANGLES = box(0.1, 0.08, 0.06)
SHEET = np.array([[[-1, 0.045, -1], [-1, 0.045, 3], [3, 0.045, -1]]])
FIELDS = ("positions", "normals", "rest", "triangles", "cut_faces")


def block(**options):
    scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{
        "name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02},
        "material": {"young": 3000, "poisson": 0.45, "damping": 5}, "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}]}],
        "tools": [{"name": "ball", "shape": {"sphere": 0.02}, "path": [[0, 0.05, 0.11, 0.03], [0.1, 0.05, 0.07, 0.03]]}]}
    return pliant.World(scene, surfaces=[(VERTICES, TRIANGLES)], backend="cpu", **options)


def resident():
    """Memory of this process [bytes]."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def address(array):
    return array.__array_interface__["data"][0]


def cut_frame():
    world = block()
    world.step(20)
    world.cut(SHEET)
    return world.frame()


def test_arrays_of_a_frame_show_its_memory():
    frame = cut_frame()
    for field in FIELDS:
        array = getattr(frame, field)
        assert isinstance(array, np.ndarray) and array.size > 0 and not array.flags.owndata and not array.flags.writeable, field
        assert address(array) == address(getattr(frame, field)), f"each access to {field} shows the same memory"
        assert address(array[2:]) == address(array) + 2 * array.strides[0]
    try:
        frame.positions[0, 0] = 1
    except ValueError:
        pass
    else:
        raise AssertionError("a frame was written to")


def test_what_is_computed_from_a_frame_is_plain_numpy():
    x = cut_frame().positions
    for made in (x - x, x * 2, np.linalg.norm(x, axis=1), x[:, 1] > 0, np.stack([x, x]), np.ascontiguousarray(x).copy()):
        assert made.flags.writeable
    assert type(x - x) is np.ndarray and type(x[:, 1] > 0) is np.ndarray
    assert np.isscalar(x.max()) and np.isscalar(x.sum()) and np.isscalar(x[0, 0])
    assert "FrameArray" not in repr(x)
    written = x.copy()
    written[0, 0] = 7
    assert written[0, 0] == 7 and x[0, 0] != 7


def test_frames_by_dlpack():
    frame = cut_frame()
    for field in FIELDS:
        array = getattr(frame, field)
        assert array.__dlpack_device__() == (1, 0), "the processor's memory"
        taken = np.from_dlpack(array)
        assert address(taken) == address(array) and taken.strides == array.strides and np.array_equal(taken, array), field
        assert not taken.flags.writeable, f"{field}: NumPy keeps what it gets by DLPack read-only, or is told to"
    x = frame.positions
    old = np.from_dlpack(Old(x))
    assert address(old) == address(x) and np.array_equal(old, x)
    part = np.from_dlpack(Old(x[::2, 1]))
    assert address(part) == address(x) + 4 and part.strides == (32,)
    assert np.array_equal(np.from_dlpack(x.copy()), x)
    before = x.copy()
    del frame, x, array, taken
    gc.collect()
    busy = block()
    for _ in range(8):
        busy.step(5)
        busy.frame()
    assert np.array_equal(old, before), "what was taken keeps the frame"


class Old:
    """A consumer of DLPack 0 asks without words, one of 1.0 names its version: this is the former's view of an array."""

    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **_):
        return self.array.__dlpack__()

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


def test_arrays_of_a_world_are_the_callers():
    world = block()
    world.advance(0.15)
    given = {"displacements": world.displacements(), "velocities": world.velocities(), "rest_positions": world.rest_positions(),
             **{field: world.vertex_values(field) for field in ("mises", "green_strain", "pressure", "energy")},
             "tool": world.tool_surface("ball")[0]}
    for name, array in given.items():
        assert array.flags.writeable and array.flags.c_contiguous and not array.flags.owndata, f"{name}: the engine's result itself, not a copy of it"
        taken = np.from_dlpack(array)
        assert address(taken) == address(array), name
    trace = world.force_trace("ball")
    assert trace["force"].strides[0] == trace.itemsize and np.abs(trace["force"]).max() > 0
    assert given["mises"].max() > 0 and given["energy"].max() > 0 and np.abs(given["velocities"]).max() > 0
    kept = {name: array.copy() for name, array in given.items()}
    given["velocities"][:] = 0  # the World does not notice
    assert np.array_equal(world.velocities(), kept["velocities"])
    del world
    gc.collect()
    held = [block() for _ in range(4)]  # memory that was freed would be taken again
    for other in held:
        other.displacements()
    assert all(np.array_equal(given[name], kept[name]) for name in given if name != "velocities")


def test_views_stay_through_cut_reset_load_and_the_end_of_the_world():
    with tempfile.TemporaryDirectory() as folder:
        world = block()
        world.step(30)
        world.save(os.path.join(folder, "state.pck"))
        views, values = [], []
        for change in (lambda: world.cut(SHEET), lambda: world.load(os.path.join(folder, "state.pck")), world.reset, lambda: world.step(40)):
            frame = world.frame()
            views += [getattr(frame, field) for field in FIELDS]
            values += [view.copy() for view in views[-len(FIELDS):]]
            del frame
            change()
            world.frame()
        shapes = {view.shape for view in views}
        assert (12, 3) in shapes and len(shapes) > 4, "before and after the cut"
        del world
        gc.collect()
        other = block()
        for _ in range(6):
            other.step(3)
            other.frame()
        assert all(np.array_equal(view, value) for view, value in zip(views, values))


def test_views_take_no_memory():
    world = pliant.World(os.path.join(SOURCE, "scenes/liver.json"), backend="cpu")
    frame = world.frame()
    each = frame.positions.nbytes
    before = resident()
    views = [getattr(frame, field) for _ in range(500) for field in ("positions", "rest", "normals")]
    assert len(views) * each > 5e7 and resident() - before < 5e6, "a copy of each would take ten times as much"
    frames = resident()
    for _ in range(150):
        world.step(1)
        views.append(world.frame().positions)
        del views[0]
    assert resident() - frames > 100 * each, "a view keeps its frame"
    del views, frame
    gc.collect()
    taken = resident()
    for _ in range(150):
        world.step(1)
        world.frame()
    held_back = "asan" in os.environ.get("LD_PRELOAD", "")  # a sanitizer keeps what is freed for a while
    assert held_back or resident() - taken < 20 * each, "frames that nobody sees any more make room for others"


def test_views_stay_through_errors():
    world = block(dt=0.02)  # four times the stable step
    frame = world.frame()
    views = [getattr(frame, field) for field in FIELDS[:4]]
    values = [view.copy() for view in views]
    del frame
    assert "young: got -1" in str(error_of(lambda: world.change(material={"young": -1})))
    assert world.step(200).diverged
    views.append(world.frame().positions)
    values.append(views[-1].copy())
    assert "reset() or load()" in str(error_of(lambda: world.step(1)))
    for _ in range(6):  # frames that take memory which is free
        world.reset()
        world.step(2)
        world.frame()
    assert all(np.array_equal(view, value) for view, value in zip(views, values))


def error_of(call):
    try:
        call()
    except pliant.Error as error:
        assert "\n" not in str(error)
        return error
    raise AssertionError("no pliant.Error")


def test_a_state_from_arrays():
    scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "dt": 1e-3, "bodies": [{
        "name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02},
        "material": {"young": 3000, "poisson": 0.45, "damping": 5}, "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}]}]}
    one, two = (pliant.World(scene, surfaces=[(VERTICES, TRIANGLES)], backend="cpu") for _ in range(2))
    one.step(130)
    two.set_state(displacements=one.displacements(), velocities=one.velocities())
    assert one.hash() == two.hash()
    one.step(200)
    two.step(200)
    assert one.hash() == two.hash(), "the same state goes on with the same bits"
    rest = one.rest_positions()
    two.set_state(rest + one.displacements())
    assert np.allclose(two.displacements(), one.displacements(), atol=1e-12)
    held = rest[:, 1] < 0.001
    shifted = (rest + [0.001, 0, 0]).astype(np.float32)  # float32, strides and lists will do
    two.set_state(shifted, velocities=np.zeros((len(rest), 6))[:, ::2])
    assert np.allclose(two.displacements()[~held], [0.001, 0, 0], atol=1e-8) and not two.displacements()[held].any() and not two.velocities().any()
    two.set_state(velocities=np.tile([0, 0, 0.5], (len(rest), 1)).tolist(), body=0)
    assert np.allclose(two.velocities()[~held], [0, 0, 0.5]) and np.allclose(two.displacements()[~held], [0.001, 0, 0], atol=1e-8)
    before = two.hash()
    two.set_state()
    assert two.hash() == before


def test_wrong_states_are_refused_in_one_sentence():
    world = block()
    rest = world.rest_positions()
    nodes = len(rest)
    for wrong, found in ((rest[:-1], f"[{nodes}, 3], in the order of rest_positions(), not the shape [{nodes - 1}, 3]"),
                         (world.frame().positions, "not the shape [8, 3]"), (rest[:, :2], f"not the shape [{nodes}, 2]"), ("up", "something else")):
        error = error_of(lambda: world.set_state(wrong))
        assert error.code == 5 and found in str(error) and str(error).startswith("positions of a state"), error
    nan = rest.copy()
    nan[5, 2] = np.nan
    assert "node 5" in str(error_of(lambda: world.set_state(nan))) and "node 5" in str(error_of(lambda: world.set_state(velocities=nan)))
    assert "not both" in str(error_of(lambda: world.set_state(rest, displacements=rest)))
    assert error_of(lambda: world.set_state(rest, body=2)).code == 5
    assert not world.displacements().any()


def test_pytorch_takes_a_frame_without_a_copy():
    try:
        import torch
    except ImportError:
        print("left out: PyTorch is not installed")
        return
    world = block()
    world.step(40)
    frame = world.frame()
    for field in FIELDS[:4]:
        array = getattr(frame, field)
        tensor = torch.from_dlpack(array)
        assert tensor.data_ptr() == address(array) and tuple(tensor.shape) == array.shape and tensor.stride(0) * array.itemsize == array.strides[0]
        assert np.array_equal(tensor.numpy(), array), field
    tensor, before = torch.from_dlpack(frame.positions), frame.positions.copy()
    velocities = world.velocities()
    assert torch.from_dlpack(velocities).data_ptr() == address(velocities)
    del frame, array, world
    gc.collect()
    assert np.array_equal(tensor.numpy(), before)


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
    print("ok")
