"""A World in the browser: pliant.World(...).show(). Needs viser: pip install "pliant[view]".

One thread steps the World, another draws; what is clicked on the page only leaves a request for the first. Nothing is loaded from elsewhere, and the page
is served to this machine alone unless `host` says otherwise.
"""
import atexit
import collections
import concurrent.futures
import contextlib
import html
import io
import json
import queue
import threading
import time
import traceback

import pliant

PICTURE = 1 / 30  # [s] between two pictures
LATE = 0.1  # [s] that a late picture may cost of the time to be simulated: beyond, the scene runs slower instead of ever later
LOOK = 0.004  # [s] between two looks at what is to be done
TELL_AGAIN = 5.0  # [s] for which a message is not repeated


def need_viser():
    """The module viser, or an ImportError that says how to get it."""
    try:
        import viser
    except ImportError:
        raise ImportError("showing a World in the browser needs viser: pip install \"pliant[view]\", or pip install viser") from None
    return viser


def scene_of(world):
    """What a World was made from, as a dict with the keys of a scene file; empty where that is not known."""
    scene = pliant._scenes.get(world, {})
    if isinstance(scene, dict):
        return scene
    try:
        with open(scene, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}  # it was moved since: the page has fewer sliders


def show(world, port=8080, *, host="127.0.0.1", block=True, play=True):
    """Opens a page that shows a World and steers it; the View, with its `url`.

    port: the next free one is taken from here on. block: until Control-C; otherwise a thread steps the World from now on, and who wants to
    call it meanwhile uses View.do. play: otherwise the scene stands until "Play" is pressed.
    """
    view = View(world, need_viser(), host, port, play)
    if not block:
        return view
    print(f"pliant: {view.url} (Control-C ends it)", flush=True)
    with contextlib.suppress(KeyboardInterrupt):
        while view.running:
            time.sleep(0.2)
    view.stop()
    return view


