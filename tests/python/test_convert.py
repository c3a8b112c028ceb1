"""pliant.convert: meshes by meshio and stages of OpenUSD as scenes, and results as stages. Each part is left out where its package is not installed."""
import json
import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

from common import SOURCE, box  # first: exits where NumPy is missing
import numpy as np
import pliant
from pliant import convert

try:
    import meshio
except ImportError:
    meshio = None
try:
    from pxr import Gf, Usd, UsdGeom, Vt
except ImportError:
    Gf = Usd = UsdGeom = Vt = None


def error_of(call):
    try:
        call()
    except pliant.Error as error:
        assert "\n" not in str(error), error
        return str(error)
    raise AssertionError("no pliant.Error")


def brick(nx, ny, nz, size=0.01):
    """Points and hexahedra of a brick of cells."""
    number = np.arange((nx + 1) * (ny + 1) * (nz + 1)).reshape(nz + 1, ny + 1, nx + 1)
    points = np.array([[x, y, z] for z in range(nz + 1) for y in range(ny + 1) for x in range(nx + 1)], float) * size
    hexes = [[n[0, 0, 0], n[0, 0, 1], n[0, 1, 1], n[0, 1, 0], n[1, 0, 0], n[1, 0, 1], n[1, 1, 1], n[1, 1, 0]]
             for n in (number[z:z + 2, y:y + 2, x:x + 2] for z in range(nz) for y in range(ny) for x in range(nx))]
    return points, np.array(hexes)


def tetrahedra(hexes):
    """Six for each hexahedron."""
    six = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
    return np.concatenate([hexes[:, six_of] for six_of in six])


def settle(scene, steps=400):
    world = pliant.World(scene, backend="cpu")
    assert not world.step(steps).diverged
    return world


def of_meshio_tetrahedra(folder):
    points, hexes = brick(4, 3, 3)
    tets = tetrahedra(hexes)
    foot = np.array([[0, 4, 1], [1, 4, 5]])  # any faces of the surface
    stiff = points[tets].mean(axis=1)[:, 0] > 0.02
    mesh = meshio.Mesh(points * 1000, [("triangle", foot), ("tetra", tets)],
                       cell_data={"part": [np.array([9, 9]), np.where(stiff, 2, 1)], "region": [np.array([9, 9]), np.where(stiff, 2, 1)],
                                  "E": [np.zeros(2), np.where(stiff, 9000.0, 3000.0)], "fibre": [np.zeros((2, 3)), np.zeros((len(tets), 3))]},
                       cell_sets={"stiff": [np.array([], int), np.flatnonzero(stiff)]})
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        scene = convert.from_meshio(mesh, folder / "organ.vtu", scale=0.001, hold_bottom=True, regions={2: {**convert.MATERIAL, "young": 9000.0}})
    assert [str(w.message) for w in said] == ["cell data 'fibre' has more than one number for each cell and is left out"]
    world = settle(scene)
    warnings.simplefilter("ignore")
    assert world.info["nodes"] == len(points) and world.info["elements"] == len(tets) and world.info["bodies"][0]["name"] == "organ"
    assert np.allclose(world.rest_positions(), points, atol=1e-12), "the nodes keep their order"
    assert world.displacements()[:, 1].min() < -1e-5
    by_name = convert.from_meshio(mesh, folder / "named.vtu", scale=0.001, hold_bottom=True, regions={"stiff": {**convert.MATERIAL, "young": 9000.0}})
    by_field = convert.from_meshio(mesh, folder / "field.vtu", scale=0.001, hold_bottom=True, material={**convert.MATERIAL, "young": {"field": "E"}})
    by_field["bodies"][0]["fixed"][0]["plane"] = by_name["bodies"][0]["fixed"][0]["plane"]
    assert settle(by_name).hash() == world.hash(), "the set of cells is the region"
    soft = convert.from_meshio(mesh, folder / "soft.vtu", scale=0.001, hold_bottom=True, material={**convert.MATERIAL, "young": 3000.0},
                               regions={"stiff": {**convert.MATERIAL, "young": 9000.0}})
    for one in (by_field, soft):
        one["bodies"][0]["element"] = "tet4"  # tet4anp averages over neighbours, but not across the border of an inclusion
    assert np.allclose(settle(by_field).displacements(), settle(soft).displacements(), atol=1e-8), "a modulus for each cell"
    assert "no region 7" in error_of(lambda: convert.from_meshio(mesh, folder / "organ.vtu", regions={7: convert.MATERIAL}))
    assert "['E', 'part', 'region', 'stiff']" in error_of(
        lambda: convert.from_meshio(mesh, folder / "organ.vtu", material={**convert.MATERIAL, "young": {"field": "F"}}))
    scene["bodies"][0]["fixed"] = [{"region": 9, "data": "part", "dimension": 2}]
    pliant.World(scene, backend="cpu")  # the triangles are there for selections
    wrong = folder / "organ.obj"
    assert error_of(lambda: convert.from_meshio(mesh, wrong)) == f"{wrong}: a mesh of tetra is written as .vtu"


