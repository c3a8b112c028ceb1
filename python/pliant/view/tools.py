"""Rigid tools on the page: their surfaces, a gizmo that drives each of them, and the force that it feels."""
import collections

import numpy as np

STEEL = (170, 178, 188)
HAND_SPEED = 1.2  # [sizes/s] farthest that a tool follows its gizmo in simulated time: a jump would be refused with tissue in the way
HAND_TURN = 6.0  # [rad/s] likewise
TRACE = 5.0  # [s] of simulated time in a plot
PLOT_EVERY = 0.2  # [s] between two updates of a plot
LOOK_EVERY = 0.1  # [s] between two looks at the shapes, which sequences and World.set_tool_mesh change


def rotated(turn, v):
    """turn: a quaternion x y z w."""
    u, w = np.asarray(turn[:3]), turn[3]
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


def wxyz(turn):
    return (turn[3], turn[0], turn[1], turn[2])


def towards(at, turn, to, to_turn, far, angle):
    """The pose on the way to another one that is at most so far and so many radians away, and whether that is the other one."""
    way, same = to - at, float(np.dot(turn, to_turn))
    to_turn = to_turn if same >= 0 else -to_turn
    length, angle_left = np.linalg.norm(way), 2 * np.arccos(min(1.0, abs(same)))
    share = min(1.0, far / max(length, 1e-30), angle / max(angle_left, 1e-30))
    mixed = turn + share * (to_turn - turn)
    return at + share * way, mixed / np.linalg.norm(mixed), share == 1.0


class Tool:
    def __init__(self, server, folder, name, surface, size):
        self.name, self.size, self.target, self.dragged = name, size, None, False
        vertices, triangles = surface
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        # A gizmo stands where the tool is held: at its origin, or in its middle where the origin is beside the tool.
        beside = np.any(low > 1e-9) or np.any(high < -1e-9)
        self.pivot = (low + high) / 2 if beside else np.zeros(3)
        flat = float((high - low).min()) < 1e-9 * size  # a half space: a table is seldom moved
        self.mesh = server.scene.add_mesh_simple(f"/tools/{name}", vertices, triangles, color=STEEL, side="double", opacity=0.6 if flat else None,
                                                 cast_shadow=False, receive_shadow=False)
        self.gizmo = server.scene.add_transform_controls(f"/gizmos/{name}", scale=0.25 * size, visible=False, depth_test=False, line_width=3.0)
        with folder:
            self.folder = server.gui.add_folder(name, expand_by_default=not flat)
        with self.folder:
            self.shown = server.gui.add_checkbox("gizmo", initial_value=not flat, hint="arrows and arcs that move and turn the tool")
            self.text = server.gui.add_markdown("")
            self.plot = server.gui.add_uplot(
                (np.array([0.0, 1.0]), np.zeros(2)), ({"label": "s"}, {"label": "N", "stroke": "#b03a2e", "width": 2}), height=120,
                scales={"x": {"time": False}, "y": {"range": (0.0, None)}}, legend={"show": False}, axes=({"size": 24}, {"size": 44}), padding=(6, 10, 0, 0))
        self.trace, self.plotted = collections.deque(), 0.0

        @self.gizmo.on_update
        async def _(event):
            self.dragged = {"start": True, "end": False}.get(event.phase, self.dragged)
            if event.phase == "update":
                w, x, y, z = (float(c) for c in event.target.wxyz)
                self.target = np.array(event.target.position, float), np.array([x, y, z, w])

    def drive(self, world, force, seconds):
        if self.target is None or force["parked"]:
            return
        to, to_turn = self.target
        at, turn, there = towards(force["position"], force["turn"], to - rotated(to_turn, self.pivot), to_turn, HAND_SPEED * self.size * seconds,
                                  HAND_TURN * seconds)
        try:
            world.drive_tool(self.name, at, turn, seconds)
        except Exception:
            self.target = None  # else the same is refused again in every frame
            raise
        if there and not self.dragged:
            self.target = None

    def draw(self, force, time, now):
        self.mesh.visible = not force["parked"]
        self.mesh.position, self.mesh.wxyz = force["position"], wxyz(force["turn"])
        self.gizmo.visible = self.shown.value and not force["parked"]
        if self.target is None and not self.dragged:
            self.gizmo.position, self.gizmo.wxyz = force["position"] + rotated(force["turn"], self.pivot), wxyz(force["turn"])
        newton = float(np.linalg.norm(force["force"]))
        if self.trace and time < self.trace[-1][0]:
            self.trace.clear()  # the World was reset
        if not self.trace or time > self.trace[-1][0]:
            self.trace.append((time, newton))
        while self.trace[0][0] < time - TRACE:
            self.trace.popleft()
        if now - self.plotted > PLOT_EVERY:
            self.plotted = now
            self.text.content = "parked" if force["parked"] else f"force {newton:.3g} N, depth {1e3 * force['penetration']:.2g} mm"
            if len(self.trace) > 1:
                self.plot.data = tuple(np.array(column) for column in zip(*self.trace))

    def remove(self):
        for handle in (self.mesh, self.gizmo, self.folder):
            handle.remove()


