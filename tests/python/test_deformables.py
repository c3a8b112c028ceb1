"""convert.from_usd of stages with deformable bodies, in the names of the proposed schema and in those of Omniverse. Left out where usd-core is missing."""
import json
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

from test_convert import Gf, Usd, UsdGeom, Vt, brick, error_of, settle, tetrahedra  # first: exits where NumPy is missing
import numpy as np
import pliant
from pliant import convert

if not Usd:
    print("left out: usd-core is not installed (pip install usd-core)")
    sys.exit(77)
from pxr import Sdf, UsdPhysics, UsdShade

KINDS = Sdf.ValueTypeNames
PROPOSED = {"prefix": "physics:", "body": "PhysicsDeformableBodyAPI", "sim": "PhysicsVolumeDeformableSimAPI", "enabled": "bodyEnabled",
            "material": ["PhysicsMaterialAPI", "PhysicsVolumeDeformableMaterialAPI"], "cells": "restTetVertexIndices", "attachment": "PhysicsAttachment",
            "vertices": "indices0", "places": "coords1", "filter": "PhysicsElementCollisionFilter"}
OMNIVERSE = {"prefix": "omniphysics:", "body": "OmniPhysicsDeformableBodyAPI", "sim": "OmniPhysicsVolumeDeformableSimAPI",
             "enabled": "deformableBodyEnabled", "material": ["OmniPhysicsBaseMaterialAPI", "OmniPhysicsDeformableMaterialAPI"],
             "cells": "restTetVtxIndices", "attachment": "OmniPhysicsVtxXformAttachment", "vertices": "vtxIndicesSrc0", "places": "localPositionsSrc1",
             "filter": "OmniPhysicsElementCollisionFilter"}
POINTS, HEXES = brick(3, 2, 2, 2.0)  # [cm]: 6 x 4 x 4
CELLS = tetrahedra(HEXES)
PLACE = np.array([1.0, 2.0, 3.0])
FOOT = np.flatnonzero(POINTS[:, 2] == 0).tolist()


def vectors(points):
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points, dtype=np.float32))


def put(prim, name, kind, value):
    prim.CreateAttribute(name, kind).Set(value)


def apply(prim, *names):
    for name in names:
        prim.AddAppliedSchema(name)


class Asset:
    """In centimetres, grams and seconds, Z up: a body with its simulation mesh, the mesh that is seen, a material, and a table that holds its foot."""

    def __init__(self, words, rest=POINTS, rest_cells=None):
        self.words, self.stage = words, Usd.Stage.CreateInMemory()
        UsdGeom.SetStageUpAxis(self.stage, "Z")
        UsdGeom.SetStageMetersPerUnit(self.stage, 0.01)
        UsdPhysics.SetStageKilogramsPerUnit(self.stage, 0.001)
        self.body = UsdGeom.Xform.Define(self.stage, "/World/Liver")
        self.body.AddTranslateOp().Set(Gf.Vec3d(*PLACE))
        self.body = self.body.GetPrim()
        apply(self.body, words["body"])
        mesh = UsdGeom.TetMesh.Define(self.stage, "/World/Liver/Sim")
        mesh.CreatePointsAttr(vectors(POINTS))
        mesh.CreateTetVertexIndicesAttr([Gf.Vec4i(*map(int, t)) for t in CELLS])
        mesh.CreatePurposeAttr("guide")  # tools hide it behind what is seen
        self.mesh = mesh.GetPrim()
        apply(self.mesh, words["sim"], "PhysicsCollisionAPI")
        self.set(self.mesh, "restShapePoints", KINDS.Point3fArray, vectors(rest))
        self.set(self.mesh, words["cells"], KINDS.Int4Array, [Gf.Vec4i(*map(int, t)) for t in (CELLS if rest_cells is None else rest_cells)])
        UsdGeom.Xform.Define(self.stage, "/World/Liver/Parts")
        seen = UsdGeom.Mesh.Define(self.stage, "/World/Liver/Parts/Seen")
        seen.CreatePointsAttr(vectors(POINTS[-4:]))
        seen.CreateFaceVertexCountsAttr([3])
        seen.CreateFaceVertexIndicesAttr([0, 1, 2])
        material = UsdShade.Material.Define(self.stage, "/World/Tissue")
        self.material = material.GetPrim()
        apply(self.material, *words["material"])
        for name, value in (("youngsModulus", 30000.0), ("poissonsRatio", 0.45), ("density", 1.06), ("dynamicFriction", 0.3)):
            self.set(self.material, name, KINDS.Float, value)  # 30000 g/(cm s^2) are 3000 Pa
        UsdShade.MaterialBindingAPI.Apply(self.body).Bind(material, materialPurpose="physics")
        self.table = UsdGeom.Cube.Define(self.stage, "/World/Table").GetPrim()
        apply(self.table, "PhysicsCollisionAPI")
        self.hold("/World/Hold", FOOT, POINTS[FOOT] + PLACE)

    def set(self, prim, name, kind, value):
        put(prim, self.words["prefix"] + name, kind, value)

    def hold(self, path, vertices, places, by="/World/Table"):
        prim = self.stage.DefinePrim(path, self.words["attachment"])
        prim.CreateRelationship(self.words["prefix"] + "src0").SetTargets([self.mesh.GetPath()])
        prim.CreateRelationship(self.words["prefix"] + "src1").SetTargets([by] if by else [])
        self.set(prim, self.words["vertices"], KINDS.IntArray, vertices)
        self.set(prim, self.words["places"], KINDS.Vector3fArray, vectors(places))
        return prim

    def scene(self, folder, **options):
        """The scene, and what is said."""
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            scene = convert.from_usd(self.stage, folder, **options)
        assert all(w.filename == __file__ for w in said), "warnings name the caller"
        return scene, [str(w.message) for w in said]

    def error(self, folder):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return error_of(lambda: convert.from_usd(self.stage, folder))