def of_meshio_other_cells(folder):
    points, hexes = brick(3, 2, 2)
    scene = convert.from_meshio(meshio.Mesh(points, [("hexahedron", hexes)]), folder / "hexes.vtu", hold_bottom=True)
    assert scene["bodies"][0]["element"] == "hex8" and settle(scene).info["elements"] == len(hexes)
    tets = tetrahedra(hexes)
    second = np.concatenate([tets, np.zeros((len(tets), 6), int)], axis=1)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        scene = convert.from_meshio(meshio.Mesh(points, [("tetra10", second)]), folder / "second.vtu")
    assert "tetra10" in str(said[0].message) and pliant.World(scene, backend="cpu").info["elements"] == len(tets)
    assert "both" in error_of(lambda: convert.from_meshio(meshio.Mesh(points, [("tetra", tets), ("hexahedron", hexes)]), folder / "both.vtu"))
    assert "'wedge'" in error_of(lambda: convert.from_meshio(meshio.Mesh(points, [("wedge", [[0, 1, 2, 3, 4, 5]])]), folder / "w.vtu"))
    assert "no tetrahedra" in error_of(lambda: convert.from_meshio(meshio.Mesh(points, [("line", [[0, 1]])]), folder / "l.vtu"))
    vertices, triangles = box(0.1, 0.08, 0.06)
    scene = convert.from_meshio(meshio.Mesh(vertices, [("triangle", triangles)]), folder / "skin.obj", nodes=300, hold_bottom=True)
    assert 150 < settle(scene).info["nodes"] < 600


def of_meshio_files(folder):
    for name, regions in (("liver_tet.msh", None), ("pear_tet.msh", None), ("cube_tet.vtu", None)):
        source = Path(SOURCE, "scenes/meshes", name)
        scene = convert.from_meshio(source, folder / f"{source.stem}.vtu", regions=regions)
        direct = {**scene, "bodies": [{**scene["bodies"][0], "mesh": str(source)}]}
        one, two = pliant.World(scene, backend="cpu"), pliant.World(direct, backend="cpu")
        one.step(100)
        two.step(100)
        assert one.hash() == two.hash(), f"{name} by meshio and by Pliant itself"
    assert "meshio cannot read it" in error_of(lambda: convert.from_meshio(Path(SOURCE, "README.md"), folder / "x.vtu"))


def stage_of(folder, name="organ.usda"):
    """In centimetres, Z up: a box that is moved and turned, with quadrangles, and a tetrahedral block; and what is no body."""
    stage = Usd.Stage.CreateNew(str(folder / name))
    UsdGeom.SetStageUpAxis(stage, "Z")
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    place = UsdGeom.Xform.Define(stage, "/World/Place")
    place.AddTranslateOp().Set(Gf.Vec3d(20, 0, 5))
    place.AddRotateZOp().Set(90.0)
    stage.SetDefaultPrim(stage.GetPrimAtPath("/World"))
    corners, _ = box(10.0, 8.0, 6.0)
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    skin = UsdGeom.Mesh.Define(stage, "/World/Place/Skin")
    skin.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.concatenate([corners, [[99, 99, 99]]]).astype(np.float32)))  # the last one is in no face
    skin.CreateFaceVertexCountsAttr([4] * 6)
    skin.CreateFaceVertexIndicesAttr([v for q in quads for v in q])
    skin.CreateNormalsAttr([Gf.Vec3f(0, 0, 1)] * 9)
    points, hexes = brick(3, 2, 2, 2.0)
    tets = UsdGeom.TetMesh.Define(stage, "/World/Core")
    tets.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    tets.CreateTetVertexIndicesAttr([Gf.Vec4i(*map(int, t)) for t in tetrahedra(hexes)])
    hidden = UsdGeom.Mesh.Define(stage, "/World/Hidden")
    hidden.MakeInvisible()
    UsdGeom.Mesh.Define(stage, "/World/Guide").CreatePurposeAttr("guide")
    UsdGeom.Camera.Define(stage, "/World/Camera")
    stage.GetRootLayer().Save()
    return stage, corners, points


