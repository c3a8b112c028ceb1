"""Deformable bodies of a stage: the proposed schema of OpenUSD for them, and its forerunner in Omniverse. See docs/convert.md.

usd-core has classes for neither, so names of schemas and of attributes are compared.
"""
import numpy as np

from pliant.convert._files import MATERIAL, input_error, write_vtu
from pliant.convert._stage import body_name, check_cells, moved, to_world

PREFIXES = ("physics:", "omniphysics:")  # of attributes: of the proposal, and of Omniverse; the first one that has a value counts
BODY = {"PhysicsDeformableBodyAPI", "OmniPhysicsDeformableBodyAPI"}
VOLUME = {"PhysicsVolumeDeformableSimAPI", "OmniPhysicsVolumeDeformableSimAPI"}
THIN = {f"{maker}Physics{kind}DeformableSimAPI": kind.lower() for maker in ("", "Omni") for kind in ("Surface", "Curves")}
RIGID = "PhysicsRigidBodyAPI"
COLLIDER = "PhysicsCollisionAPI"
SOLID = {"PhysicsVolumeDeformableMaterialAPI", "OmniPhysicsDeformableMaterialAPI"}
ATTACHMENTS = {"PhysicsAttachment", "OmniPhysicsVtxXformAttachment"}
OTHERS = {f"OmniPhysics{kind}Attachment" for kind in ("VtxVtx", "VtxTri", "VtxTet", "VtxCrv", "TetXform", "TriTri")}
FILTERS = {"PhysicsElementCollisionFilter", "OmniPhysicsElementCollisionFilter"}
NAMES = {  # without the prefix; where there are two, the second one is that of Omniverse
    "enabled": ("bodyEnabled", "deformableBodyEnabled"), "kinematic": ("kinematicEnabled",), "mass": ("mass",), "density": ("density",),
    "masses": ("masses",), "rest points": ("restShapePoints",), "rest cells": ("restTetVertexIndices", "restTetVtxIndices"),
    "young": ("youngsModulus",), "poisson": ("poissonsRatio",), "friction": ("dynamicFriction",), "collision": ("collisionEnabled",),
    "attached": ("attachmentEnabled",), "vertices": ("indices0", "vtxIndicesSrc0"), "places": ("coords1", "localPositionsSrc1"),
    "stiffness": ("stiffness",), "filter": ("filterEnabled",), "type0": ("type0",), "type1": ("type1",), "rigid": ("rigidBodyEnabled",),
}
WITHOUT_EFFECT = {"masses:elementType", "simulationOwner", "startsAsleep", "restitution"}
ASSUMED = {"young": 1e6, "poisson": 0.3}  # by the proposal, where a material for deformable bodies does not say it


def schemas(prim):
    """The names of the applied schemas, also of those that this usd-core does not know."""
    listed = prim.GetMetadata("apiSchemas")
    return {*prim.GetAppliedSchemas(), *(listed.GetAppliedItems() if listed else ())}


def _attribute(prim, word):
    """The first attribute of that meaning with a value, or None."""
    for prefix in PREFIXES:
        for name in NAMES[word]:
            attribute = prim.GetAttribute(prefix + name)
            if attribute and attribute.HasAuthoredValue():
                return attribute
    return None


def _value(prim, word, time, default=None):
    attribute = _attribute(prim, word)
    found = attribute.Get(time) if attribute else None
    return default if found is None else found


def _number(prim, word, time, allowed, holds, unset):
    """A number of a material or a body as it was written, though it is a float; None where it is not given, or is the word for that."""
    attribute = _attribute(prim, word)
    given = attribute.Get(time) if attribute else None
    if given is None or given == unset:
        return None
    value = float(str(np.float32(given))) if str(attribute.GetTypeName()) == "float" else float(given)
    if not holds(value):
        raise input_error(f"{prim.GetPath()}: {attribute.GetName()} is {value:g}; {allowed}")
    return value


def _array(prim, word, time, width, kind=np.float64):
    found = _value(prim, word, time)
    return None if found is None or len(found) == 0 else np.asarray(found, dtype=kind).reshape((-1, width) if width else -1)


def _target(prim, name):
    """The path that a relationship names first, or None."""
    for prefix in PREFIXES:
        paths = prim.GetRelationship(prefix + name).GetTargets() if prim.HasRelationship(prefix + name) else ()
        if paths:
            return paths[0]
    return None


def root_of(prim):
    """The prim that says of this one that it is part of a deformable body, or None."""
    while prim and not prim.IsPseudoRoot():
        applied = schemas(prim)
        if applied & BODY:
            return prim
        if RIGID in applied:
            return None
        prim = prim.GetParent()
    return None


def _is_kinematic(prim, time):
    return bool(_value(prim, "kinematic", time, False))