def _same(surface, other):
    return other is not None and all(np.array_equal(a, b) for a, b in zip(surface, other))


class Tools:
    def __init__(self, server, scene, size):
        """scene: a dict with the keys of a scene file."""
        self.server, self.size, self.all, self.looked = server, size, {}, 0.0
        self.surfaces = {}  # those that were drawn last
        self.fixed = {t.get("name") for t in scene.get("tools", []) if not {"sequence", "mesh"} & set(t.get("shape", {}))}  # their shapes never change

    def add_gui(self, gui, add_probe):
        self.folder = gui.add_folder("Tools")
        with self.folder:
            button = gui.add_button("Add a probe", hint="a rod above the tissue")

        @button.on_click
        async def _(_):
            add_probe()

    # --- in the thread that steps the World ------------------------------------------------------------------------------------
    def drive(self, world, seconds):
        """Brings the tools nearer to their gizmos, as far as a hand moves in these seconds."""
        forces = world.tool_forces()
        for name, tool in list(self.all.items()):
            if name in forces:
                tool.drive(world, forces[name], seconds)

    def collect(self, world, now):
        """What tools feel, and the surfaces of those that are new or have changed."""
        forces = world.tool_forces()
        look = now - self.looked > LOOK_EVERY
        self.looked = now if look else self.looked
        fresh = {name: world.tool_surface(name) for name in forces if name not in self.surfaces or (look and name not in self.fixed)}
        fresh = {name: surface for name, surface in fresh.items() if not _same(surface, self.surfaces.get(name))}
        self.surfaces = {name: fresh.get(name) or self.surfaces[name] for name in forces}
        return forces, fresh

    # --- in the thread that draws ----------------------------------------------------------------------------------------------
    def draw(self, forces, surfaces, time, now):
        for name in [n for n in self.all if n not in forces]:
            self.all.pop(name).remove()
        for name, surface in surfaces.items():
            if name in self.all:
                self.all[name].mesh.vertices, self.all[name].mesh.faces = surface
            else:
                self.all[name] = Tool(self.server, self.folder, name, surface, self.size)
        for name, force in forces.items():
            self.all[name].draw(force, time, now)

    def let_go(self):
        """The tools stay where they are, wherever their gizmos are."""
        for tool in self.all.values():
            tool.target = None


def probe(names, above, up, size):
    """An entry of `tools`: a rod that stands along `up`, its tip at `above`. names: those that are taken."""
    name = next(n for n in ("probe", *(f"probe {k}" for k in range(2, 1000))) if n not in names)
    z, radius = np.array([0.0, 0.0, 1.0]), 0.025 * size
    turn = np.append(np.cross(z, up), 1 + np.dot(z, up))  # the shortest rotation that takes z to up
    turn = turn / np.linalg.norm(turn) if np.linalg.norm(turn) > 1e-6 else np.array([1.0, 0.0, 0.0, 0.0])
    return {"name": name, "shape": {"capsule": [[0, 0, radius], [0, 0, 0.8 * size], radius]}, "friction": 0.3,
            "path": [[0, *map(float, above), *map(float, turn)]]}