def of_usd(folder):
    stage, corners, points = stage_of(folder)
    scene = convert.from_usd(folder / "organ.usda", folder / "meshes", nodes=200, hold_bottom=True)
    assert [b["name"] for b in scene["bodies"]] == ["World.Place.Skin", "World.Core"] and scene["gravity"] == [0, 0, -9.81]
    world = settle(scene, 0)
    frame = world.frame()
    first, count = frame.body_vertices[0]
    placed = np.stack([20 - corners[:, 1], corners[:, 0], 5 + corners[:, 2]], axis=1) * 0.01  # a quarter turn about z
    assert count == 8 and np.allclose(sorted(frame.rest[first:first + count].tolist()), sorted(placed.tolist()), atol=1e-6)
    assert np.allclose(world.rest_positions(1), points * 0.01, atol=1e-9) and world.info["bodies"][1]["elements"] == 72
    world.step(300)
    assert world.displacements(0)[:, 2].min() < -1e-4, "gravity acts along z"
    one = convert.from_usd(stage, folder / "other", material=lambda name: {**convert.MATERIAL, "young": 8000.0 if name == "World.Core" else 2000.0})
    assert [b["material"]["young"] for b in one["bodies"]] == [2000.0, 8000.0]
    convert.save_scene(scene, folder / "scene.json")
    saved = json.loads((folder / "scene.json").read_text())
    assert saved["bodies"][1]["mesh"] == "meshes/World.Core.vtu", "relative to the scene"
    assert pliant.World(str(folder / "scene.json"), backend="cpu").info["nodes"] == world.info["nodes"]
    empty = Usd.Stage.CreateInMemory()
    assert "no visible UsdGeom.Mesh" in error_of(lambda: convert.from_usd(empty, folder))
    assert "no such file" in error_of(lambda: convert.from_usd(folder / "none.usda", folder))
    (folder / "broken.usda").write_text("no stage")
    assert "cannot read" in error_of(lambda: convert.from_usd(folder / "broken.usda", folder))
    broken = UsdGeom.Mesh.Define(empty, "/Broken")
    broken.CreatePointsAttr([Gf.Vec3f(0)] * 3)
    broken.CreateFaceVertexCountsAttr([3])
    broken.CreateFaceVertexIndicesAttr([0, 1, 7])
    assert "names the point 7 of 3" in error_of(lambda: convert.from_usd(empty, folder))


def positions_at(mesh, code):
    """Points of a prim in metres in the frame of the stage."""
    matrix = np.array(UsdGeom.Imageable(mesh).ComputeLocalToWorldTransform(code))
    points = np.asarray(mesh.GetPointsAttr().Get(code), np.float64)
    return (points @ matrix[:3, :3] + matrix[3, :3]) * UsdGeom.GetStageMetersPerUnit(mesh.GetPrim().GetStage())


