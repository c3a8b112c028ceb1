"""The panel of the page: buttons, what the clock says, and sliders for the parameters that the scene gives as numbers."""
import numpy as np

SETTLED = 0.15  # [s] that a slider rests before its value counts: a change of a material rebuilds the model
MOST_BODIES = 6  # with sliders


class Slider:
    def __init__(self, label, low, high, value, change):
        """change: gives the arguments of World.change for a value."""
        self.label, self.low, self.high, self.first, self.change = label, min(low, value), max(high, value), float(value), change
        self.applied, self.wanted, self.since = self.first, self.first, 0.0


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def against_gravity(scene):
    """The direction that is up, of unit length."""
    given = scene.get("view", {}).get("up") or [-g for g in acceleration(scene)]
    up = np.array(given, float)
    return up / np.linalg.norm(up) if np.linalg.norm(up) > 0 else np.array([0.0, 1.0, 0.0])


def acceleration(scene):
    gravity = scene.get("gravity", [0, 0, 0])
    return gravity["acceleration"] if isinstance(gravity, dict) else gravity


def sliders_of(scene):
    """scene: a dict with the keys of a scene file."""
    sliders = []
    gravity = np.array(acceleration(scene), float)
    size = float(np.linalg.norm(gravity))
    down = gravity / size if size > 0 else -against_gravity(scene)
    if not isinstance(scene.get("gravity"), dict):  # with a curve, a number would end the curve
        sliders.append(Slider("gravity [m/s²]", 0.0, 20.0, size, lambda v: {"gravity": [float(v * d) for d in down]}))
    for number, body in enumerate(scene.get("bodies", [])[:MOST_BODIES]):
        name = body.get("name", f"body{number}")
        several = len(scene["bodies"]) > 1

        def add(label, part, key, low, high, value):
            def change(v):
                return {"body": name, part: {key: v}}

            sliders.append(Slider(f"{label}, {name}" if several else label, low, high, value, change))

        material, model = body.get("material", {}), body.get("model", {})
        for key, label in (("young", "Young [Pa]"), ("mu", "mu [Pa]"), ("c10", "c10 [Pa]"), ("viscosity", "viscosity [Pa s]")):
            if is_number(material.get(key)) and material[key] > 0:
                add(label, "material", key, material[key] / 10, 4 * material[key], material[key])
        if is_number(material.get("damping", 0)):
            add("damping [1/s]", "material", "damping", 0.0, 100.0, material.get("damping", 0))
        for key in ("alpha", "ratio"):
            if is_number(model.get(key)):
                add(key, "model", key, 0.05, 1.0, model[key])
    return sliders


class Panel:
    def __init__(self, gui, scene, ask):
        """ask: takes "Play", "Pause", "Step" or "Reset"."""
        self.status = gui.add_markdown("")
        self.buttons = gui.add_button_group("", ("Play", "Pause", "Step", "Reset"), hint="Step: one picture, a thirtieth of a second")
        self.sliders = sliders_of(scene)

        @self.buttons.on_click
        async def _(event):
            ask(event.target.value)

    def add_sliders(self, gui, clock):
        """clock: gives the time [s] from which sliders count how long they rest."""
        with gui.add_folder("Parameters"):
            for slider in self.sliders:
                slider.handle = gui.add_slider(slider.label, slider.low, slider.high, (slider.high - slider.low) / 500, slider.first)
                slider.handle.on_update(self._listener(slider, clock))

    @staticmethod
    def _listener(slider, clock):
        async def listen(event):
            slider.wanted, slider.since = float(event.target.value), clock()

        return listen

    def apply(self, world, now):
        """Changes what sliders have been set to and then left alone; whether anything was."""
        any_changed = False
        for slider in self.sliders:
            if slider.wanted == slider.applied or now - slider.since < SETTLED:
                continue
            before, slider.applied = slider.applied, slider.wanted
            try:
                world.change(**slider.change(slider.wanted))
            except Exception:
                slider.applied = slider.wanted = slider.handle.value = before
                raise
            any_changed = True
        return any_changed

    def go_back(self):
        """After a reset, which takes back the changes."""
        for slider in self.sliders:
            slider.applied = slider.wanted = slider.handle.value = slider.first

    def show(self, state, time, step, speed, rate, pieces):
        lines = [f"**{time:.2f} s**, step {step} ({state})", f"{speed:.2f} of real time, {rate:.0f} pictures/s"]
        if pieces > 1:
            lines.append(f"{pieces} pieces")
        self.status.content = "  \n".join(lines)