def as_written(folder):
    """Everything that a scene takes, in SI units, and nothing to say."""
    for words in (PROPOSED, OMNIVERSE):
        scene, said = Asset(words).scene(folder)
        assert said == [], said
        (body,) = scene["bodies"]
        assert body["name"] == "World.Liver.Sim" and body["element"] == "tet4anp" and body["fixed"] == [{"nodes": FOOT}]
        material = body["material"]
        assert material["young"] == 3000 and material["poisson"] == 0.45 and np.isclose(material["density"], 1060, rtol=1e-12)
        assert scene["contact"] == {"friction": 0.3} and scene["gravity"] == [0, 0, -9.81]
        world = settle(scene, 200)
        assert np.allclose(world.rest_positions(), (POINTS + PLACE) * 0.01, atol=1e-7)
        moved = world.displacements()
        assert np.all(moved[FOOT] == 0) and moved[:, 2].min() < -1e-5, "it sags, and its foot is held"


def in_layers(folder):
    """A referenced asset, instanced or not, where a stronger layer applies a schema of its own."""
    asset = Asset(PROPOSED)
    asset.stage.SetDefaultPrim(asset.stage.GetPrimAtPath("/World"))
    asset.stage.Export(str(folder / "asset.usda"))
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    for name, instanced in (("A", True), ("B", False)):
        top = UsdGeom.Xform.Define(stage, f"/{name}")
        top.AddTranslateOp().Set(Gf.Vec3d(0, 10.0 * (name == "B"), 0))
        top.GetPrim().GetReferences().AddReference(str(folder / "asset.usda"))
        top.GetPrim().SetInstanceable(instanced)
    apply(stage.GetPrimAtPath("/B/Liver"), "OurOwnAPI")
    scene = convert.from_usd(stage, folder)
    assert [b["name"] for b in scene["bodies"]] == ["A.Liver.Sim", "B.Liver.Sim"] and all(b["fixed"] == [{"nodes": FOOT}] for b in scene["bodies"])
    assert scene["bodies"][0]["material"]["young"] == 3e6, "kilograms, where the stage itself says nothing"


