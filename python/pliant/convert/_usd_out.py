"""Results as stages of OpenUSD: the points of the bodies, and their triangles where a cut changes them, as time samples."""
import os
import re
from pathlib import Path

import numpy as np

from pliant.convert._files import input_error
from pliant.convert._deformable import rest_shape, root_of
from pliant.convert._embedded import embedded_in
from pliant.convert._stage import moved, need_usd, open_stage, prim_path, to_world
from pliant.convert._usd_in import faces_of


def _nearest(points, among):
    """For each point the number of the one of `among` in the same place, up to rounding in float; -1: there is none."""
    near = 4e-7 * max(np.abs(among).max(), 1e-30)
    cells = {}
    for number, cell in enumerate(map(tuple, np.floor(among / (8 * near)).astype(np.int64).tolist())):
        cells.setdefault(cell, []).append(number)
    found = np.full(len(points), -1)
    best = np.full(len(points), np.inf)
    for shift in np.ndindex(2, 2, 2):  # a place near a border is looked for on both sides of it
        corners = np.floor((points + (2 * np.array(shift) - 1) * 2 * near) / (8 * near)).astype(np.int64)
        for i, cell in enumerate(map(tuple, corners.tolist())):
            for number in cells.get(cell, ()):
                distance = np.abs(among[number] - points[i]).max()
                if distance < min(best[i], 4 * near):
                    found[i], best[i] = number, distance
    return found


class _Triangles:
    """A body as a UsdGeom.Mesh of the triangles of the frames."""

    def __init__(self, mesh, body, matrix=None):
        self.mesh, self.body, self.matrix, self.version = mesh, body, matrix, None

    def add(self, world, frame, code):
        del world
        (first, count), (face, faces) = frame.body_vertices[self.body], frame.body_triangles[self.body]
        if frame.topology_version != self.version:
            triangles = frame.triangles[face:face + faces] - first
            mirrored = self.matrix is not None and np.linalg.det(self.matrix[:3, :3]) < 0
            if mirrored != (self.mesh.GetOrientationAttr().Get(code) == "leftHanded"):
                triangles = triangles[:, ::-1]
            _set(self.mesh.GetFaceVertexCountsAttr(), np.full(faces, 3, np.int32), code)
            _set(self.mesh.GetFaceVertexIndicesAttr(), triangles.ravel(), code)
            self.version = frame.topology_version
        _set_points(self.mesh, frame.positions[first:first + count], code, self.matrix)


class _Surface:
    """A surface of the source: its points move, and its polygons stay until a cut replaces them by triangles."""

    def __init__(self, source, stage, body, frame):
        _, UsdGeom = need_usd()
        time = _earliest()
        self.mesh, self.body, self.cut, self.code = UsdGeom.Mesh(stage.GetPrimAtPath(source.GetPath())), body, None, None
        original = UsdGeom.Mesh(source)
        self.points = moved(np.asarray(original.GetPointsAttr().Get(time), np.float64), to_world(source, time))
        first, count = frame.body_vertices[body]
        self.vertex = _nearest(self.points, np.asarray(frame.rest[first:first + count], np.float64))
        self.version = frame.topology_version
        if self.mesh.GetNormalsAttr().HasAuthoredValue():
            self.mesh.GetNormalsAttr().Block()  # they were those of the shape at rest
        used = np.unique([v for f in faces_of(original, time) for v in f])
        if np.any(self.vertex[used] < 0):
            raise input_error(f"{source.GetPath()}: {np.sum(self.vertex[used] < 0)} of its {len(used)} points are not vertices of the body "
                              f"{source.GetPath()}: the scene is not from_usd() of this stage")

    def add(self, world, frame, code):
        if self.cut is None and frame.topology_version != self.version:
            for attribute in (self.mesh.GetFaceVertexCountsAttr(), self.mesh.GetFaceVertexIndicesAttr()):
                if self.code is not None:
                    attribute.Set(attribute.Get(_earliest()), self.code)  # until now
            self.mesh.GetHoleIndicesAttr().Set([])
            self.cut = _Triangles(self.mesh, self.body)
        if self.cut is not None:
            self.cut.matrix = to_world(self.mesh.GetPrim(), code)
            return self.cut.add(world, frame, code)
        self.code = code
        first, count = frame.body_vertices[self.body]
        points = self.points.copy()
        points[self.vertex >= 0] = frame.positions[first:first + count][self.vertex[self.vertex >= 0]]
        _set_points(self.mesh, points, code, to_world(self.mesh.GetPrim(), code))


