"""Soft-tissue deformation. SI units."""
import copy as _copy
import functools as _functools
import os as _os
import weakref as _weakref

from pliant._core import (DeviceCounts, DeviceLimits, DeviceWrench, Error, Frame, HapticDevice, HapticLoop, HapticSample, HapticState, ManualDevice,
                          StepReport, World, __version__, backends, open_haptic_device)
from pliant import _driver
from pliant._batch import Batch

__all__ = ["Batch", "DeviceCounts", "DeviceLimits", "DeviceWrench", "Error", "Frame", "HapticDevice", "HapticLoop", "HapticSample", "HapticState",
           "ManualDevice", "StepReport", "World", "backends", "open_haptic_device"]

_driver.offer()

# What each World was made from, a dict or the full name of a file: a World itself cannot be asked for its parameters, and a page shows them.
_scenes = _weakref.WeakKeyDictionary()


def _remember_scenes(make):
    @_functools.wraps(make)
    def init(self, *args, **kwargs):
        make(self, *args, **kwargs)
        scene = args[0] if args else kwargs["scene"]
        _scenes[self] = _copy.deepcopy(scene) if isinstance(scene, dict) else _os.path.abspath(_os.fspath(scene))

    return init


def _show(self, port=8080, *, host="127.0.0.1", block=True, play=True):
    """show(self: pliant.World, port: int = 8080, *, host: str = '127.0.0.1', block: bool = True, play: bool = True) -> pliant.view.View

    Opens the World in a browser: see pliant.view.show.
    """
    from pliant import view

    return view.show(self, port, host=host, block=block, play=play)


_show.__name__, _show.__qualname__ = "show", "World.show"
World.__init__ = _remember_scenes(World.__init__)
World.show = _show
Batch.__module__ = "pliant"  # where users find it
