"""Meshes and scenes of other programs as scenes of Pliant, and results back: see docs/convert.md. SI units.

Each function needs a package that Pliant does not install: from_meshio meshio, from_usd, to_usd and UsdWriter usd-core.
"""
from pliant.convert._files import MATERIAL, save_scene
from pliant.convert._meshio import from_meshio
from pliant.convert._usd_in import from_usd
from pliant.convert._usd_out import UsdWriter, to_usd

__all__ = ["MATERIAL", "UsdWriter", "from_meshio", "from_usd", "save_scene", "to_usd"]
