"""The page of World.show(), from outside: a websocket takes the place of the browser.

Skipped without NumPy or viser, but for what is said where viser is missing.
"""
import os
import re
import socket
import subprocess
import sys
import time
import urllib.request

from visitor import BALL, SOURCE, TRIANGLES, VERTICES, Opened, Visitor, block, free_port, run_all, wait_for  # first: it skips without NumPy

import numpy as np

import pliant


def area(x, triangles):
    x = x.astype(float)
    return np.linalg.norm(np.cross(x[triangles[:, 1]] - x[triangles[:, 0]], x[triangles[:, 2]] - x[triangles[:, 0]]), axis=1).sum() / 2


def python(*arguments, **options):
    return subprocess.run([sys.executable, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120, **options)


def say_what_is_missing():
    """The one test that needs no viser."""
    done = python("-c", "import sys; sys.modules['viser'] = None; from pliant.__main__ import main; sys.argv = ['pliant', 'no.json']; sys.exit(main())")
    assert done.returncode == 2 and done.stdout.count("\n") == 1 and 'pip install "pliant[view]"' in done.stdout, done.stdout


# --- NumPy alone -------------------------------------------------------------------------------------------------------------
def test_filled_contours():
    from pliant.view.contours import Mesh, filled

    turn = 2 * np.pi * np.arange(40) / 40
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points = np.concatenate([[[0, 0, 0]], *([np.c_[r * ring, np.zeros(40)] for r in (0.5, 1)])]).astype(np.float32)
    k = np.arange(40)
    inner = np.c_[np.zeros(40, int), 1 + k, 1 + (k + 1) % 40]
    outer = np.concatenate([np.c_[1 + k, 41 + k, 41 + (k + 1) % 40], np.c_[1 + k, 41 + (k + 1) % 40, 1 + (k + 1) % 40]])
    disk, values = np.concatenate([inner, outer]), points[:, 0].astype(float)
    levels = np.array([-0.9, -0.31, 0.0, 0.2, 0.21])
    split, bands = filled(points, disk, values, levels)
    assert len(bands) == 6 and all(len(band) for band in bands)
    bounds = [-1, *levels, 1]
    for number, band in enumerate(bands):
        x = split[band, 0]
        assert x.min() >= bounds[number] - 1e-6 and x.max() <= bounds[number + 1] + 1e-6, number
        normal = np.cross(split[band[:, 1]] - split[band[:, 0]], split[band[:, 2]] - split[band[:, 0]])
        assert (normal[:, 2] >= -1e-9).all(), "triangles keep their side"
    assert np.isclose(sum(area(split, band) for band in bands), area(points, disk))
    edges = np.sort(np.concatenate([np.concatenate(bands)[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 1).sum() >= 40
    lone = np.unique(edges, axis=0, return_counts=True)[1] == 1
    rim = split[np.unique(edges, axis=0)[lone]]
    assert np.allclose(np.linalg.norm(rim.mean(axis=1), axis=1), np.cos(np.pi / 40), atol=0.01), "there are no gaps but the rim"
    mesh = Mesh(np.array([[7, 3, 9]]), 12)
    assert mesh.numbers.tolist() == [3, 7, 9] and mesh.triangles.tolist() == [[1, 0, 2]]


def test_stretch():
    from pliant.view.contours import stretch

    x = VERTICES.astype(np.float32)
    sheared = x * np.array([1.2, 1, 1], np.float32)
    assert np.allclose(stretch(x, sheared, TRIANGLES[6:8]), [1, 1, 1.2, 1.2, 1, 1, 1.2, 1.2], atol=1e-5), "the upper side, and no triangle elsewhere"
    turned = x @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]], np.float32)
    assert np.allclose(stretch(x, turned, TRIANGLES), 1, atol=1e-5)


def test_the_scene_is_remembered():
    from pliant.view import scene_of

    scene = {"format": "pliant-scene/1", "bodies": [{"name": "b", "surface": "memory:0", "lattice": {"spacing": 0.02}, "material": {"young": 1, "poisson": 0}}]}
    world = pliant.World(scene, [(VERTICES, TRIANGLES)], backend="cpu")
    scene["bodies"][0]["material"]["young"] = 7
    assert scene_of(world)["bodies"][0]["material"]["young"] == 1
    here = os.getcwd()
    os.chdir(os.path.join(SOURCE, "scenes"))
    world = pliant.World(scene="cube.json", backend="cpu")
    os.chdir(here)
    assert scene_of(world)["bodies"][0]["material"]["young"] > 0
    assert len(pliant._scenes) == 1, "the first World is gone, and its scene with it"


# --- the page ----------------------------------------------------------------------------------------------------------------
def test_the_surface_moves():
    with Opened(block()) as (view, visitor):
        skin = visitor.nodes["/bodies/block/skin"]
        assert np.allclose(np.sort(skin["vertices"], axis=0), np.sort(VERTICES, axis=0), atol=1e-6) and len(skin["faces"]) == 12
        visitor.press("Play")
        wait_for("motion", lambda: visitor.nodes["/bodies/block/skin"]["vertices"][:, 1].max() < 0.0795)
        wait_for("the clock", lambda: re.search(r"\*\*0\.[1-9]\d s\*\*.*\(playing\)", visitor.text()))
        wait_for("the rates", lambda: re.search(r"0\.\d\d of real time, [1-9]\d* pictures/s", visitor.text()))
        visitor.press("Pause")
        wait_for("the pause", lambda: "(paused)" in visitor.text() and not view.do(lambda w: w.busy()))
        before = view.do(lambda w: w.time)
        time.sleep(0.2)
        assert view.do(lambda w: w.time) == before
        visitor.press("Step")
        step = 2 * view.do(lambda w: w.dt)
        after = wait_for("the step", lambda: view.do(lambda w: w.time if w.time > before + 1 / 30 - step and not w.busy() else 0))
        assert after < before + 1 / 30 + step
        x = view.do(lambda w: w.frame().positions)
        wait_for("the picture", lambda: np.isclose(visitor.nodes["/bodies/block/skin"]["vertices"][:, 1].max(), x[:, 1].max(), atol=1e-7))
        visitor.press("Reset")
        wait_for("the start", lambda: "**0.00 s**, step 0" in visitor.text() and np.isclose(visitor.nodes["/bodies/block/skin"]["vertices"][:, 1].max(), 0.08))
        assert not visitor.notifications and not view.messages


def test_fields():
    world = block()
    world.advance(0.2)
    with Opened(world) as (view, visitor):
        whole = area(world_frame(view).positions, world_frame(view).triangles)
        for field, unit in (("displacement", " m"), ("stretch of the surface", " "), ("speed", " m/s"), ("von Mises stress", " Pa")):
            visitor.set("colours", field)
            wait_for("its legend", lambda: re.search(rf"<span>[\d.e-]+{unit}</span><span>most: ", visitor.text()))
            wait_for("its bands", lambda: not visitor.shown("/bodies/") and visitor.shown("/field/"))
            if field == "displacement":
                bands = wait_for("all of them", lambda: len(visitor.shown("/field/")) == 12 and visitor.shown("/field/"))
                wait_for("the bands to be the surface", lambda: np.isclose(sum(area(b["vertices"], b["faces"]) for b in visitor.shown("/field/").values()),
                                                                           whole, rtol=1e-4))
                highest = view.page.surface.bands[-1].name
                assert bands[highest]["vertices"][:, 1].min() > 0.06, "the clamped side moves least"
        visitor.set("colours", "tissue")
        wait_for("tissue", lambda: visitor.shown("/bodies/") and not visitor.shown("/field/"))
        assert "most:" not in visitor.text()


def world_frame(view):
    return view.do(lambda w: w.frame())


def test_a_gizmo_drives_its_tool():
    with Opened(block()) as (view, visitor):
        wait_for("the tool", lambda: visitor.shown("/tools/ball") and visitor.shown("/gizmos/ball"))
        assert np.allclose(np.linalg.norm(visitor.nodes["/tools/ball"]["vertices"], axis=1), 0.02)
        wait_for("its place", lambda: np.allclose(visitor.nodes["/gizmos/ball"]["position"], [0.05, 0.13, 0.03]))
        visitor.drag("ball", [0.05, 0.09, 0.03], wxyz=[np.sqrt(0.75), 0, 0.5, 0])
        wait_for("the hand", lambda: "ball" in view.page.tools.all and view.page.tools.all["ball"].target is not None)
        visitor.press("Step")
        wait_for("the step", lambda: view.do(lambda w: w.time > 0.03 and not w.busy()))
        after = view.do(lambda w: w.tool_forces()["ball"]["position"])
        size = np.linalg.norm([0.1, 0.08, 0.06])
        assert 0.9 < (0.13 - after[1]) / (1.2 * size / 30) < 1.01, "a hand is not faster than that"
        visitor.press("Play")
        for key, there in (("position", [0.05, 0.09, 0.03]), ("turn", [0, 0.5, 0, np.sqrt(0.75)])):
            wait_for(f"its {key}", lambda: np.allclose(view.do(lambda w: w.tool_forces()["ball"][key]), there, atol=1e-6))
        wait_for("its picture", lambda: np.allclose(visitor.nodes["/tools/ball"]["position"], [0.05, 0.09, 0.03], atol=1e-6))
        wait_for("its force", lambda: re.search(r"force (0\.0*[1-9]|[1-9])", visitor.text()))
        wait_for("its trace", lambda: any(part.get("height") == 120 and len(part["data"]) == 2 for part in list(visitor.gui.values())))
        view.do(lambda w: w.park_tool("ball"))
        wait_for("parking", lambda: not visitor.shown("/tools/ball") and not visitor.shown("/gizmos/ball") and "parked" in visitor.text())


def test_tools_come_and_go():
    with Opened(block()) as (view, visitor):
        visitor.send("GuiUpdateMessage", uuid=visitor.part("Add a probe"), updates={"value": True})
        wait_for("the probe", lambda: "/tools/probe" in visitor.nodes)
        wait_for("its place above the tissue", lambda: visitor.nodes["/tools/probe"]["position"][1] > 0.08)
        wait_for("its stand", lambda: np.allclose(visitor.nodes["/tools/probe"]["wxyz"], [np.sqrt(0.5), -np.sqrt(0.5), 0, 0], atol=1e-6))
        view.do(lambda w: w.remove_tool("ball"))
        wait_for("the ball to go", lambda: "/tools/ball" not in visitor.nodes)
        visitor.press("Reset")
        wait_for("the tools of the scene", lambda: "/tools/ball" in visitor.nodes and "/tools/probe" not in visitor.nodes)
        assert not view.messages


def test_a_cut_by_two_clicks():
    with Opened(block()) as (view, visitor):
        button = visitor.part("Cut: two clicks")
        before = len(world_frame(view).triangles)
        visitor.send("GuiUpdateMessage", uuid=button, updates={"value": True})
        wait_for("the blade", lambda: visitor.gui[button]["label"] == "Cancel the cut")
        eye = np.array([0.05, 0.04, 0.4])
        for aim in ([0.03, 0.045, 0.06], [0.3, 0.045, 0.06]):  # from inside the front to beside it, 4.5 cm above the ground
            visitor.click(list(eye), list(np.array(aim) - eye))
        wait_for("the cut", lambda: len(world_frame(view).triangles) > before)
        assert view.do(lambda w: w.pieces()) == 1, "it does not reach the other side"
        wait_for("its picture", lambda: "/bodies/block/cut" in visitor.shown("/bodies/"))
        wait_for("its end", lambda: visitor.gui[button]["label"] == "Cut: two clicks" and "/first_click" not in visitor.nodes)
        inside = visitor.nodes["/bodies/block/cut"]["vertices"]  # made by the message that made the node
        assert np.allclose(inside[:, 1], 0.0445, atol=0.003) and inside[:, 0].min() > 0.015, "in the plane through the eye and both clicks"
        visitor.send("GuiUpdateMessage", uuid=button, updates={"value": True})
        wait_for("the blade", lambda: visitor.gui[button]["label"] == "Cancel the cut")
        for aim in ([-0.1, 0.045, 0.06], [0.06, 0.045, 0.06]):
            visitor.click(list(eye), list(np.array(aim) - eye))
        wait_for("two pieces", lambda: view.do(lambda w: w.pieces()) == 2 and "2 pieces" in visitor.text())
        whole = world_frame(view)

        def drawn():
            parts = [visitor.nodes[f"/bodies/block/{part}"] for part in ("skin", "cut")]
            return all(part["faces"].max() == len(part["vertices"]) - 1 for part in parts) and \
                np.isclose(sum(area(part["vertices"], part["faces"]) for part in parts), area(whole.positions, whole.triangles), rtol=1e-5)

        wait_for("both pieces to be drawn", drawn)
        visitor.press("Reset")
        wait_for("the whole block", lambda: "/bodies/block/cut" not in visitor.shown("/bodies/") and "pieces" not in visitor.text())
        assert not view.messages


def test_a_shallow_cut():
    with Opened(block()) as (view, visitor):
        visitor.set("depth", 0.1)  # of 14 cm
        button = visitor.part("Cut: two clicks")
        visitor.send("GuiUpdateMessage", uuid=button, updates={"value": True})
        wait_for("the blade", lambda: visitor.gui[button]["label"] == "Cancel the cut")
        for x in (-0.2, 0.3):
            visitor.click([x, 0.04, 0.5], [0, 0, -1])
        visitor_cut = wait_for("the cut", lambda: visitor.shown("/bodies/").get("/bodies/block/cut"))
        assert 0.06 - 0.0142 - 0.011 < visitor_cut["vertices"][:, 2].min(), "whole cells as deep as the blade"
        assert view.do(lambda w: w.pieces()) == 1


def test_sliders():
    with Opened(block()) as (view, visitor):
        stable = view.do(lambda w: w.stable_dt)
        visitor.set("Young [Pa]", 12000)
        wait_for("a stiffer block", lambda: view.do(lambda w: w.stable_dt) < 0.6 * stable)
        visitor.set("gravity [m/s²]", 0)
        wait_for("the change", lambda: all(s.applied == s.wanted for s in view.page.panel.sliders) and view.page.panel.sliders[0].applied == 0)
        visitor.press("Step")
        wait_for("the step", lambda: view.do(lambda w: w.time) > 0.03)
        fallen = np.abs(view.do(lambda w: w.displacements())).max()
        assert fallen < 0.1 * 9.81 / 30**2 / 2, "nothing falls but with the speed that the first step had already"
        visitor.press("Reset")
        for label, value in (("Young [Pa]", 3000), ("gravity [m/s²]", 9.81)):
            wait_for("the first values", lambda: visitor.gui[visitor.part(label)]["value"] == value)
        assert np.isclose(view.do(lambda w: w.stable_dt), stable)
        assert not view.messages


def test_errors_are_told_and_the_world_goes_on():
    with Opened(block()) as (view, visitor):
        button = visitor.part("Cut: two clicks")
        visitor.send("GuiUpdateMessage", uuid=button, updates={"value": True})
        wait_for("the blade", lambda: visitor.gui[button]["label"] == "Cancel the cut")
        for _ in range(2):
            visitor.click([5, 5, 5], [0, 0, 1])
        wait_for("the notification", lambda: visitor.notifications == ["no tissue lies between the two clicks"])
        slider = view.page.panel.sliders[1]
        slider.change = lambda value: {"body": "block", "material": {"young": -value}}
        visitor.set("Young [Pa]", 4000)
        wait_for("the refusal", lambda: len(visitor.notifications) == 2 and "young" in visitor.notifications[1])
        wait_for("the old value", lambda: visitor.gui[visitor.part("Young [Pa]")]["value"] == 3000)
        view.ask(lambda: view.world.add_tool({**BALL, "name": "inside", "path": [[0, 0.05, 0.04, 0.03]]}))
        visitor.press("Play")
        wait_for("another", lambda: any("begins inside body 'block'" in text for text in visitor.notifications))
        now = view.do(lambda w: w.time)
        wait_for("the World to go on", lambda: view.do(lambda w: w.time) > now + 0.1)
    with Opened(block(dt=0.05), play=True) as (view, visitor):
        wait_for("the divergence", lambda: any("diverged" in text for text in view.messages) and "(paused)" in visitor.text())
        visitor.press("Reset")
        wait_for("the start", lambda: "step 0" in visitor.text())
        assert view.running


def test_a_slow_scene_does_not_hold_up_the_page():
    """A thirtieth of a second has 333,333 steps here, and takes many seconds. Time is counted in what is simulated meanwhile."""
    with Opened(block(dt=1e-7)) as (view, visitor):
        for button in ("Play", "Pause", "Step"):
            start, pictures = view.do(lambda w: w.time), view.pictures
            visitor.press(button)
            for _ in range(5 if button != "Pause" else 0):
                before = view.do(lambda w: w.time)
                wait_for("steps", lambda: view.do(lambda w: w.time) > before)
            wait_for("the word", lambda: ("(playing)" if button == "Play" else "(paused)") in visitor.text())
            wait_for("pictures", lambda: button == "Pause" or view.pictures > pictures + 2)
            answered = view.do(lambda w: (w.wait(), w.time)[1])
            assert answered - start < 1 / 300, f"{button}: {answered - start} s were simulated before the page answered"
        visitor.press("Reset")
        wait_for("the start", lambda: "**0.00 s**, step 0" in visitor.text())


def test_who_calls_the_world():
    world = block()
    view = world.show(free_port(), block=False, play=False)
    assert view.do(lambda w: w.info["nodes"]) == view.do(lambda w: view.do(lambda v: v.info["nodes"]))
    for error, call in ((ZeroDivisionError, lambda w: 1 / 0), (pliant.Error, lambda w: w.step(-1))):
        try:
            view.do(call)
        except error:
            continue
        raise AssertionError(f"no {error}")
    assert view.url in view._repr_html_()
    second = block().show(int(view.url.split(":")[-1]), block=False)
    assert second.url != view.url, "the next free port"
    second.stop()
    view.stop()
    view.stop()
    with socket.socket() as s:
        assert s.connect_ex(("127.0.0.1", int(view.url.split(":")[-1]))) != 0, "the page is gone"
    assert not view.running and world.step(1).done == 1, "the World is free again"
    try:
        view.do(lambda w: w.time)
    except RuntimeError as error:
        assert "call the World itself" in str(error)


def test_only_this_machine():
    view = block().show(free_port(), block=False, play=False)
    port = int(view.url.split(":")[-1])
    page = urllib.request.urlopen(view.url).read().decode()
    assert not re.search(r"<(?:script|link|img)[^>]+(?:src|href)=[\"']?(?:https?:)?//", page), "nothing is loaded from elsewhere"
    with socket.socket() as s:
        assert s.connect_ex(("127.0.0.2", port)) != 0, "nor does it listen on any other address"
    view.stop()


def test_a_program_that_ends():
    done = python("-c", "import pliant, time; v = pliant.World('scenes/cube.json', backend='cpu').show(block=False); time.sleep(1); print('end')", cwd=SOURCE)
    assert done.returncode == 0 and done.stdout == "end\n", done.stdout


def test_the_command():
    done = python("-m", "pliant", "no/such/scene.json")
    assert done.returncode == 2 and done.stdout.count("\n") == 1 and "no/such/scene.json" in done.stdout, done.stdout
    port = free_port()
    process = subprocess.Popen([sys.executable, "-m", "pliant", os.path.join(SOURCE, "scenes/cube.json"), "--backend", "cpu", "--port", str(port)],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    line = process.stdout.readline()
    assert line == f"pliant: http://127.0.0.1:{port} (Control-C ends it)\n", line
    visitor = Visitor(f"http://127.0.0.1:{port}")
    wait_for("the clock", lambda: re.search(r"\*\*0\.[1-9]\d s\*\*", visitor.text()))
    process.send_signal(2)
    assert process.wait(30) == 0 and process.stdout.read() == ""


if __name__ == "__main__":
    say_what_is_missing()
    try:
        import viser  # noqa: F401
    except ImportError:
        print("skipped: viser is not installed (pip install viser)")
        sys.exit(77)
    run_all(globals(), sys.argv[1:])
