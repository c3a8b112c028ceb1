"""Touch from Python: loops, devices, and what happens when their owners let go."""
import gc
import os
import re
import runpy
import socket
import struct
import sys
import tempfile
import threading
import time
import weakref

from common import SOURCE, box  # first: exits where NumPy is missing
import numpy as np
import pliant

VERTICES, TRIANGLES = box(0.1, 0.05, 0.1)


def block():
    """A soft block, and a ball 2 mm above the middle of its top."""
    scene = {"format": "pliant-scene/1", "bodies": [{
        "name": "block", "surface": "memory:0", "lattice": {"spacing": 0.0125},
        "material": {"young": 10000, "poisson": 0.45, "damping": 40}, "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}]}],
        "tools": [{"name": "ball", "shape": {"sphere": 0.012}, "path": [[0, 0.05, 0.064, 0.05]]}]}
    return pliant.World(scene, surfaces=[(VERTICES, TRIANGLES)], backend="cpu")


def wait_for(condition, world=None):
    for _ in range(4000):
        if world is not None:
            world.frame()
        if condition():
            return
        time.sleep(0.005)
    raise AssertionError("it did not happen within 20 s")


def error_of(call, kind):
    try:
        call()
    except kind as error:
        assert "\n" not in str(error) and "std::" not in str(error), error
        return error
    raise AssertionError("no " + kind.__name__)


def test_a_hand_feels_the_block():
    world, hand = block(), pliant.ManualDevice()
    assert hand.wrench().number == 0 and hand.port() == 0 and np.isinf(hand.limits().force)
    hand.set_pose([1, 2, 3])  # wherever it begins is where the tool is
    with pliant.HapticLoop(world, "ball", hand, realtime=False) as loop:
        world.run_live()
        wait_for(lambda: loop.state().frames > 2, world)
        assert not loop.state().last.force.any() and np.allclose(loop.state().last.position, [0.05, 0.064, 0.05], atol=1e-12)
        for i in range(50):
            hand.set_pose(position=np.array([1, 2 - 0.008 * (i + 1) / 50, 3]))
            time.sleep(0.004)
        wait_for(lambda: hand.wrench().force[1] > 0.05, world)
        felt, state = hand.wrench(), loop.state()
        assert felt.number == 51 and felt.time > 0 and felt.torque.shape == (3,)
        assert state.running and state.ticks > 0 and state.model in ("buffer", "extrapolated") and state.refused == 0
        assert state.last.tick <= state.ticks and np.allclose(state.last.device, [0.05, 0.056, 0.05], atol=1e-12) and state.last.tissue[1] > 0.05
    assert not loop.state().running and not hand.wrench().force.any(), "the hand is free at the end"
    assert hand.counts().received == 51 and hand.counts().last_refusal == ""
    loop.stop()
    world.stop_live()


def test_samples_are_arrays_of_each_tick():
    world, hand = block(), pliant.ManualDevice()
    hand.set_pose([0, 0, 0])
    loop = pliant.HapticLoop(world, "ball", hand, realtime=False)
    wait_for(lambda: loop.state().ticks > 50)
    first = loop.samples()
    wait_for(lambda: loop.state().ticks > first["tick"][-1] + 5)
    loop.stop()
    second = loop.samples()
    assert first.dtype.names == ("tick", "time", "device", "position", "tissue", "force") and first["force"].shape == (len(first), 3)
    ticks = np.concatenate([first["tick"], second["tick"]])
    assert np.array_equal(ticks, np.arange(1, loop.state().ticks + 1)), "each once, none missing"
    assert (np.diff(first["time"]) > 0).all() and np.allclose(second["device"], [0.05, 0.064, 0.05], atol=1e-12)
    assert len(loop.samples()) == 0


def test_a_loop_keeps_its_world_and_its_device():
    world, hand = block(), pliant.ManualDevice()
    world_lives, hand_lives = weakref.ref(world), weakref.ref(hand)
    hand.set_pose([0, 0, 0])
    world.run_live()
    loop = pliant.HapticLoop(world, "ball", hand, realtime=False)
    del world, hand
    gc.collect()
    assert world_lives() is not None
    frames = loop.state().frames
    wait_for(lambda: loop.state().frames > frames + 2, world_lives())
    del loop  # while it runs
    gc.collect()
    assert world_lives() is None and hand_lives() is None


def test_devices_by_text():
    device = pliant.open_haptic_device("udp:0")
    assert isinstance(device, pliant.HapticDevice) and device.port() > 0
    world = block()
    loop = pliant.HapticLoop(world, "ball", device, realtime=False, align=False)
    driver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    driver.settimeout(20)
    pose = struct.pack("<4s3IQ8d", b"PLHP", 1, 88, 0, 1, 0.5, 0.05, 0.07, 0.05, 0, 0, 0, 1)  # as in docs/haptic_devices.md
    driver.sendto(pose, ("127.0.0.1", device.port()))
    number, stamp, *wrench = struct.unpack("<16xQ7d", driver.recv(80))
    assert number == 1 and stamp == 0.5 and not any(wrench)
    wait_for(lambda: np.allclose(loop.state().last.position, [0.05, 0.07, 0.05], atol=1e-12))
    driver.sendto(b"nonsense", ("127.0.0.1", device.port()))
    wait_for(lambda: device.counts().refused == 1)
    assert device.counts().received == 1 and device.counts().last_refusal
    loop.stop()
    driver.close()
    pliant.HapticLoop(block(), "ball", "udp:0", realtime=False).stop()


def test_the_log_plays_again():
    world, hand = block(), pliant.ManualDevice()
    hand.set_pose([0, 0, 0])
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "stroke.csv")
        with pliant.HapticLoop(world, "ball", hand, log_samples=100, realtime=False) as loop:
            wait_for(lambda: loop.state().ticks > 3)
            hand.set_pose([0, -0.001, 0], [0.6, 0, 0, 0.8], buttons=5)
            wait_for(lambda: loop.state().last.device[1] < 0.0635)
            loop.write_log(file)
        assert open(file).read().count("\n") >= 3 and ",5\n" in open(file).read()
        assert pliant.HapticLoop(world, "ball", "file:" + file, realtime=False).state().running
    with pliant.HapticLoop(block(), "ball", hand, realtime=False) as loop:
        assert error_of(lambda: loop.write_log("stroke.csv"), pliant.Error).code == 8


def test_threads_take_turns_without_waiting_for_each_other():
    world, hand = block(), pliant.ManualDevice()
    loop = pliant.HapticLoop(world, "ball", hand, realtime=False)
    done, seen = threading.Event(), []

    def move():
        i = 0
        while not done.is_set():
            i += 1
            hand.set_pose([i % 7 * 1e-4, 0, 0])
            seen.append(hand.wrench().number)

    threads = [threading.Thread(target=move) for _ in range(2)]
    for thread in threads:
        thread.start()
    wait_for(lambda: loop.state().ticks > 100 and len(loop.samples()) >= 0)
    done.set()
    for thread in threads:
        thread.join()
    stops = [threading.Thread(target=loop.stop) for _ in range(4)]
    for thread in stops:
        thread.start()
    for thread in stops:
        thread.join()
    assert hand.counts().received == len(seen) and not loop.state().running


def test_wrong_calls_are_told_in_words_of_python():
    world, hand = block(), pliant.ManualDevice()
    said = str(error_of(lambda: pliant.HapticLoop(world, "ball", hand, rat=500), TypeError))
    assert said.startswith("HapticLoop() has no argument 'rat'; allowed are: 'rate', 'model', 'rings', "), said
    assert str(error_of(lambda: pliant.HapticLoop(world, "ball", hand, rate="fast"), TypeError)) == "HapticLoop() takes rate: float, got str"
    assert str(error_of(lambda: pliant.HapticLoop(world, "ball", hand, log_samples=-1), TypeError)) == "HapticLoop() takes log_samples: int, got int"
    assert str(error_of(lambda: pliant.HapticLoop(world, "ball", 3), TypeError)) == "HapticLoop() takes device: str or pliant.HapticDevice, got int"
    assert "HapticLoop() takes (world: " in str(error_of(lambda: pliant.HapticLoop(3, "ball", hand, rate=500), TypeError))
    assert "ManualDevice.set_pose() takes (position: " in str(error_of(lambda: hand.set_pose([1, 2]), TypeError))
    error_of(pliant.HapticDevice, TypeError)
    assert str(error_of(lambda: pliant.HapticLoop(world, "ball", hand, rate=100), pliant.Error)) == "haptics: rate is 100, expected 300 to 10000"
    assert error_of(lambda: pliant.HapticLoop(world, "rod", hand), pliant.Error).code == 5
    assert error_of(lambda: hand.set_pose([np.nan, 0, 0]), pliant.Error).code == 5
    assert error_of(lambda: pliant.ManualDevice(force=-1), pliant.Error).code == 5
    assert error_of(lambda: pliant.open_haptic_device("telepathy"), pliant.Error).code == 5
    assert error_of(lambda: pliant.open_haptic_device("file:no/such/stroke.csv"), pliant.Error).code == 6


def test_the_stub_has_all_options_with_the_values_of_the_headers():
    import ast
    from pathlib import Path

    classes = {c.name: c for c in ast.parse(Path(pliant.__file__).with_suffix(".pyi").read_text()).body if isinstance(c, ast.ClassDef)}
    init = next(f for f in classes["HapticLoop"].body if f.name == "__init__")
    said = {a.arg: ast.literal_eval(d) for a, d in zip(init.args.kwonlyargs, init.args.kw_defaults)}
    allowed = re.findall(r"'(\w+)'", str(error_of(lambda: pliant.HapticLoop(block(), "ball", "udp:0", none=0), TypeError)))[1:]
    assert allowed == list(said)
    header = Path(SOURCE, "include/pliant/haptics.h").read_text()
    options = re.sub(r"//[^\n]*", "", header[header.index("struct HapticOptions"):header.index("struct HapticSample")])
    values = dict(re.findall(r"(\w+)\s*=\s*([^;]+);", options))
    assert {n: str(v).lower() if isinstance(v, bool) else v for n, v in said.items()} == {
        n: v if v in ("true", "false") else ast.literal_eval(v) for n, v in values.items()}


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
    sys.argv = ["haptics.py", "2"]
    example = runpy.run_path(os.path.join(SOURCE, "examples/python/haptics.py"))
    assert len(example["ticks"]) > 100 and example["ticks"]["force"][:, 1].max() > 0.1
    print("ok")