def rest_shape(prim, time):
    """Of a TetMesh: its points at rest, in its own frame; its cells; and whether they are in one piece as its points are."""
    from pxr import UsdGeom

    tets = UsdGeom.TetMesh(prim)
    points = np.asarray(tets.GetPointsAttr().Get(time) or [], dtype=np.float64).reshape(-1, 3)
    cells = np.asarray(tets.GetTetVertexIndicesAttr().Get(time) or [], dtype=np.int64).reshape(-1, 4)
    if len(points) == 0:
        raise input_error(f"{prim.GetPath()}: it has no points")
    check_cells(cells, points, prim)
    rest, parts = _array(prim, "rest points", time, 3), _array(prim, "rest cells", time, 4, np.int64)
    if (rest is None and parts is None) or not schemas(prim) & VOLUME or _is_kinematic(root_of(prim) or prim, time):
        return points, cells, True
    if parts is None and len(rest) != len(points):
        raise input_error(f"{prim.GetPath()}: it has {len(points)} points and {len(rest)} rest points, and no rest cells that say which is which")
    rest, parts = points if rest is None else rest, cells if parts is None else parts
    if len(parts) != len(cells):
        raise input_error(f"{prim.GetPath()}: it has {len(cells)} cells and {len(parts)} rest cells; they are the same ones")
    check_cells(parts, rest, prim, "a rest cell")
    found = points.copy()
    found[cells] = rest[parts]
    if np.abs(found[cells] - rest[parts]).max() > 1e-6 * max(np.ptp(rest, axis=0).max(), 1e-30):
        return points, cells, False
    return found, cells, True


class _Body:
    """A volume deformable body that becomes a body of a scene."""

    def __init__(self, root, mesh, time):
        self.root, self.mesh, self.time, self.kinematic = root, mesh, time, _is_kinematic(root, time)
        self.name, self.colliders, self.fixed = body_name(mesh), [], []

    def write(self, folder, said):
        """Its mesh file: the nodes are the points that cells have, in their order."""
        from pxr import UsdGeom

        points, cells, whole = rest_shape(self.mesh, self.time)
        place, matrix = UsdGeom.TetMesh(self.mesh).GetPointsAttr().Get(self.time), to_world(self.mesh, self.time)
        self.points, used = moved(points, matrix), np.unique(cells)
        self.node = np.full(len(points), -1)
        self.node[used] = np.arange(len(used))
        file = folder / f"{self.name}.vtu"
        write_vtu(file, self.points[used], [("tetra", self.node[cells])], {})
        a, b, c, d = (self.points[cells[:, k]] for k in range(4))
        self.volume = np.abs(np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a))).sum() / 6
        away = np.abs(moved(np.asarray(place, np.float64), matrix)[used] - self.points[used]).max()
        if not whole:
            said.append(f"{self.mesh.GetPath()}: its rest shape is in pieces, where a node has one rest position; its points are taken as its rest shape")
        elif away > 1e-5 * max(np.ptp(self.points, axis=0).max(), 1e-30):
            said.append(f"{self.mesh.GetPath()}: it starts in its rest shape; its points are up to {away:.3g} m from there")
        return {"name": self.name, "mesh": str(file.resolve()), "element": "tet4anp"}

    def bound(self, prim):
        """The prim of the physics material of a prim, or None."""
        from pxr import UsdShade

        material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
        return material.GetPrim() if material else None

    def density(self, material, said):
        """[kg/m^3], by what counts most: masses of the mesh, mass and density of the body, density of the material. None: not given."""
        from pxr import UsdGeom, UsdPhysics

        stage, positive = self.root.GetStage(), ("a number above 0 is allowed", lambda v: 0 < v < np.inf, 0.0)
        kilograms = UsdPhysics.GetStageKilogramsPerUnit(stage)
        masses = _array(self.mesh, "masses", self.time, 0)
        if masses is not None:
            if not np.all((masses > 0) & np.isfinite(masses)):
                raise input_error(f"{self.mesh.GetPath()}: {_attribute(self.mesh, 'masses').GetName()} has {masses.min():g}; numbers above 0 are allowed")
            if len(masses) > 1:
                said.append(f"{self.mesh.GetPath()}: of its masses the sum is taken, with one density everywhere")
            return masses.sum() * kilograms / self.volume
        mass = _number(self.root, "mass", self.time, *positive)
        if mass is not None:
            return mass * kilograms / self.volume
        density = _number(self.root, "density", self.time, *positive)
        if density is None and material:
            density = _number(material, "density", self.time, *positive)
        return None if density is None else density * kilograms / UsdGeom.GetStageMetersPerUnit(stage) ** 3

    def material(self, over, said):
        """The material of the scene. over: what is given, and not taken from the stage."""
        from pxr import UsdGeom, UsdPhysics

        stage, bound = self.root.GetStage(), self.bound(self.mesh)
        result, assumed = dict(MATERIAL), []
        unit = UsdPhysics.GetStageKilogramsPerUnit(stage) / UsdGeom.GetStageMetersPerUnit(stage)
        limits = {"young": (unit, "a number above 0 is allowed", lambda v: 0 < v < np.inf, -np.inf),
                  "poisson": (1.0, "above -1 and below 0.5 is allowed, such as 0.49", lambda v: -1 < v < 0.5, None)}
        for word, (factor, *limit) in limits.items():
            if word in over:
                continue
            value = _number(bound, word, self.time, *limit) if bound else None
            if value is not None:
                result[word] = value * factor
            else:
                result[word] = ASSUMED[word] if bound and schemas(bound) & SOLID else MATERIAL[word]
                assumed.append(f"{word} {result[word]:g}")
        density = None if "density" in over else self.density(bound, said)
        if density is not None:
            result["density"] = float(density)
        elif "density" not in over:
            assumed.append(f"density {result['density']:g}")
        if assumed:
            said.append(f"{self.mesh.GetPath()}: {'its material' if bound else 'no physics material is bound, which'} does not say all; "
                        f"taken: {', '.join(assumed)}")
        if bound:
            said += _unread(bound)
        return {**result, **over}

    def remarks(self):
        """What else the stage says of it, and a scene does not take."""
        from pxr import UsdGeom

        said = [text for prim in {self.root.GetPath(): self.root, self.mesh.GetPath(): self.mesh}.values() for text in _unread(prim)]
        velocities = UsdGeom.TetMesh(self.mesh).GetVelocitiesAttr().Get(self.time)
        if velocities is not None and len(velocities) and np.any(np.asarray(velocities)):
            said.append(f"{self.mesh.GetPath()}: its velocities are not taken; it starts at rest")
        if any(self.bound(s.GetPrim()) != self.bound(self.mesh) for s in UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(self.mesh))):
            said.append(f"{self.mesh.GetPath()}: materials of parts (GeomSubset) are not taken")
        if self.kinematic and (UsdGeom.PointBased(self.mesh).GetPointsAttr().ValueMightBeTimeVarying() or _moves(self.mesh)):
            said.append(f"{self.root.GetPath()}: it is kinematic, and held as it is at the start; its motion is not taken")
        return said