def results_over_a_stage(folder):
    stage_of(folder)
    scene = convert.from_usd(folder / "organ.usda", folder / "meshes", nodes=200, hold_bottom=True)
    world = pliant.World(scene, backend="cpu")
    report = convert.to_usd(folder / "out" / "moved.usda", world, 0.1, fps=50, source=folder / "organ.usda")
    assert not report.diverged and abs(world.time - 0.1) < world.dt
    out = Usd.Stage.Open(str(folder / "out" / "moved.usda"))
    assert out.GetRootLayer().subLayerPaths[0] == "./../organ.usda" and out.GetDefaultPrim().GetPath() == "/World"
    assert UsdGeom.GetStageUpAxis(out) == "Z" and UsdGeom.GetStageMetersPerUnit(out) == 0.01 and out.GetTimeCodesPerSecond() == 50
    skin, core = UsdGeom.Mesh(out.GetPrimAtPath("/World/Place/Skin")), UsdGeom.TetMesh(out.GetPrimAtPath("/World/Core"))
    codes = skin.GetPointsAttr().GetTimeSamples()
    assert len(codes) == 6 and codes == core.GetPointsAttr().GetTimeSamples() and codes[0] == 0 and abs(codes[-1] - 5) < world.dt * 50
    assert not skin.GetFaceVertexIndicesAttr().GetTimeSamples() and not skin.GetNormalsAttr().Get(), "its polygons stay, normals do not"
    frame = world.frame()
    first, count = frame.body_vertices[0]
    written = positions_at(skin, codes[-1])
    assert len(written) == 9 and np.allclose(written[8], [0.2 - 0.99, 0.99, 0.05 + 0.99], atol=1e-6), "what is in no face stays"
    distances = np.linalg.norm(written[:8, None] - frame.positions[None, first:first + count], axis=2)
    assert distances.min(axis=1).max() < 1e-6 and sorted(distances.argmin(axis=1)) == list(range(8))
    assert np.abs(written[:8] - positions_at(skin, 0)[:8]).max() > 2e-4, "it has moved"
    assert np.allclose(positions_at(core, codes[-1]), world.rest_positions(1) + world.displacements(1), atol=1e-6)
    original = Usd.Stage.Open(str(folder / "organ.usda"))
    assert original.GetPrimAtPath("/World/Core").GetAttribute("points").GetNumTimeSamples() == 0, "the source stays as it is"
    other = pliant.World({**scene, "bodies": [{**scene["bodies"][0], "name": "else"}]}, backend="cpu")
    assert "no prim /else" in error_of(lambda: convert.UsdWriter(folder / "e.usda", other, source=folder / "organ.usda"))
    shifted = pliant.World({**scene, "bodies": [{**scene["bodies"][0], "translate": [0.1, 0, 0]}]}, backend="cpu")
    assert "not from_usd() of this stage" in error_of(lambda: convert.UsdWriter(folder / "e.usda", shifted, source=folder / "organ.usda"))


def results_with_a_cut(folder):
    stage_of(folder)
    scene = convert.from_usd(folder / "organ.usda", folder / "meshes", nodes=400, hold_bottom=True)
    scene["bodies"] = scene["bodies"][:1]
    for source in (None, folder / "organ.usda"):
        world = pliant.World(scene, backend="cpu")
        with convert.UsdWriter(folder / "cut.usda", world, source=source, fps=100, up_axis="Z") as out:
            out.add()
            world.advance(0.02)
            world.cut([[[0.0, -1, 0.08], [0.4, -1, 0.08], [0.2, 3, 0.08]]])
            world.advance(0.02)
            out.add()
        stage = Usd.Stage.Open(str(folder / "cut.usda"))
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/Place/Skin" if source else "/pliant/World_Place_Skin"))
        start, end = mesh.GetFaceVertexIndicesAttr().GetTimeSamples()
        frame = world.frame()
        assert world.pieces() == 2 and len(mesh.GetFaceVertexCountsAttr().Get(end)) == len(frame.triangles)
        assert len(mesh.GetFaceVertexCountsAttr().Get(start)) == (6 if source else 12), "the polygons before the cut"
        assert np.allclose(positions_at(mesh, end), frame.positions, atol=1e-6) and len(mesh.GetPointsAttr().Get(start)) == (9 if source else 8)
        problems = mesh.ValidateTopology(mesh.GetFaceVertexIndicesAttr().Get(end), mesh.GetFaceVertexCountsAttr().Get(end), len(frame.positions))
        assert problems[0] if isinstance(problems, tuple) else problems
    assert "the source itself" in error_of(lambda: convert.UsdWriter(folder / "organ.usda", world, source=folder / "organ.usda"))
    assert "written as .usd" in error_of(lambda: convert.UsdWriter(folder / "cut.obj", world))


