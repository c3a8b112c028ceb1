"""For the tests of the page: a small World, and a visitor that speaks with the page as a browser does."""
import socket
import threading
import time

from common import SOURCE, box  # first: exits where NumPy is missing
import numpy as np
import pliant

VERTICES, TRIANGLES = box(0.1, 0.08, 0.06)
BALL = {"name": "ball", "shape": {"sphere": 0.02}, "path": [[0, 0.05, 0.13, 0.03]]}


def block(**options):
    scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "tools": [BALL], "bodies": [{
        "name": "block", "surface": "memory:0", "lattice": {"spacing": 0.01},
        "material": {"young": 3000, "poisson": 0.45, "damping": 5}, "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}]}]}
    return pliant.World(scene, surfaces=[(VERTICES, TRIANGLES)], backend="cpu", **options)


def wait_for(what, condition):
    """Until the condition holds; what it gives."""
    end = time.monotonic() + 60
    while not (found := condition()):
        assert time.monotonic() < end, f"waited in vain for: {what}"
        time.sleep(0.02)
    return found


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Visitor:
    """Speaks as a browser does with the page: knows the nodes of its scene, the parts of its panel, and its notifications."""

    def __init__(self, url):
        import viser
        from websockets.sync.client import connect

        self.nodes, self.gui, self.notifications = {}, {}, []
        self.socket = connect(url.replace("http", "ws"), subprotocols=[f"viser-v{viser.__version__}"], max_size=None)
        self.send("ViewerCameraMessage", wxyz=[1, 0, 0, 0], position=[0, 0, 1], fov=1, near=0.01, far=10, image_height=400, image_width=400,
                  look_at=[0, 0, 0], up_direction=[0, 1, 0])
        threading.Thread(target=self.listen, daemon=True).start()

    def send(self, kind, **fields):
        import msgspec

        self.socket.send(msgspec.msgpack.encode({"type": kind, **fields}, enc_hook=float))

    def listen(self):
        import msgspec
        import zstandard
        from websockets.exceptions import ConnectionClosed

        try:
            for data in self.socket:
                size = int.from_bytes(data[8:16], "little")
                window = msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(data[16:16 + size]))
                at, buffers = (16 + size + 7) // 8 * 8, []
                for length in window["binaryBufferLengths"]:
                    buffers.append(data[at:at + length])
                    at = (at + length + 7) // 8 * 8
                for message in window["messages"]:
                    self.take(message, buffers)
        except ConnectionClosed:
            pass

    def take(self, message, buffers):
        def whole(value):
            if isinstance(value, dict) and "__binary_index" in value:
                return np.frombuffer(buffers[value["__binary_index"]], value["dtype"]).reshape(-1, 3)
            return value

        kind, name = message["type"], message.get("name")
        values = {key: whole(value) for key, value in {**message.get("props", {}), **message.get("updates", {})}.items()}
        if kind.startswith("Gui") and "uuid" in message:
            values.update({key: message[key] for key in ("value",) if key in message})
            self.gui.setdefault(message["uuid"], {}).update(values)
        elif kind == "NotificationShowMessage":
            self.notifications.append(values["body"])
        elif kind == "RemoveSceneNodeMessage":
            self.nodes.pop(name, None)
        elif name is not None:
            values.update({key: message[key] for key in ("position", "wxyz", "visible", "virtual") if key in message})
            self.nodes[name] = {**self.nodes.get(name, {"visible": True}), **values}

    def part(self, label):
        return wait_for(label, lambda: next((uuid for uuid, part in list(self.gui.items()) if part.get("label") == label), None))

    def set(self, label, value):
        self.gui[self.part(label)]["value"] = value
        self.send("GuiUpdateMessage", uuid=self.part(label), updates={"value": value})

    def press(self, button):
        group = next(uuid for uuid, part in list(self.gui.items()) if part.get("options") == ["Play", "Pause", "Step", "Reset"])
        self.send("GuiUpdateMessage", uuid=group, updates={"value": button})

    def text(self):
        """What the panel says."""
        return "\n".join(part.get("_markdown") or part.get("content") or "" for part in list(self.gui.values()) if part.get("visible", True))

    def drag(self, tool, position, wxyz=(1, 0, 0, 0)):
        name = f"/gizmos/{tool}"
        self.send("TransformControlsDragStartMessage", name=name)
        self.send("TransformControlsUpdateMessage", name=name, wxyz=wxyz, position=position)
        self.send("TransformControlsDragEndMessage", name=name)

    def click(self, origin, direction):
        self.send("ScenePointerMessage", event_type="click", ray_origin=origin, ray_direction=direction, screen_pos=[[0.5, 0.5]], modifier=None)

    def shown(self, prefix):
        return {name: node for name, node in list(self.nodes.items()) if name.startswith(prefix) and node["visible"] and not node.get("virtual")}


class Opened:
    """with Opened(world) as (view, visitor): a page that stands still, and who looks at it."""

    def __init__(self, world, **options):
        self.view = world.show(free_port(), block=False, **{"play": False, **options})
        self.visitor = Visitor(self.view.url)

    def __enter__(self):
        wait_for("the surface", lambda: self.visitor.shown("/bodies/"))
        return self.view, self.visitor

    def __exit__(self, *_):
        self.visitor.socket.close()
        self.view.stop()


def run_all(tests, chosen):
    """tests: the globals of a file; chosen: names of some, or none for all."""
    for name, test in list(tests.items()):
        if name.startswith("test_") and (not chosen or name in chosen):
            begun = time.monotonic()
            test()
            print(f"{name}: {time.monotonic() - begun:.1f} s", flush=True)
    print("ok")