def _unread(prim):
    known = {name for names in NAMES.values() for name in names} | WITHOUT_EFFECT
    names = [n for n in prim.GetAuthoredPropertyNames() if n.startswith((*PREFIXES, "physx")) and ":deformablePose:" not in n]
    names = [n for n in names if n.startswith("physx") or n.split(":", 1)[1] not in known]
    return [f"{prim.GetPath()}: not taken: {', '.join(names)}"] if names else []


def _moves(prim):
    from pxr import UsdGeom

    while prim and not prim.IsPseudoRoot():
        if prim.IsA(UsdGeom.Xformable) and UsdGeom.Xformable(prim).TransformMightBeTimeVarying():
            return True
        prim = prim.GetParent()
    return False


def find(prims, time, said):
    """The bodies that a scene takes, and the paths below which everything belongs to a deformable body; None: the stage has none of them."""
    from pxr import UsdGeom

    bodies, owned, marked = {}, [], False
    for prim in prims:
        applied = schemas(prim)
        thin = next((THIN[name] for name in applied if name in THIN), None)
        if not thin and not applied & VOLUME:
            continue
        marked = True
        root = root_of(prim) or prim
        owned.append(root.GetPath())
        if thin:
            said.append(f"{prim.GetPath()}: a {thin} deformable body is not taken; of these bodies those of tetrahedra are")
        elif not prim.IsA(UsdGeom.TetMesh):
            said.append(f"{prim.GetPath()}: a volume deformable body that is not a TetMesh is not taken")
        elif not _value(root, "enabled", time, True):
            said.append(f"{root.GetPath()}: it is not enabled, and left out")
        elif root.GetPath() in bodies:
            said.append(f"{prim.GetPath()}: left out; {root.GetPath()} has the simulation mesh {bodies[root.GetPath()].mesh.GetPath()}")
        else:
            bodies[root.GetPath()] = _Body(root, prim, time)
    if not marked:
        return None
    for prim in prims:
        if COLLIDER in schemas(prim) and _value(prim, "collision", time, True):
            path = (root_of(prim) or prim).GetPath()
            if path in bodies:
                bodies[path].colliders.append(prim)
    return list(bodies.values()), owned