class _Tetrahedra:
    """A UsdGeom.TetMesh of the source: its points are nodes."""

    def __init__(self, source, stage, body, world):
        _, UsdGeom = need_usd()
        self.mesh, self.body = UsdGeom.TetMesh(stage.GetPrimAtPath(source.GetPath())), body
        points, cells, _ = rest_shape(source, _earliest())
        self.points = moved(points, to_world(source, _earliest()))
        self.rest = world.rest_positions(body)
        self.node = _nearest(self.points, self.rest)
        if len(np.setdiff1d(np.arange(len(self.rest)), self.node)) > 0:
            raise input_error(f"{source.GetPath()}: its points are not the nodes of the body: the scene is not from_usd() of this stage")
        root = root_of(source)
        self.embedded = embedded_in(root, source, stage, cells, _earliest()) if root else []

    def add(self, world, frame, code):
        del frame
        u = world.displacements(self.body)
        if len(u) != len(self.rest):
            raise input_error(f"{self.mesh.GetPath()}: a cut has changed its tetrahedra; without `source` its surface is written")
        points = self.points.copy()
        points[self.node >= 0] = (self.rest + u)[self.node[self.node >= 0]]
        _set_points(self.mesh, points, code, to_world(self.mesh.GetPrim(), code))
        for part in self.embedded:
            _set_points(part.mesh, part.points(points), code, to_world(part.mesh.GetPrim(), code))


def _earliest():
    return need_usd()[0].TimeCode.EarliestTime()


def _set(attribute, values, code):
    from pxr import Vt

    attribute.Set(Vt.IntArray.FromNumpy(np.ascontiguousarray(values, dtype=np.int32)), code)


def _set_points(geometry, points, code, matrix):
    from pxr import UsdGeom, Vt

    if matrix is not None:
        points = moved(np.asarray(points, np.float64), np.linalg.inv(matrix))
    array = Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points, dtype=np.float32))
    geometry.GetPointsAttr().Set(array, code)
    geometry.GetExtentAttr().Set(UsdGeom.PointBased.ComputeExtent(array), code)


def _new_stage(file, below):
    """An empty stage, also where the file is there, or open in this process, as after a first call in a notebook."""
    from pxr import Sdf, Usd

    path = Path(file).resolve()
    if below and Path(below.GetRootLayer().realPath or "?").resolve() == path:
        raise input_error(f"{file} is the source itself; results go to a file of their own")
    path.parent.mkdir(parents=True, exist_ok=True)
    layer = Sdf.Layer.Find(str(path))
    if layer:
        layer.Clear()
        return Usd.Stage.Open(layer)
    path.unlink(missing_ok=True)
    return Usd.Stage.CreateNew(str(path))


