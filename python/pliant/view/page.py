"""What is on the page: the scene in space, and the panel beside it."""
import time

import numpy as np

from pliant.view.blade import Blade, sheet
from pliant.view.panel import Panel, against_gravity
from pliant.view.surface import Surface
from pliant.view.tools import Tools, probe

STATUS_EVERY = 0.25  # [s]
RATE_OVER = 1.0  # [s] over which the real-time factor and the pictures are counted


class Page:
    def __init__(self, view, scene):
        self.view, self.world, server = view, view.world, view.server
        frame = self.world.frame()
        low, high = frame.positions.min(axis=0).astype(float), frame.positions.max(axis=0).astype(float)
        self.size, self.up = float(np.linalg.norm(high - low)), against_gravity(scene)
        self._look(server, scene, low, high)
        gui = server.gui
        gui.configure_theme(show_logo=False, show_share_button=False, control_width="medium", brand_color=(150, 50, 45))
        gui.main_panel.dock_right()
        self.panel = Panel(gui, scene, lambda button: view.ask(lambda: view.press(button)))
        self.surface = Surface(server, [body["name"] for body in self.world.info["bodies"]])
        self.surface.add_gui(gui)
        self.blade = Blade(server, self.size, view.ask, self.hit, self.cut)
        self.blade.add_gui(gui)
        self.tools = Tools(server, scene, self.size)
        self.tools.add_gui(gui, lambda: view.ask(self.add_probe))
        self.panel.add_sliders(gui, time.perf_counter)
        self.counted, self.speed, self.rate, self.pieces, self.version = None, 0.0, 0.0, 1, frame.topology_version
        self.frame, self.shown = frame, 0.0

    def _look(self, server, scene, low, high):
        """Camera, light and ground."""
        given = scene.get("view", {})
        target = np.array(given.get("target", (low + high) / 2), float)
        server.scene.set_up_direction(tuple(self.up))
        camera = server.initial_camera
        camera.fov = np.deg2rad(given.get("field_of_view", 30))
        beside = np.cross(self.up, [0, 0, 1]) if abs(self.up[2]) < 0.9 else np.array([1.0, 0, 0])
        front = np.cross(beside, self.up)
        away = self.size / np.tan(camera.fov / 2) * 0.8
        camera.position = np.array(given.get("eye", target + away * (front + 0.4 * self.up) / np.sqrt(1.16)), float)
        # Two lights that leave the colours of a field as the legend shows them.
        server.scene.configure_default_lights(False)
        server.scene.add_light_ambient("/lights/all", intensity=1.1)
        server.scene.add_light_directional("/lights/above", intensity=1.9, position=tuple(0.5 * front + self.up + 0.4 * beside))
        camera.look_at, camera.near, camera.far = target, 0.02 * self.size, 100 * self.size
        axis = int(np.abs(self.up).argmax())
        if abs(self.up[axis]) > 0.999 and not any("half_space" in tool.get("shape", {}) for tool in scene.get("tools", [])):
            ground = (low + high) / 2
            ground[axis] = (low if self.up[axis] > 0 else high)[axis] - 0.02 * self.size * self.up[axis]
            server.scene.add_grid("/ground", 3 * self.size, 3 * self.size, plane=("yz", "xz", "xy")[axis], cell_size=self.size / 10,
                                  section_size=self.size / 2, position=ground)

    def collect(self, seen, now):
        """Of the World, in the thread that steps it: the new frame, and what the other thread needs to draw it."""
        values = self.surface.values(self.world)
        frame, (_, vertices), (_, triangles) = self.world.frame_since(seen)
        if frame.topology_version != self.version:
            self.version = frame.topology_version
            self.pieces = sum(self.world.pieces(body) for body in range(len(self.world.info["bodies"])))
        self.frame = frame
        return frame, seen is None or vertices + triangles > 0, values, *self.tools.collect(self.world, now)

    def draw(self, collected, now):
        """In the thread that draws."""
        frame, moved, values, forces, surfaces = collected
        self.surface.draw(frame, moved, values)
        self.tools.draw(forces, surfaces, frame.time, now)
        if now - self.shown > STATUS_EVERY:
            self.shown = now
            self._count(frame.time, now)
            self.panel.show("playing" if self.view.playing else "paused", frame.time, frame.step, self.speed, self.rate, self.pieces)

    def _count(self, time, now):
        state = now, time, self.view.pictures
        if self.counted is None or time < self.counted[1]:
            self.counted = state
        elif now - self.counted[0] >= RATE_OVER:
            wall, simulated, pictures = (a - b for a, b in zip(state, self.counted))
            self.counted, self.speed, self.rate = state, simulated / wall, pictures / wall

    # --- requests: in the thread of the page -----------------------------------------------------------------------------------
    def cut(self, clicks, depth):
        """clicks: two rays; depth [m] below the surface, or infinity."""
        self.world.cut(sheet(self.hit, clicks, self.size, depth))

    def hit(self, origin, direction):
        """How far along a ray the tissue is, or infinity."""
        picked = self.world.pick(origin, direction)
        return np.inf if picked is None else picked["distance"]

    def add_probe(self):
        x = self.frame.positions
        above = x[(x @ self.up).argmax()] + 0.06 * self.size * self.up
        self.world.add_tool(probe(self.world.tool_forces(), above, self.up, self.size))

    def go_back(self):
        self.panel.go_back()
        self.tools.let_go()
        self.surface.stale, self.counted, self.pieces = True, None, 1