def contact_of(bodies, time, said):
    """`contact` of the scene: there is one, and one friction, for all of it."""
    frictions = {}
    for body in bodies:
        given = {}
        for prim in body.colliders or [body.mesh]:
            bound = body.bound(prim)
            value = _number(bound, "friction", time, "0 or more is allowed", lambda v: 0 <= v < np.inf, None) if bound else None
            given |= {} if value is None else {str(prim.GetPath()): value}
        if body.colliders:
            frictions |= given
        elif any(given.values()):
            said.append(f"{body.root.GetPath()}: its friction is not taken, as it has no collider")
    touching = [b for b in bodies if b.colliders]
    if not touching:
        return None
    if len(touching) < len(bodies):
        said.append(f"contact is between all bodies, also of {', '.join(str(b.root.GetPath()) for b in bodies if not b.colliders)}, which has no collider")
    if len(set(frictions.values())) > 1:
        said.append(f"contact has one friction, the mean of {', '.join(f'{v:g} ({p})' for p, v in frictions.items())}")
    friction = float(np.mean(list(frictions.values()))) if frictions else 0.0
    return {"friction": friction} if friction else True


def attach(prims, bodies, time, said):
    """The nodes that attachments hold, as entries of `fixed` of their bodies."""
    known = {path: body for body in bodies for path in (body.root.GetPath(), body.mesh.GetPath())}
    for prim in prims:
        kind = str(prim.GetTypeName())
        if kind in FILTERS and _value(prim, "filter", time, True):
            said.append(f"{prim.GetPath()}: collision filters of elements are not taken")
        if kind in ATTACHMENTS | OTHERS and _value(prim, "attached", time, True):
            why = _attach(prim, kind, known, time, said)
            if why:
                said.append(f"{prim.GetPath()}: this attachment is not taken: {why}")


def _attach(prim, kind, known, time, said):
    """One attachment; where it is not taken, why."""
    first, types = known.get(_target(prim, "src0")), (_value(prim, "type0", time, "point"), _value(prim, "type1", time, "xform"))
    if kind in OTHERS or types != ("point", "xform"):
        return f"it joins {kind if kind in OTHERS else ' and '.join(types)}, and points held by an xform are taken"
    if first is None:
        return f"{_target(prim, 'src0')} is not the mesh of a body of the scene"
    path = _target(prim, "src1")
    holder = prim.GetStage().GetPrimAtPath(path) if path else None
    why = _cannot_hold(holder, path, time)
    if why:
        return why
    vertices = _array(prim, "vertices", time, 0, np.int64)
    if vertices is None:
        return "it names no vertices"
    name = _attribute(prim, "vertices").GetName()
    outside = vertices[(vertices < 0) | (vertices >= len(first.node))]
    if len(outside):
        raise input_error(f"{prim.GetPath()}: {name} names the point {outside[0]}; {first.mesh.GetPath()} has those from 0 to {len(first.node) - 1}")
    if np.any(first.node[vertices] < 0):
        raise input_error(f"{prim.GetPath()}: {name} names the point {vertices[first.node[vertices] < 0][0]}, which is in no cell of {first.mesh.GetPath()}")
    _say_how(prim, first, vertices, holder, time, said)
    first.fixed.append({"nodes": np.unique(first.node[vertices]).tolist()})
    return None


def _cannot_hold(holder, path, time):
    """Why what an attachment is held by would not stand still, or None. No holder: the world."""
    if path and not holder:
        return f"there is no prim {path}"
    if holder and root_of(holder):
        return f"{path} is part of a deformable body"
    while holder and not holder.IsPseudoRoot():
        if RIGID in schemas(holder):
            enabled = _value(holder, "enabled", time, True) and _value(holder, "rigid", time, True)
            return None if not enabled or _is_kinematic(holder, time) else f"{holder.GetPath()} is a rigid body that moves freely"
        holder = holder.GetParent()
    return None


def _say_how(prim, body, vertices, holder, time, said):
    places, stiffness = _array(prim, "places", time, 3), _value(prim, "stiffness", time, np.inf)
    if places is not None:
        if len(places) != len(vertices):
            raise input_error(f"{prim.GetPath()}: it has {len(vertices)} vertices and {len(places)} places ({_attribute(prim, 'places').GetName()})")
        scale = to_world(holder or prim.GetStage().GetPseudoRoot(), time)
        away = np.linalg.norm(moved(places, scale) - body.points[vertices], axis=1).max()
        if away > 1e-4 * np.ptp(body.points, axis=0).max():
            said.append(f"{prim.GetPath()}: the vertices are held where they are at rest, up to {away:.3g} m from the places that it gives")
    if np.isfinite(stiffness):
        said.append(f"{prim.GetPath()}: the vertices are held firmly; its stiffness {stiffness:g} is not taken")
    if holder and _moves(holder):
        said.append(f"{prim.GetPath()}: {holder.GetPath()} moves; the vertices are held where they are at rest")