def rest_shapes(folder):
    """The nodes are the points in their order, where the rest shape has them, also with other numbers."""
    order = np.random.default_rng(1).permutation(len(POINTS))
    number = np.argsort(order)
    asset = Asset(PROPOSED, rest=(0.5 * POINTS)[order], rest_cells=number[CELLS])
    scene, said = asset.scene(folder)
    assert len(said) == 2 and "starts in its rest shape; its points are up to 0.03 m from there" in said[0] and "up to 0.03" in said[1], said
    world = settle(scene, 20)
    assert np.allclose(world.rest_positions(), (0.5 * POINTS + PLACE) * 0.01, atol=1e-7) and scene["bodies"][0]["fixed"] == [{"nodes": FOOT}]
    asset.stage.Export(str(folder / "asset.usda"))
    convert.to_usd(folder / "moved.usda", world, 0.01, fps=100, source=folder / "asset.usda")
    out = Usd.Stage.Open(str(folder / "moved.usda"))
    written = UsdGeom.TetMesh(out.GetPrimAtPath("/World/Liver/Sim")).GetPointsAttr()
    assert np.allclose((np.asarray(written.Get(written.GetTimeSamples()[-1])) + PLACE) * 0.01, world.rest_positions() + world.displacements(), atol=1e-6)
    apart = np.arange(4 * len(CELLS)).reshape(-1, 4)
    pieces = POINTS[CELLS].reshape(-1, 3)
    scene, said = Asset(PROPOSED, rest=pieces, rest_cells=apart).scene(folder)
    assert said == [], "pieces that fit together are one"
    scene, said = Asset(PROPOSED, rest=pieces + np.repeat(np.arange(len(CELLS)), 4)[:, None], rest_cells=apart).scene(folder)
    assert len(said) == 1 and "in pieces" in said[0]
    assert np.allclose(settle(scene, 0).rest_positions(), (POINTS + PLACE) * 0.01, atol=1e-7)
    few = Asset(PROPOSED, rest=POINTS[:5])
    assert few.error(folder) == f"/World/Liver/Sim: a rest cell names the point {CELLS.max()} of 5"
    few.set(few.mesh, "restTetVertexIndices", KINDS.Int4Array, [Gf.Vec4i(0, 1, 2, 3)])
    assert "72 cells and 1 rest cells" in few.error(folder)


def what_is_seen_moves(folder):
    """A mesh in the body goes with the tetrahedra around its points in the bind pose, which need not be its points now."""
    for words, api, names in ((PROPOSED, "PhysicsDeformablePoseAPI:ours", "physics:deformablePose:ours:{}"),
                              (OMNIVERSE, "OmniPhysicsDeformablePoseAPI:ours", "deformablePose:ours:omniphysics:{}")):
        asset = Asset(words)
        inside = np.array([[1.0, 1, 3], [5, 1.5, 3.5], [3, 3, 4], [6.5, 2, 4]])  # the last one is outside
        seen = UsdGeom.Mesh(asset.stage.GetPrimAtPath("/World/Liver/Parts/Seen"))
        UsdGeom.Xformable(asset.stage.GetPrimAtPath("/World/Liver/Parts")).AddTranslateOp().Set(Gf.Vec3d(0, 0, 1))
        seen.GetPointsAttr().Set(vectors(inside + 50))
        apply(seen.GetPrim(), api)
        put(seen.GetPrim(), names.format("purposes"), KINDS.TokenArray, ["bindPose"])
        put(seen.GetPrim(), names.format("points"), KINDS.Point3fArray, vectors(inside - [0, 0, 1]))
        stage = folder / f"{words['prefix'][:-1]}.usda"
        asset.stage.Export(str(stage))
        world = pliant.World(asset.scene(folder)[0], backend="cpu")
        shear = np.zeros((len(POINTS), 3))
        shear[:, 0] = 0.25 * POINTS[:, 2] * 0.01  # a linear motion, which every point follows exactly
        world.set_state(displacements=shear)
        with convert.UsdWriter(folder / f"moved_{stage.name}", world, source=stage) as out:
            out.add()
        written = np.asarray(UsdGeom.Mesh(out.stage.GetPrimAtPath("/World/Liver/Parts/Seen")).GetPointsAttr().Get(0.0)) + [0, 0, 1]
        assert np.allclose(written, inside + 0.25 * inside[:, 2:] * [1, 0, 0], atol=1e-4), written


def masses(folder):
    """Masses of the mesh count most, then mass and density of the body, then the material's; and what is not said is assumed aloud."""
    volume = 6 * 4 * 4 * 1e-6
    asset = Asset(PROPOSED)
    for prim, name, kind, value, density in ((asset.body, "density", KINDS.Float, 1.2, 1200), (asset.body, "mass", KINDS.Float, 192.0, 0.192 / volume),
                                             (asset.mesh, "masses", KINDS.FloatArray, [480.0], 0.48 / volume)):
        asset.set(prim, name, kind, value)
        scene, said = asset.scene(folder)
        assert np.isclose(scene["bodies"][0]["material"]["density"], density, rtol=1e-6) and said == [], (name, said)
    asset.set(asset.mesh, "masses", KINDS.FloatArray, [480.0 / len(CELLS)] * len(CELLS))
    scene, said = asset.scene(folder)
    assert np.isclose(scene["bodies"][0]["material"]["density"], 0.48 / volume, rtol=1e-6) and "the sum is taken" in said[0]
    bare = Asset(PROPOSED)
    for name in ("youngsModulus", "poissonsRatio", "density"):
        bare.material.RemoveProperty("physics:" + name)
    scene, said = bare.scene(folder)
    assert scene["bodies"][0]["material"] == {**convert.MATERIAL, "young": 1e6, "poisson": 0.3} and "young 1e+06, poisson 0.3, density 1000" in said[0]
    UsdShade.MaterialBindingAPI(bare.body).UnbindAllBindings()
    scene, said = bare.scene(folder)
    assert scene["bodies"][0]["material"] == convert.MATERIAL and "no physics material" in said[0] and scene["contact"] is True