class UsdWriter:
    """Writes the states of a World to a stage, one for each add(): with it as a context, or with close() at the end.

    Without `source` each body is a UsdGeom.Mesh below /pliant, in metres, with the triangles of the World's frames. With `source`, the stage that
    from_usd() made the World's scene of, the file is a layer over it that moves the points of its prims; materials, cameras and lights of the stage
    stay. A cut replaces a prim's polygons by triangles from that frame on. fps: time codes per second. up_axis: without a source.
    """

    def __init__(self, file, world, *, source=None, fps=60.0, up_axis="Y"):
        _, UsdGeom = need_usd()
        if os.path.splitext(file)[1] not in (".usd", ".usda", ".usdc"):
            raise input_error(f"{os.fspath(file)}: results are written as .usd, .usda or .usdc")
        if not 0 < fps < np.inf:
            raise input_error(f"fps is {fps}; a number above 0 is allowed")
        self._world, self._fps, self._codes = world, float(fps), []
        below = open_stage(source) if source is not None else None
        self.stage = _new_stage(file, below)
        self.stage.SetTimeCodesPerSecond(self._fps)
        self.stage.SetFramesPerSecond(self._fps)
        self._bodies = self._over(below, file) if below else self._fresh(UsdGeom, up_axis)

    def _fresh(self, UsdGeom, up_axis):
        if up_axis not in ("X", "Y", "Z"):
            raise input_error(f"the up axis is {up_axis!r}; allowed are 'X', 'Y' and 'Z'")
        UsdGeom.SetStageUpAxis(self.stage, up_axis)
        UsdGeom.SetStageMetersPerUnit(self.stage, 1.0)
        self.stage.SetDefaultPrim(UsdGeom.Xform.Define(self.stage, "/pliant").GetPrim())
        bodies, names = [], set()
        for number, body in enumerate(self._world.info["bodies"]):
            name = re.sub(r"\W", "_", body["name"], flags=re.A)
            name = "_" + name if name[0].isdigit() else name
            while name in names:
                name += "_"
            names.add(name)
            mesh = UsdGeom.Mesh.Define(self.stage, f"/pliant/{name}")
            mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
            bodies.append(_Triangles(mesh, number))
        return bodies

    def _over(self, source, file):
        _, UsdGeom = need_usd()
        layer = source.GetRootLayer()
        below = layer.realPath or layer.identifier
        root = self.stage.GetRootLayer()
        if layer.realPath:
            below = "./" + Path(os.path.relpath(below, Path(file).resolve().parent)).as_posix()
        root.subLayerPaths = [below]
        UsdGeom.SetStageUpAxis(self.stage, UsdGeom.GetStageUpAxis(source))  # a stage takes these from its root layer alone
        UsdGeom.SetStageMetersPerUnit(self.stage, UsdGeom.GetStageMetersPerUnit(source))
        if source.GetDefaultPrim():
            root.defaultPrim = source.GetDefaultPrim().GetName()
        frame, bodies = self._world.frame(), []
        for number, body in enumerate(self._world.info["bodies"]):
            prim = source.GetPrimAtPath(prim_path(body["name"]))
            if not prim:
                raise input_error(f"the stage has no prim {prim_path(body['name'])} for the body '{body['name']}': the scene is not from_usd() of it")
            if prim.IsInstanceProxy():
                raise input_error(f"{prim.GetPath()} is part of an instance, whose points cannot differ from those of the others; make it not instanceable")
            surface = UsdGeom.Mesh(prim)
            bodies.append(_Surface(prim, self.stage, number, frame) if surface else _Tetrahedra(prim, self.stage, number, self._world))
        return bodies

    def add(self):
        """Writes the World's newest state at its time."""
        frame = self._world.frame()
        code = frame.time * self._fps
        for body in self._bodies:
            body.add(self._world, frame, code)
        self._codes.append(code)

    def close(self):
        """Saves the stage."""
        if self._codes:
            self.stage.SetStartTimeCode(min(self._codes))
            self.stage.SetEndTimeCode(max(self._codes))
        self.stage.GetRootLayer().Save()

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.close()


def to_usd(file, world, seconds, *, fps=60.0, source=None, up_axis="Y"):
    """Steps a World for that time and writes `fps` states a second, the present one first: see UsdWriter. A StepReport."""
    with UsdWriter(file, world, source=source, fps=fps, up_axis=up_axis) as out:
        out.add()
        report = world.step(0)
        for _ in range(round(seconds * fps)):
            report = world.advance(1 / fps)
            out.add()
            if report.diverged:
                break
    return report