class View:
    """A page. `url`, `stop()`, `do(call)`; in a notebook it shows itself."""

    def __init__(self, world, viser, host, port, play):
        from pliant.view.page import Page

        self.world, self.playing, self.pictures = world, play, 0
        self.messages = collections.deque(maxlen=100)  # the newest that were told
        self._requests, self._stopping, self._single = queue.SimpleQueue(), threading.Event(), 0.0
        self._told_at, self._next_picture, self._seen = {}, 0.0, None
        self._due, self._last, self._batch, self._handed = 0.0, time.perf_counter(), 0.0, None
        with contextlib.redirect_stdout(io.StringIO()):  # viser prints a table
            self.server = viser.ViserServer(host=host, port=port, label="Pliant", verbose=False)
        self.server.request_share_url = lambda verbose=True: None  # nothing leaves the machine
        self.url = f"http://{'127.0.0.1' if host == '0.0.0.0' else host}:{self.server.get_port()}"
        try:
            self.page = Page(self, scene_of(world))
        except BaseException:
            self.server.stop()
            raise
        self._to_draw, self._drawn = queue.SimpleQueue(), threading.Event()
        self._drawn.set()
        self._thread = threading.Thread(target=self._run, name="pliant.view", daemon=True)
        self._painter = threading.Thread(target=self._paint, name="pliant.view.draw", daemon=True)
        self._thread.start()
        self._painter.start()
        atexit.register(self.stop)

    @property
    def running(self):
        return self._thread.is_alive()

    def stop(self):
        """Ends the page; the World is free again, at the step that it has reached."""
        atexit.unregister(self.stop)
        self._stopping.set()
        self._thread.join()
        self._to_draw.put(None)
        self._painter.join()
        with contextlib.redirect_stdout(io.StringIO()):
            self.server.stop()

    def do(self, call):
        """call(world) between two batches of steps, and what it gives or raises. From the thread of the page itself it is called at once."""
        if threading.current_thread() is self._thread:
            return call(self.world)
        if not self.running:
            raise RuntimeError("the page has been stopped: call the World itself")
        done = concurrent.futures.Future()

        def request():
            try:
                done.set_result(call(self.world))
            except BaseException as error:
                done.set_exception(error)

        self._requests.put(request)
        return done.result()

    def ask(self, request):
        """A function without arguments, for the thread of the page; does not wait. What it raises is told on the page."""
        self._requests.put(request)

    def tell(self, text):
        """A notification on every page that is open."""
        now = time.perf_counter()
        if now - self._told_at.get(text, -TELL_AGAIN) < TELL_AGAIN:
            return False
        self._told_at[text] = now
        self.messages.append(text)
        for client in self.server.get_clients().values():
            client.add_notification("Pliant", text, color="red", auto_close_seconds=12, with_close_button=True)
        return True

    def press(self, button):
        """"Play", "Pause", "Step" or "Reset"; in the thread of the page."""
        self.playing = button == "Play" or (button == "Reset" and self.playing)
        self._single = PICTURE if button == "Step" else 0.0  # [s] of it that are left
        if button == "Reset":
            self.world.reset()
            self._due, self._seen = 0.0, None
            self.page.go_back()

    def _repr_html_(self):
        return f'<iframe src="{html.escape(self.url)}" width="100%" height="600" frameborder="0"></iframe>'

    # --- the thread ------------------------------------------------------------------------------------------------------------
    def _run(self):
        while not self._stopping.wait(LOOK):
            now = time.perf_counter()
            for part in (self._answer, self._advance, self._draw):
                with self._errors_told():
                    part(now)
        with self._errors_told():
            self.world.wait()

    @contextlib.contextmanager
    def _errors_told(self):
        try:
            yield
        except pliant.Error as error:
            if error.code == 4:  # diverged
                self.playing = False
            self.tell(str(error))
        except ValueError as error:
            self.tell(str(error))
        except Exception as error:  # a defect; neither the page nor the World ends by it
            if self.tell(f"{type(error).__name__}: {error}"):
                traceback.print_exc()

    def _answer(self, now):
        """Requests that were left, and sliders."""
        while True:
            try:
                request = self._requests.get_nowait()
            except queue.Empty:
                break
            with self._errors_told():
                request()
            self._settle()
        with self._errors_told():
            if self.page.panel.apply(self.world, now):
                self._settle()

    def _settle(self):
        """While the scene stands, cuts and changes wait for a batch of no steps."""
        if not self.playing:
            self.world.step_async(0)

    def _advance(self, now):
        """Gives the worker as much of the due time as it simulates between two pictures, so that each shows something new."""
        self._due, self._last = min(self._due + now - self._last, LATE) if self.playing else 0.0, now
        if self.world.busy():
            return
        if self._handed is not None:  # towards batches that take as long as a picture, whatever a batch costs besides its steps
            self._batch *= min(max(PICTURE / (now - self._handed), 0.25), 2)
            self._handed = None
        # The first is a single step: a picture's worth of a slow scene may take minutes, for which the World would answer nothing.
        self._batch = min(max(self._batch, self.world.dt), PICTURE)
        if self._single > 0:
            seconds = min(self._single, self._batch)
        elif self.playing and self._due >= PICTURE:
            seconds = self._batch  # what is due beyond a picture stays due, so that the next one is not later
        else:
            return
        self.page.tools.drive(self.world, seconds)
        if self.world.advance_async(seconds):
            self._handed, self._due, self._single = now, max(self._due - seconds, 0.0), max(self._single - seconds, 0.0)

    def _draw(self, now):
        """Lets the other thread draw what is new, if it has finished the last picture."""
        if now < self._next_picture or not self._drawn.is_set():
            return
        self._next_picture = max(self._next_picture + PICTURE, now)
        collected = self.page.collect(self._seen, now)
        self.pictures += collected[0] is not self._seen
        self._seen = collected[0]
        self._drawn.clear()
        self._to_draw.put((collected, now))

    def _paint(self):
        while (picture := self._to_draw.get()) is not None:
            with self._errors_told(), self.server.atomic():
                self.page.draw(*picture)
            self._drawn.set()
