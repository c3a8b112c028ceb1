"""The page of World.show() in Chromium, steered by its DevTools protocol: what is drawn, real clicks, and that nothing is loaded from elsewhere.

Skipped without NumPy, viser or Chromium. `test_browser.py --picture FILE.png` takes the picture of docs/embedding.md.
"""
import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request

from visitor import SOURCE, free_port, run_all, wait_for  # first: it skips without NumPy

import numpy as np

import pliant

CHROMIUM = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)


class Browser:
    def __init__(self, url, width=1100, height=720):
        from websockets.sync.client import connect

        self.folder, port, self.number, self.events = tempfile.mkdtemp(prefix="pliant-browser-"), free_port(), 0, []
        self.process = subprocess.Popen(
            [CHROMIUM, "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
             f"--window-size={width},{height}", f"--remote-debugging-port={port}", f"--user-data-dir={self.folder}",
             "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1", "about:blank"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def pages():
            try:
                return [p for p in json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json")) if p["type"] == "page"]
            except OSError:
                return None

        self.socket = connect(wait_for("Chromium", pages)[0]["webSocketDebuggerUrl"], max_size=None)
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        for domain in ("Network", "Runtime"):
            self.call(f"{domain}.enable")
        self.call("Page.navigate", url=url)

    def call(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while (answer := json.loads(self.socket.recv())).get("id") != self.number:
            self.events.append(answer)
        assert "error" not in answer, answer
        return answer["result"]

    def run(self, script):
        return self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)["result"].get("value")

    def text(self):
        return self.run("document.body.innerText") or ""

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", **more)

    def click(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, clickCount=1, buttons=1)
        self.mouse("mouseReleased", x, y, clickCount=1)

    def press(self, label):
        self.click(*wait_for(label, lambda: self.run(f"""(() => {{
            const button = [...document.querySelectorAll("button, label")].find(b => b.innerText.trim() == {json.dumps(label)});
            if (!button) return null;
            const box = button.getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2];
        }})()""")))

    def close(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def test_a_liver_is_drawn_and_cut():
    world = pliant.World(os.path.join(SOURCE, "scenes/liver.json"), backend="cpu", interactive=True, cutting=True)
    view = world.show(free_port(), block=False, play=False)
    browser = Browser(view.url)
    try:
        wait_for("the panel", lambda: "Cut: two clicks" in browser.text() and "(paused)" in browser.text())
        wait_for("the visitor", lambda: view.server.get_clients())
        middle, red = wait_for("the liver", lambda: liver(browser))
        assert red > 0.05, "it fills a part of the picture"
        before = len(view.page.frame.triangles)
        browser.press("Cut: two clicks")
        wait_for("the blade", lambda: "Cancel the cut" in browser.text())
        for dy in (-250, 250):  # from above to below, through its middle
            browser.click(middle[0], middle[1] + dy)
            time.sleep(0.3)
        wait_for("the cut", lambda: len(view.page.frame.triangles) > before)
        wait_for("its pieces", lambda: "2 pieces" in browser.text())
        browser.press("Step")
        wait_for("the step", lambda: "0.03 s" in browser.text())
        urls = [e["params"]["request"]["url"] for e in browser.events if e["method"] == "Network.requestWillBeSent"]
        assert urls and all(url.startswith((view.url, "data:", f"blob:{view.url}")) for url in urls), urls
        wrong = [e["params"]["exceptionDetails"] for e in browser.events if e["method"] == "Runtime.exceptionThrown"]
        assert not wrong and not view.messages, (wrong, view.messages)
    finally:
        browser.close()
        view.stop()


def test_a_gizmo_is_dragged():
    world = pliant.World(os.path.join(SOURCE, "scenes/palpate_tumour.json"), backend="cpu", interactive=True)
    view = world.show(free_port(), block=False, play=False)
    browser = Browser(view.url)
    try:
        wait_for("the panel", lambda: "probe" in browser.text() and "(paused)" in browser.text())
        camera = wait_for("the visitor", lambda: list(view.server.get_clients().values()))[0].camera
        start = np.array(view.page.tools.all["probe"].gizmo.position)
        arrow = start + [0.9 * view.page.tools.all["probe"].gizmo.scale, 0, 0]

        def on_screen(point):
            w, u = camera.wxyz[0], -camera.wxyz[1:]  # from space to the camera, whose z looks forward and whose y looks down
            x, y, z = (v := point - camera.position) + 2 * np.cross(u, np.cross(u, v) + w * v)
            focus = camera.image_height / 2 / np.tan(camera.fov / 2)
            return float(camera.image_width / 2 + focus * x / z), float(camera.image_height / 2 + focus * y / z)

        def dragged():
            (x, y), (to_x, to_y) = on_screen(arrow), on_screen(arrow + [0.01, 0, 0])
            browser.mouse("mouseMoved", x, y)
            browser.mouse("mousePressed", x, y, clickCount=1, buttons=1)
            for share in (0.3, 0.6, 1.0):
                browser.mouse("mouseMoved", x + share * (to_x - x), y + share * (to_y - y), buttons=1)
            browser.mouse("mouseReleased", to_x, to_y, clickCount=1)
            return view.page.tools.all["probe"].target

        target, _ = wait_for("the gizmo to be drawn and dragged", dragged)
        assert np.allclose(target[1:], start[1:], atol=1e-6) and 0.001 < target[0] - start[0] < 0.02, "along its arrow"
        browser.press("Play")
        wait_for("the tool", lambda: np.allclose(view.do(lambda w: w.tool_forces()["probe"]["position"]), target, atol=1e-6))
    finally:
        browser.close()
        view.stop()


def picture(file):
    world = pliant.World(os.path.join(SOURCE, "scenes/liver_on_table.json"), interactive=True, cutting=True)
    world.advance(1.05)
    view = world.show(free_port(), block=False)
    browser = Browser(view.url, 1060, 640)
    view.page.surface.choice.value = view.page.surface.field = "displacement"
    wait_for("the cut", lambda: view.do(lambda w: w.time) > 1.6)
    browser.run("document.querySelector('.mantine-Notification-closeButton')?.click()")  # viser's, about drawing without a graphics card
    time.sleep(15)  # the picture is faded in, slowly where there is no graphics card
    with open(file, "wb") as out:
        out.write(base64.b64decode(browser.call("Page.captureScreenshot", format="png")["data"]))
    browser.close()
    view.stop()


def liver(browser):
    """Its middle in the picture, and the share of the picture that it fills; nothing before it is drawn. The page itself decodes the picture."""
    shot = browser.call("Page.captureScreenshot", format="png")["data"]
    found = browser.run(f"""(async () => {{
        const image = await createImageBitmap(await (await fetch("data:image/png;base64,{shot}")).blob());
        const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
        context.drawImage(image, 0, 0);
        const width = 700, data = context.getImageData(0, 0, width, image.height).data, columns = [], rows = [];
        for (let i = 0; i < data.length; i += 4) if (data[i] > data[i + 1] + 40 && data[i] > data[i + 2] + 40)
            columns.push(i / 4 % width), rows.push(Math.floor(i / 4 / width));
        const middle = list => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];
        return [middle(columns) || 0, middle(rows) || 0, columns.length / (data.length / 4)];
    }})()""")
    return ((found[0], found[1]), found[2]) if found[2] > 0.02 else None


if __name__ == "__main__":
    try:
        import viser  # noqa: F401
    except ImportError:
        print("skipped: viser is not installed (pip install viser)")
        sys.exit(77)
    if CHROMIUM is None:
        print("skipped: Chromium is not installed (Debian: chromium)")
        sys.exit(77)
    if sys.argv[1:2] == ["--picture"]:
        picture(sys.argv[2])
    else:
        run_all(globals(), sys.argv[1:])