def options_win(folder):
    asset = Asset(OMNIVERSE)
    stiff = {**convert.MATERIAL, "young": 7e4}
    scene, said = asset.scene(folder, material=stiff, contact=False, hold_bottom=True)
    assert scene["bodies"][0]["material"] == stiff and "contact" not in scene and len(scene["bodies"][0]["fixed"]) == 2 and said == []
    assert asset.scene(folder, contact={"friction": 0.1})[0]["contact"] == {"friction": 0.1}
    asset.set(asset.material, "dynamicFriction", KINDS.Float, -1.0)
    assert asset.scene(folder, contact=True)[0]["contact"] is True, "what is given is not read in the stage"
    asset.set(asset.material, "dynamicFriction", KINDS.Float, 0.3)
    asset.set(asset.material, "poissonsRatio", KINDS.Float, 0.5)
    asset.stage.Export(str(folder / "asset.usda"))
    run = [sys.executable, "-m", "pliant", "convert", str(folder / "asset.usda"), str(folder / "asset.json")]
    done = subprocess.run(run, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 2 and "/World/Tissue: omniphysics:poissonsRatio is 0.5" in done.stdout, done.stdout
    asset.set(asset.mesh, "unheardOf", KINDS.Float, 1.0)
    asset.stage.Export(str(folder / "asset.usda"))
    done = subprocess.run([*run, "--poisson", "0.49"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=True)
    assert "pliant: /World/Liver/Sim: not taken: omniphysics:unheardOf" in done.stdout, done.stdout
    material = json.loads((folder / "asset.json").read_text())["bodies"][0]["material"]
    assert (material["young"], material["poisson"]) == (3000, 0.49)


def what_holds(folder):
    """The world, what stands still and what is kinematic hold; what moves freely does not, nor what is not enabled."""
    asset = Asset(PROPOSED)
    rod = UsdGeom.Xform.Define(asset.stage, "/World/Rod").GetPrim()
    apply(rod, "PhysicsRigidBodyAPI")
    asset.hold("/World/ByRod", [0, 1], (POINTS + PLACE)[[0, 1]], by="/World/Rod")
    asset.hold("/World/ByWorld", [5, 5], (POINTS + PLACE)[[5, 5]], by=None)
    off = asset.hold("/World/Off", [7], (POINTS + PLACE)[[7]])
    asset.set(off, "attachmentEnabled", KINDS.Bool, False)
    scene, said = asset.scene(folder)
    assert scene["bodies"][0]["fixed"] == [{"nodes": FOOT}, {"nodes": [5]}]
    assert said == ["/World/ByRod: this attachment is not taken: /World/Rod is a rigid body that moves freely"]
    put(rod, "physics:kinematicEnabled", KINDS.Bool, True)
    scene, said = asset.scene(folder)
    assert scene["bodies"][0]["fixed"] == [{"nodes": FOOT}, {"nodes": [0, 1]}, {"nodes": [5]}]
    assert said == [], said
    soft = asset.hold("/World/Soft", [8], (POINTS + PLACE + 1)[[8]])
    asset.set(soft, "stiffness", KINDS.Float, 50.0)
    face = asset.hold("/World/Face", [8], (POINTS + PLACE)[[8]])
    asset.set(face, "type0", KINDS.Token, "face")
    said = asset.scene(folder)[1]
    assert len(said) == 3 and "0.0173 m from the places" in said[0] and "held firmly" in said[1] and "face and xform" in said[2], said
    pliant.World(asset.scene(folder)[0], backend="cpu")
    still = Asset(OMNIVERSE)
    still.set(still.body, "kinematicEnabled", KINDS.Bool, True)
    scene, said = still.scene(folder)
    assert scene["bodies"][0]["fixed"] == [{"all": True}] and said == []
    other = {**asset.scene(folder)[0]["bodies"][0], "name": "free", "translate": [0.2, 0, 0]}
    assert np.all(settle({**scene, "bodies": [*scene["bodies"], other]}, 20).displacements(0) == 0)


def a_point_of_no_cell(folder):
    """It is no node, and the others have the numbers that are left."""
    asset = Asset(PROPOSED)
    mesh = UsdGeom.TetMesh(asset.mesh)
    mesh.GetPointsAttr().Set(vectors(np.concatenate([[[99, 99, 99]], POINTS])))
    mesh.GetTetVertexIndicesAttr().Set([Gf.Vec4i(*map(int, t)) for t in CELLS + 1])
    for name in ("restShapePoints", "restTetVertexIndices"):
        asset.mesh.RemoveProperty("physics:" + name)
    asset.stage.RemovePrim("/World/Hold")
    asset.hold("/World/Foot", [v + 1 for v in FOOT], POINTS[FOOT] + PLACE)
    scene, said = asset.scene(folder)
    assert said == [] and scene["bodies"][0]["fixed"] == [{"nodes": FOOT}]
    assert np.allclose(settle(scene, 0).rest_positions(), (POINTS + PLACE) * 0.01, atol=1e-7)
    asset.hold("/World/Wrong", [0], [[99, 99, 99]])
    assert asset.error(folder) == "/World/Wrong: physics:indices0 names the point 0, which is in no cell of /World/Liver/Sim"


def what_is_not_taken(folder):
    """One remark each."""
    asset = Asset(PROPOSED)
    cloth = UsdGeom.Mesh.Define(asset.stage, "/World/Cloth").GetPrim()
    apply(cloth, "PhysicsDeformableBodyAPI", "PhysicsSurfaceDeformableSimAPI")
    apply(UsdGeom.BasisCurves.Define(asset.stage, "/World/Thread").GetPrim(), "PhysicsCurvesDeformableSimAPI")
    asset.stage.DefinePrim("/World/Filter", "PhysicsElementCollisionFilter")
    UsdGeom.Mesh.Define(asset.stage, "/World/Wall")
    asset.set(asset.material, "staticFriction", KINDS.Float, 0.5)
    put(asset.body, "physxDeformableBody:selfCollision", KINDS.Bool, True)
    scene, said = asset.scene(folder)
    assert len(scene["bodies"]) == 1 and said == [
        "/World/Cloth: a surface deformable body is not taken; of these bodies those of tetrahedra are",
        "/World/Thread: a curves deformable body is not taken; of these bodies those of tetrahedra are",
        "/World/Liver: not taken: physxDeformableBody:selfCollision", "/World/Tissue: not taken: physics:staticFriction",
        "/World/Filter: collision filters of elements are not taken",
        "the stage says which bodies are deformable; meshes that belong to none are left out (1): /World/Wall"], said
    quiet = Asset(PROPOSED)
    quiet.mesh.RemoveAppliedSchema("PhysicsCollisionAPI")
    scene, said = quiet.scene(folder)
    assert "contact" not in scene and said == ["/World/Liver: its friction is not taken, as it has no collider"]
    quiet.set(quiet.body, "bodyEnabled", KINDS.Bool, False)
    assert "no deformable body that is taken; /World/Liver: it is not enabled" in quiet.error(folder)


def bad_values(folder):
    """One message, with the prim."""
    for name, value, told in (("poissonsRatio", 0.5, "is 0.5; above -1 and below 0.5 is allowed, such as 0.49"),
                              ("youngsModulus", -3.0, "is -3; a number above 0 is allowed"), ("youngsModulus", float("nan"), "is nan; a number"),
                              ("density", -1.0, "is -1; a number above 0"), ("dynamicFriction", -0.5, "is -0.5; 0 or more")):
        asset = Asset(OMNIVERSE)
        asset.set(asset.material, name, KINDS.Float, value)
        assert asset.error(folder).startswith(f"/World/Tissue: omniphysics:{name} {told}"), asset.error(folder)
    for vertex in (len(POINTS), -1):
        asset = Asset(PROPOSED)
        asset.hold("/World/Wrong", [3, vertex], POINTS[[3, 3]])
        told = f"/World/Wrong: physics:indices0 names the point {vertex}; /World/Liver/Sim has those from 0 to {len(POINTS) - 1}"
        assert asset.error(folder) == told
    asset = Asset(PROPOSED)
    asset.hold("/World/Wrong", [3, 4], POINTS[[3]])
    assert "2 vertices and 1 places" in asset.error(folder)
    asset = Asset(PROPOSED)
    asset.set(asset.body, "mass", KINDS.Float, -2.0)
    assert "/World/Liver: physics:mass is -2" in asset.error(folder)


if __name__ == "__main__":
    for test in (as_written, in_layers, rest_shapes, what_is_seen_moves, masses, options_win, what_holds, a_point_of_no_cell, what_is_not_taken, bad_values):
        with tempfile.TemporaryDirectory() as name:
            test(Path(name))
    print("ok")
