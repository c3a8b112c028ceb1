"""Scenes from stages of OpenUSD: surfaces (UsdGeom.Mesh) and tetrahedra (UsdGeom.TetMesh)."""
import os
from pathlib import Path

import numpy as np

from pliant.convert._files import MATERIAL, input_error, scene_of, stands_on_its_foot, write_obj, write_vtu


def need_usd():
    try:
        from pxr import Usd, UsdGeom
    except ImportError:
        raise ImportError("pliant.convert needs OpenUSD for this: pip install usd-core") from None
    return Usd, UsdGeom


def open_stage(stage):
    Usd, _ = need_usd()
    if isinstance(stage, Usd.Stage):
        return stage
    file = os.fspath(stage)
    if not os.path.exists(file):
        error = input_error(f"{file}: no such file, expected a stage of USD")
        error.code = 6
        raise error
    try:
        return Usd.Stage.Open(file)
    except Exception as error:  # pxr.Tf.ErrorException, which is not its own class everywhere
        raise input_error(f"{file}: OpenUSD cannot read it: {str(error).splitlines()[0]}") from None


def body_name(prim):
    """A prim's path with dots: names of bodies have no slashes, and names of prims no dots, so it can be found again."""
    return str(prim.GetPath()).strip("/").replace("/", ".")


def prim_path(name):
    return "/" + name.replace(".", "/")


def to_world(prim, time):
    """The matrix that takes a prim's points, as rows of x y z 1, to metres in the frame of the stage."""
    _, UsdGeom = need_usd()
    matrix = np.array(UsdGeom.Imageable(prim).ComputeLocalToWorldTransform(time), dtype=np.float64)
    matrix[:, :3] *= UsdGeom.GetStageMetersPerUnit(prim.GetStage())
    return matrix


def moved(points, matrix):
    return points @ matrix[:3, :3] + matrix[3, :3]


def faces_of(mesh, time):
    """The polygons of a UsdGeom.Mesh without its holes, outward by its orientation."""
    counts = np.asarray(mesh.GetFaceVertexCountsAttr().Get(time) or [], dtype=np.int64)
    indices = np.asarray(mesh.GetFaceVertexIndicesAttr().Get(time) or [], dtype=np.int64)
    if counts.sum() != len(indices):
        raise input_error(f"{mesh.GetPath()}: its faces have {counts.sum()} corners, and faceVertexIndices has {len(indices)}")
    holes = set(mesh.GetHoleIndicesAttr().Get(time) or [])
    faces = [f.tolist() for i, f in enumerate(np.split(indices, np.cumsum(counts)[:-1])) if i not in holes and len(f) >= 3]
    return [f[::-1] for f in faces] if mesh.GetOrientationAttr().Get(time) == "leftHanded" else faces


def _shown(prim, time):
    _, UsdGeom = need_usd()
    image = UsdGeom.Imageable(prim)
    return image.ComputeVisibility(time) != "invisible" and image.ComputePurpose() in ("default", "render")


def _body(prim, folder, time, nodes):
    """A body and its points [m], or None for a prim that is neither a surface nor tetrahedra."""
    _, UsdGeom = need_usd()
    tets, surface = UsdGeom.TetMesh(prim), UsdGeom.Mesh(prim)
    if not tets and not surface:
        return None
    geometry = tets or surface
    points = np.asarray(geometry.GetPointsAttr().Get(time) or [], dtype=np.float64).reshape(-1, 3)
    if len(points) == 0:
        raise input_error(f"{prim.GetPath()}: it has no points")
    points = moved(points, to_world(prim, time))
    name = body_name(prim)
    if tets:
        corners = np.asarray(tets.GetTetVertexIndicesAttr().Get(time) or [], dtype=np.int64).reshape(-1, 4)
        _check(corners, points, prim)
        file = folder / f"{name}.vtu"
        write_vtu(file, points, [("tetra", corners)], {})
        return {"name": name, "mesh": str(file.resolve()), "element": "tet4anp"}, points[np.unique(corners)]
    faces = faces_of(surface, time)
    _check(np.array([v for f in faces for v in f], dtype=np.int64), points, prim)
    file = folder / f"{name}.obj"
    write_obj(file, points, faces)
    return {"name": name, "surface": str(file.resolve()), "lattice": {"nodes": int(nodes)}}, points


def _check(corners, points, prim):
    if corners.size == 0:
        raise input_error(f"{prim.GetPath()}: it has no cells")
    if corners.min() < 0 or corners.max() >= len(points):
        raise input_error(f"{prim.GetPath()}: a cell names the point {corners.max() if corners.min() >= 0 else corners.min()} of {len(points)}")


def from_usd(stage, folder, *, material=MATERIAL, nodes=2000, hold_bottom=False, time=None):
    """A scene with a body for each visible UsdGeom.Mesh and UsdGeom.TetMesh: a dict for pliant.World or save_scene.

    stage: a file, or a Usd.Stage. folder: takes a mesh file for each body. A body's name is the path of its prim with dots. Points are transformed to
    the stage and scaled by metersPerUnit; axes stay as they are, and gravity follows the up axis. A surface is its cage of polygons, not a subdivision, and is
    filled with a lattice of about `nodes` nodes. material: of every body, or a function of the name of a body. hold_bottom: holds the lowest twentieth
    of each. time: a time code; None: the first one.
    """
    Usd, UsdGeom = need_usd()
    opened = open_stage(stage)
    at = Usd.TimeCode.EarliestTime() if time is None else Usd.TimeCode(time)
    up = {"X": 0, "Y": 1, "Z": 2}[str(UsdGeom.GetStageUpAxis(opened))]
    folder, bodies = Path(folder), []
    for prim in Usd.PrimRange.Stage(opened, Usd.TraverseInstanceProxies()):
        found = _body(prim, folder, at, nodes) if prim.IsA(UsdGeom.Imageable) and _shown(prim, at) else None
        if found is None:
            continue
        body, points = found
        body["material"] = dict(material(body["name"]) if callable(material) else material)
        if hold_bottom:
            body["fixed"] = stands_on_its_foot(points, up)
        bodies.append(body)
    if not bodies:
        raise input_error(f"{opened.GetRootLayer().identifier}: it has no visible UsdGeom.Mesh or UsdGeom.TetMesh")
    gravity = [0.0, 0.0, 0.0]
    gravity[up] = -9.81
    name = Path(opened.GetRootLayer().realPath or "stage").stem
    return scene_of(name, bodies, gravity)
