"""Soft-tissue deformation. SI units."""
from pliant._core import Error, Frame, StepReport, World, __version__, backends

__all__ = ["Error", "Frame", "StepReport", "World", "backends"]
