"""A cut by two clicks: the blade stands in the plane through both and the eye, and follows the surface between them."""
import numpy as np

RAYS = 24  # between the clicks
ABOVE = 0.15  # [sizes] where the blade begins before the surface: cells at the surface reach beyond it, and come apart only if the blade goes through
MARK = (250, 210, 60)


def sheet(hit, clicks, size, depth):
    """The triangles of the cut, [n, 3, 3]: as deep as `depth` [m] below the surface, or through everything if it is infinite.

    hit: the distance to the tissue along a ray; clicks: two rays, each its origin and its direction of unit length.
    """
    share = np.linspace(0, 1, RAYS)[:, None]
    (origin, _), (other_origin, _) = clicks
    eyes = origin + share * (other_origin - origin)
    rays = clicks[0][1] + share * (clicks[1][1] - clicks[0][1])
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    far = np.array([hit(eye, ray) for eye, ray in zip(eyes, rays)])
    met = np.isfinite(far)
    if not met.any():
        raise ValueError("no tissue lies between the two clicks")
    far = np.interp(share[:, 0], share[met, 0], far[met])  # beside the tissue as deep as at its edge
    below = 2 * size if np.isinf(depth) else depth
    near, deep = eyes + rays * np.maximum(far - ABOVE * size, 0)[:, None], eyes + rays * (far + below)[:, None]
    strips = [(near[:-1], near[1:], deep[1:]), (near[:-1], deep[1:], deep[:-1])]
    return np.concatenate([np.stack(corners, axis=1) for corners in strips])


class Blade:
    def __init__(self, server, size, ask, hit, cut):
        """ask: takes a request for the thread of the page; hit: the distance to the tissue along a ray; cut: takes two clicks and a depth [m]."""
        self.server, self.size, self.ask, self.hit, self.cut = server, size, ask, hit, cut
        self.clicks, self.listening, self.mark = [], False, None

    def add_gui(self, gui):
        with gui.add_folder("Blade"):
            self.button = gui.add_button("Cut: two clicks", hint="the cut goes from one click to the other, away from the eye")
            self.depth = gui.add_slider("depth", 0.02, 1.0, 0.02, 1.0, hint="below the surface, in sizes of the scene; 1: through everything")

        @self.button.on_click
        async def _(_):
            self.ask(self.stop if self.listening else self.start)

    def start(self):
        self.clicks, self.listening = [], True
        self.button.label = "Cancel the cut"
        self.server.scene.on_click()(self._clicked)

    def stop(self):
        if self.listening:
            self.server.scene.remove_click_callback(self._clicked)
        if self.mark is not None:
            self.mark.remove()
        self.mark, self.listening = None, False
        self.button.label = "Cut: two clicks"

    async def _clicked(self, event):
        origin, direction = np.array(event.ray_origin, float), np.array(event.ray_direction, float)
        self.ask(lambda: self.click(origin, direction / np.linalg.norm(direction)))

    def click(self, origin, direction):
        if not self.listening:
            return
        self.clicks.append((origin, direction))
        if len(self.clicks) == 1:
            far = self.hit(origin, direction)
            if np.isfinite(far):
                self.mark = self.server.scene.add_icosphere("/first_click", 0.008 * self.size, MARK, position=origin + far * direction)
            return
        clicks, depth = self.clicks, np.inf if self.depth.value >= 1 else self.depth.value * self.size
        self.stop()
        self.cut(clicks, depth)
