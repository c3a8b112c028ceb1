"""Meshes that are embedded in the simulation mesh of a deformable body, as those that are seen, and move with its tetrahedra."""
from itertools import product

import numpy as np

from pliant.convert._deformable import BODY, RIGID, schemas
from pliant.convert._stage import moved, to_world


def _bind_points(prim, time):
    """Points in the frame of the stage [m]: those of its bind pose, where it has one."""
    from pxr import UsdGeom

    given = UsdGeom.PointBased(prim).GetPointsAttr().Get(time)
    for name in schemas(prim):
        maker, _, pose = name.partition("PhysicsDeformablePoseAPI:")
        names = {"": "physics:deformablePose:{}:{}", "Omni": "deformablePose:{}:omniphysics:{}"}.get(maker)
        if names and pose and "bindPose" in (prim.GetAttribute(names.format(pose, "purposes")).Get() or []):
            bound = prim.GetAttribute(names.format(pose, "points")).Get(time)
            given = bound if bound is not None and given is not None and len(bound) == len(given) else given
    return moved(np.asarray(given if given is not None else [], dtype=np.float64).reshape(-1, 3), to_world(prim, time))


def _places(points, corners, cells):
    """For each point its tetrahedron, or, of the 64 that are nearest, the one that it is least outside of, and its four coordinates there."""
    of = corners[cells]
    edges = np.swapaxes(of[:, :3] - of[:, 3:], 1, 2)
    size = max(np.ptp(corners, axis=0).max(), 1e-30)
    number = np.flatnonzero(np.abs(np.linalg.det(edges)) > 1e-12 * size ** 3)
    of, inverse = of[number], np.linalg.inv(edges[number])
    low, high, middle = of.min(axis=1) - 1e-6 * size, of.max(axis=1) + 1e-6 * size, of.mean(axis=1)

    def best(point, among):
        w = np.einsum("mij,mj->mi", inverse[among], point - of[among, 3])
        w = np.column_stack([w, 1 - w.sum(axis=1)])
        at = w.min(axis=1).argmax() if len(among) else -1
        return (number[among[at]], w[at]) if len(among) else (-1, np.full(4, -1.0))

    width = max((high - low).mean(), (high - low).max() / 16)
    boxes = {}  # by box of a grid the tetrahedra that reach into it
    for m, (first, last) in enumerate(zip(np.floor(low / width).astype(int).tolist(), np.floor(high / width).astype(int).tolist())):
        for box in product(*(range(f, e + 1) for f, e in zip(first, last))):
            boxes.setdefault(box, []).append(m)
    cell, weights = np.zeros(len(points), np.int64), np.zeros((len(points), 4))
    for i, (point, box) in enumerate(zip(points, map(tuple, np.floor(points / width).astype(int).tolist()))):
        cell[i], weights[i] = best(point, np.array(boxes.get(box, []), dtype=np.int64))
        if weights[i].min() < -1e-5:
            near = np.argpartition(((middle - point) ** 2).sum(axis=1), min(64, len(middle)) - 1)[:64]
            cell[i], weights[i] = best(point, near)
    return cell, weights


class Embedded:
    """A UsdGeom.Mesh that moves with tetrahedra."""

    def __init__(self, source, stage, mesh, cells, time):
        from pxr import UsdGeom

        self.mesh = UsdGeom.Mesh(stage.GetPrimAtPath(source.GetPath()))
        cell, self.weights = _places(_bind_points(source, time), _bind_points(mesh, time), cells)
        self.corners = cells[cell]
        if self.mesh.GetNormalsAttr().HasAuthoredValue():
            self.mesh.GetNormalsAttr().Block()  # they were those of the shape at rest

    def points(self, corners):
        """Its points in the frame of the stage [m], by those of the tetrahedra."""
        return np.einsum("nk,nki->ni", self.weights, corners[self.corners])


def embedded_in(root, mesh, stage, cells, time):
    """All meshes below the root of a body that are not its simulation mesh, nor belong to a body below."""
    from pxr import Usd, UsdGeom

    found, walk = [], iter(Usd.PrimRange(root))
    for prim in walk:
        if prim != root and schemas(prim) & {RIGID, *BODY}:
            walk.PruneChildren()
        elif prim.IsA(UsdGeom.Mesh) and UsdGeom.Mesh(prim).GetPointsAttr().Get(time):
            found.append(Embedded(prim, stage, mesh, cells, time))
    return found