def mirrored_and_instanced(folder):
    stage, _, _ = stage_of(folder, "pair.usda")
    for name, scale in (("Left", 1), ("Right", -1)):
        one = UsdGeom.Xform.Define(stage, f"/Pair/{name}")
        one.AddTranslateOp().Set(Gf.Vec3d(40 * scale, 50, 0))
        one.AddScaleOp().Set(Gf.Vec3f(scale, 1, 1))
        one.GetPrim().GetReferences().AddInternalReference("/World/Place")
        one.GetPrim().SetInstanceable(name == "Left")
    stage.GetRootLayer().Save()
    scene = convert.from_usd(stage, folder / "meshes", nodes=200)
    names = [b["name"] for b in scene["bodies"]]
    assert names[2:] == ["Pair.Left.Skin", "Pair.Right.Skin"]
    right = scene["bodies"][3]
    world = pliant.World({**scene, "bodies": [right]}, backend="cpu")
    frame = world.frame()
    a, b, c = (frame.rest[frame.triangles[:, k]].astype(float) for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert np.isclose(volume, 0.1 * 0.08 * 0.06, rtol=1e-4), "outward, though mirrored"
    with convert.UsdWriter(folder / "mirror.usda", world, source=stage, fps=100) as out:
        world.cut([[[-2.0, -2, 0.03], [2, -2, 0.03], [0, 5, 0.03]]])
        out.add()
    mesh = UsdGeom.Mesh(out.stage.GetPrimAtPath("/Pair/Right/Skin"))
    triangles = np.asarray(mesh.GetFaceVertexIndicesAttr().Get(0)).reshape(-1, 3)
    a, b, c = (np.asarray(mesh.GetPointsAttr().Get(0), float)[triangles[:, k]] for k in range(3))
    assert np.isclose(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6, 480, rtol=1e-3), "right-handed in the prim's own frame [cm^3]"
    left = pliant.World({**scene, "bodies": [scene["bodies"][2]]}, backend="cpu")
    assert "part of an instance" in error_of(lambda: convert.UsdWriter(folder / "left.usda", left, source=stage))


def the_command(folder):
    def run(*arguments, code=0):
        done = subprocess.run([sys.executable, "-m", "pliant", "convert", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        assert done.returncode == code, done.stdout
        return done.stdout

    assert "OUT" in run("--help")
    if meshio:
        run(Path(SOURCE, "scenes/meshes/liver_tet.msh"), folder / "liver.json", "--young", "3000", "--hold-bottom")
        assert json.loads((folder / "liver.json").read_text())["bodies"][0]["mesh"] == "liver.vtu"
    if Usd:
        stage_of(folder, "in.usda")
        assert "2 bodies: World.Place.Skin, World.Core" in run(folder / "in.usda", folder / "made" / "scene.json", "--hold-bottom", "--nodes", "200")
        run(folder / "made" / "scene.json", folder / "out.usda", "--seconds", "0.05", "--fps", "40", "--over", folder / "in.usda", "--backend", "cpu")
        out = Usd.Stage.Open(str(folder / "out.usda"))
        assert out.GetPrimAtPath("/World/Place/Skin").GetAttribute("points").GetNumTimeSamples() == 3
        assert "written as .json" in run(folder / "in.usda", folder / "scene.txt", code=2)
    if meshio or Usd:
        assert "pliant: " in run(folder / "none.msh", folder / "x.json", code=2)


def without_the_packages():
    """One sentence names what to install."""
    call = ("import sys; sys.modules['meshio'] = sys.modules['pxr'] = None\nfrom pliant import convert\n"
            "for call in (lambda: convert.from_meshio('a', 'b'), lambda: convert.from_usd('a', 'b'), lambda: convert.to_usd('a', None, 1)):\n"
            "    try:\n        call()\n    except ImportError as error:\n        print(error)")
    said = subprocess.run([sys.executable, "-c", call], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    assert len(said) == 3 and "pip install meshio" in said[0] and all("pip install usd-core" in line for line in said[1:]), said


if __name__ == "__main__":
    parts = [("meshio", meshio, [of_meshio_tetrahedra, of_meshio_other_cells, of_meshio_files]),
             ("usd-core", Usd, [of_usd, results_over_a_stage, results_with_a_cut, mirrored_and_instanced])]
    without_the_packages()
    for package, there, tests in parts:
        if not there:
            print(f"left out: {package} is not installed (pip install {package})")
            continue
        for test in tests:
            with tempfile.TemporaryDirectory() as name:
                test(Path(name))
    with tempfile.TemporaryDirectory() as name:
        the_command(Path(name))
    print("ok")
    if not meshio and not Usd:
        sys.exit(77)
