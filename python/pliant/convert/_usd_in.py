"""Scenes from stages of OpenUSD: surfaces (UsdGeom.Mesh) and tetrahedra (UsdGeom.TetMesh)."""
import warnings
from pathlib import Path

import numpy as np

from pliant.convert import _deformable
from pliant.convert._files import MATERIAL, input_error, scene_of, stands_on_its_foot, write_obj, write_vtu
from pliant.convert._stage import body_name, check_cells, moved, need_usd, open_stage, to_world


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
        check_cells(corners, points, prim)
        file = folder / f"{name}.vtu"
        write_vtu(file, points, [("tetra", corners)], {})
        return {"name": name, "mesh": str(file.resolve()), "element": "tet4anp"}, points[np.unique(corners)]
    faces = faces_of(surface, time)
    check_cells(np.array([v for f in faces for v in f], dtype=np.int64), points, prim)
    file = folder / f"{name}.obj"
    write_obj(file, points, faces)
    return {"name": name, "surface": str(file.resolve()), "lattice": {"nodes": int(nodes)}}, points


def _plain(prims, folder, time, nodes):
    """The bodies of a stage without deformable bodies, with their points: what is a surface or tetrahedra, and visible."""
    _, UsdGeom = need_usd()
    found = (_body(p, folder, time, nodes) for p in prims if p.IsA(UsdGeom.Imageable) and _shown(p, time))
    return [pair for pair in found if pair]


def _deformables(found, prims, folder, time, over, contact, said):
    """The bodies of the deformable bodies of a stage, with their points, and `contact`, unless that is given."""
    _, UsdGeom = need_usd()
    bodies, owned = found
    made = []
    for body in bodies:
        entry = body.write(folder, said)
        said += body.remarks()
        made.append((entry | {"material": dict(MATERIAL) if over is None else body.material(over, said)}, body.points[body.node >= 0]))
    contact = _deformable.contact_of(bodies, time, said) if contact is None else contact
    _deformable.attach(prims, bodies, time, said)
    for body, (entry, _) in zip(bodies, made):
        entry |= {"fixed": [{"all": True}]} if body.kinematic else {"fixed": body.fixed} if body.fixed else {}
    others = [p for p in prims if (UsdGeom.Mesh(p) or UsdGeom.TetMesh(p)) and _shown(p, time) and not any(p.GetPath().HasPrefix(o) for o in owned)]
    if others:
        names = ", ".join(str(p.GetPath()) for p in others[:3]) + (", ..." if len(others) > 3 else "")
        said.append(f"the stage says which bodies are deformable; meshes that belong to none are left out ({len(others)}): {names}")
    return made, contact


def scene_of_stage(stage, folder, *, material, nodes, hold_bottom, contact, time, over=None):
    """from_usd, and what it has to say. over: parts of the material that win over those of the stage."""
    Usd, UsdGeom = need_usd()
    opened, said, folder = open_stage(stage), [], Path(folder)
    at = Usd.TimeCode.EarliestTime() if time is None else Usd.TimeCode(time)
    up = {"X": 0, "Y": 1, "Z": 2}[str(UsdGeom.GetStageUpAxis(opened))]
    prims = list(Usd.PrimRange.Stage(opened, Usd.TraverseInstanceProxies()))
    found = _deformable.find(prims, at, said)
    if found is None:
        bodies = _plain(prims, folder, at, nodes)
    else:
        bodies, contact = _deformables(found, prims, folder, at, (over or {}) if material is None else None, contact, said)
    for body, points in bodies:
        if material is not None:
            body["material"] = dict(material(body["name"]) if callable(material) else material)
        elif found is None:
            body["material"] = {**MATERIAL, **(over or {})}
        if hold_bottom:
            body["fixed"] = body.get("fixed", []) + stands_on_its_foot(points, up)
    if not bodies:
        what = "visible UsdGeom.Mesh or UsdGeom.TetMesh" if found is None else "deformable body that is taken" + "".join(f"; {s}" for s in said)
        raise input_error(f"{opened.GetRootLayer().identifier}: it has no {what}")
    gravity = [0.0, 0.0, 0.0]
    gravity[up] = -9.81
    scene = scene_of(Path(opened.GetRootLayer().realPath or "stage").stem, [body for body, _ in bodies], gravity)
    return scene | ({"contact": contact} if contact else {}), said


def from_usd(stage, folder, *, material=None, nodes=2000, hold_bottom=False, contact=None, time=None):
    """A scene with a body for each visible UsdGeom.Mesh and UsdGeom.TetMesh, or, in a stage that has deformable bodies, for each of these: a dict for
    pliant.World or save_scene.

    stage: a file, or a Usd.Stage. folder: takes a mesh file for each body. A body's name is the path of its prim with dots. Points are transformed to
    the stage and scaled by metersPerUnit; axes stay as they are, and gravity follows the up axis. A surface is its cage of polygons, not a subdivision, and is
    filled with a lattice of about `nodes` nodes. material: of every body, or a function of the name of a body; None: the physics material that the stage
    binds to a deformable body, and MATERIAL for any other. hold_bottom: holds the lowest twentieth of each, and what the stage holds. contact: as in a
    scene; None: with collision of the stage's deformable bodies. time: a time code; None: the first one. What the stage says of deformable bodies and a
    scene does not take is warned of.
    """
    scene, said = scene_of_stage(stage, folder, material=material, nodes=nodes, hold_bottom=hold_bottom, contact=contact, time=time)
    for text in said:
        warnings.warn(text, stacklevel=2)
    return scene
