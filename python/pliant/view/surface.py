"""The surfaces of the bodies on the page: tissue with its cut faces, or a field as filled contours with its legend."""
import numpy as np

from pliant.view.contours import Mesh, filled, stretch

BANDS = 12
TISSUE = "tissue"
SKIN = [(186, 98, 84), (222, 178, 112), (168, 128, 160), (122, 150, 138)]  # of the first bodies; then again
CUT_FACE = (132, 24, 34)
# Dark blue to yellow, ever lighter: also printed in grey it can be read.
RAMP = np.array([(52, 30, 110), (44, 76, 156), (32, 122, 160), (48, 162, 140), (120, 194, 98), (208, 214, 66), (250, 232, 110)])
OUTLIERS = 0.003  # share of the vertices at either end of a field that the range may leave out
SINKS = 0.98  # the range follows a smaller field by this factor in each picture, so that colours do not flicker


def colour(band):
    """Of a band, as three whole numbers."""
    at = band / (BANDS - 1) * (len(RAMP) - 1)
    return tuple(int(round(np.interp(at, range(len(RAMP)), RAMP[:, c]))) for c in range(3))


class Speed:
    """Of the vertices [m/s], from two frames."""

    def __init__(self):
        self.before, self.value = None, None

    def __call__(self, frame):
        if self.before is not None and frame.time > self.before.time:
            both = min(len(frame.positions), len(self.before.positions))  # a cut adds vertices at the end
            moved = np.linalg.norm(frame.positions[:both] - self.before.positions[:both], axis=1)
            self.value = moved / (frame.time - self.before.time)
        self.before = frame
        known = np.zeros(0) if self.value is None else self.value[:len(frame.positions)]
        return np.concatenate([known, np.zeros(len(frame.positions) - len(known))])


def fields():
    """By the words of the dropdown: a function of a frame that gives a number for each vertex, its unit, its value at rest."""
    return {
        "displacement": (lambda f: np.linalg.norm(f.positions - f.rest, axis=1), "m", 0.0),
        "speed": (Speed(), "m/s", 0.0),
        "stretch of the surface": (lambda f: stretch(f.rest, f.positions, f.triangles), "", 1.0),
    }


# By the words of the dropdown: the word of World.vertex_values, and its unit. They wait for the worker.
OF_WORLD = {"von Mises stress": ("mises", "Pa"), "contact pressure": ("pressure", "Pa"), "finite elements": ("finite_elements", "")}


class Nodes:
    """A mesh of the page that is made when it is first needed, and hidden while it is empty."""

    def __init__(self, scene, name, color):
        self.scene, self.name, self.color, self.handle = scene, name, color, None

    def show(self, vertices, triangles=None):
        """triangles: None keeps those that are there."""
        if self.handle is None:
            self.handle = self.scene.add_mesh_simple(self.name, vertices, triangles, color=self.color, side="double", cast_shadow=False,
                                                     receive_shadow=False)
            return
        self.handle.vertices = vertices
        if triangles is not None:
            self.handle.faces = triangles
        self.handle.visible = True

    def hide(self):
        if self.handle is not None:
            self.handle.visible = False


class Surface:
    def __init__(self, server, bodies):
        """bodies: their names."""
        self.scene = server.scene
        self.field, self.fields, self.range, self.legend = TISSUE, fields(), None, None
        self.tissue = [(Nodes(self.scene, f"/bodies/{name}/skin", SKIN[k % len(SKIN)]), Nodes(self.scene, f"/bodies/{name}/cut", CUT_FACE))
                       for k, name in enumerate(bodies)]
        self.bands = [Nodes(self.scene, f"/field/{k}", colour(k)) for k in range(BANDS)]
        self.meshes, self.version, self.stale = [], None, True

    def add_gui(self, gui):
        self.choice = gui.add_dropdown("colours", (TISSUE, *self.fields, *OF_WORLD), initial_value=TISSUE)
        self.legend = gui.add_html("", visible=False)

        @self.choice.on_update
        async def _(_):
            self.field, self.range, self.stale = self.choice.value, None, True

    def values(self, world):
        """The field of the World that was chosen, or None; before the frame is taken, in the thread that steps."""
        return world.vertex_values(OF_WORLD[self.field][0]) if self.field in OF_WORLD else None

    def draw(self, frame, moved, values):
        """moved: whether the frame differs from the one that was drawn last; values: see there."""
        stale, self.stale = self.stale, False
        if not moved and not stale:
            return
        if self.field == TISSUE:
            self._draw_tissue(frame, stale)
        elif self.field in self.fields:
            measure, unit, at_rest = self.fields[self.field]
            self._draw_field(frame, measure(frame), unit, at_rest)
        elif values is not None and len(values) == len(frame.positions):  # not while the choice is newer than the values
            self._draw_field(frame, values, OF_WORLD[self.field][1], 0.0)
        else:
            self.stale = True

    def _draw_tissue(self, frame, stale):
        others = stale or frame.topology_version != self.version
        if others:
            self.version, self.meshes = frame.topology_version, self._parts(frame)
            for node in self.bands:
                node.hide()
            self.legend.visible = False
        for nodes, meshes in zip(self.tissue, self.meshes):
            for node, mesh in zip(nodes, meshes):
                if len(mesh.triangles) == 0:
                    node.hide()
                else:
                    node.show(frame.positions[mesh.numbers], mesh.triangles if others else None)

    @staticmethod
    def _parts(frame):
        """Of each body the mesh of its skin and that of its cut faces: vertices that they share are two, so that the edge is sharp."""
        cut = frame.cut_faces.astype(bool) if len(frame.cut_faces) else np.zeros(len(frame.triangles), bool)
        parts = []
        for first, count in frame.body_triangles:
            triangles, on_cut = frame.triangles[first:first + count], cut[first:first + count]
            parts.append((Mesh(triangles[~on_cut], len(frame.positions)), Mesh(triangles[on_cut], len(frame.positions))))
        return parts

    def _draw_field(self, frame, values, unit, at_rest):
        # A few vertices, at the edge of a cut or under a tool, would take the colours from all others.
        low, high = (float(v) for v in np.quantile(values, (OUTLIERS, 1 - OUTLIERS)))
        low, high = min(low, at_rest), max(high, at_rest)
        if self.range is not None:
            low = min(low, at_rest + SINKS * (self.range[0] - at_rest))
            high = max(high, at_rest + SINKS * (self.range[1] - at_rest))
        self.range = low, high = low, max(high, low + 1e-9)
        points, bands = filled(frame.positions, frame.triangles, values, np.linspace(low, high, BANDS + 1)[1:-1])
        for nodes in self.tissue:
            for node in nodes:
                node.hide()
        for node, triangles in zip(self.bands, bands):
            if len(triangles) == 0:
                node.hide()
                continue
            mesh = Mesh(triangles, len(points))
            node.show(points[mesh.numbers], mesh.triangles)
        self._write_legend(low, high, float(values.max()), unit)

    def _write_legend(self, low, high, most, unit):
        strips = "".join(f"<div style='flex:1;background:rgb{colour(k)}'></div>" for k in range(BANDS))
        content = (f"<div style='padding:2px 12px 8px;font-size:12px'><div style='display:flex;height:14px'>{strips}</div>"
                   f"<div style='display:flex;justify-content:space-between'><span>{low:.3g} {unit}</span>"
                   f"<span>most: {most:.3g} {unit}</span><span>{high:.3g} {unit}</span></div></div>")
        if content != self.legend.content:
            self.legend.content = content
        self.legend.visible = True
