"""python -m pliant convert IN OUT"""
import argparse
import sys
from pathlib import Path

import pliant
from pliant._codes import exit_code
from pliant.convert import MATERIAL, from_meshio, save_scene, to_usd
from pliant.convert._usd_in import scene_of_stage

STAGES = (".usd", ".usda", ".usdc", ".usdz")


def _parser():
    parser = argparse.ArgumentParser(prog="python -m pliant convert", description="Makes a scene of a mesh (meshio) or a stage (OpenUSD), "
                                     "or runs a scene and writes its motion as a stage.")
    parser.add_argument("source", metavar="IN", help="a mesh that meshio reads, a stage of USD, or a scene (.json)")
    parser.add_argument("out", metavar="OUT", help="a scene (.json), with its meshes beside it; of a scene a stage (.usd, .usda, .usdc)")
    parser.add_argument("--young", type=float, help="Young's modulus [Pa] (of the stage, or 5000)")
    parser.add_argument("--poisson", type=float, help="Poisson's ratio (of the stage, or 0.45)")
    parser.add_argument("--density", type=float, help="[kg/m^3] (of the stage, or 1000)")
    parser.add_argument("--nodes", type=int, default=2000, help="about how many nodes the lattice in a surface has (2000)")
    parser.add_argument("--scale", type=float, default=1.0, help="metres per unit of a mesh; a stage says it itself (1)")
    parser.add_argument("--hold-bottom", action="store_true", help="hold the lowest twentieth of each body")
    parser.add_argument("--seconds", type=float, default=1.0, help="of a scene: the time that is run (1)")
    parser.add_argument("--fps", type=float, default=60.0, help="of a scene: states per second (60)")
    parser.add_argument("--over", metavar="STAGE", help="of a scene that was made of a stage: move the prims of that stage")
    parser.add_argument("--backend", default="auto", help="of a scene: as `pliant devices` names them (auto)")
    return parser


def _scene(options):
    out = Path(options.out)
    if out.suffix != ".json":
        raise pliant.convert._files.input_error(f"{out}: a scene is written as .json")
    over = {key: value for key in ("young", "poisson", "density") if (value := getattr(options, key)) is not None}
    common = {"nodes": options.nodes, "hold_bottom": options.hold_bottom}
    if Path(options.source).suffix.lower() in STAGES:
        scene, said = scene_of_stage(options.source, out.parent, material=None, contact=None, time=None, over=over, **common)
        for text in said:
            print(f"pliant: {text}", file=sys.stderr)
    else:
        scene = _of_mesh(options, out, {**common, "material": {**MATERIAL, **over}})
    save_scene(scene, out)
    print(f"{out}: {len(scene['bodies'])} bodies: {', '.join(b['name'] for b in scene['bodies'])}")


def _of_mesh(options, out, common):
    """A volume mesh is a .vtu, a surface an .obj; which one it is, meshio knows."""
    from pliant.convert import _meshio

    mesh = _meshio._read(options.source)
    solid = any(kind in ("tetra", "hexahedron") for _, kind, _ in _meshio._blocks(mesh))
    return from_meshio(mesh, out.with_suffix(".vtu" if solid else ".obj"), scale=options.scale, **common)


def main(arguments):
    options = _parser().parse_args(arguments)
    is_scene = Path(options.source).suffix.lower() == ".json"
    return exit_code(lambda: _stage(options) if is_scene else _scene(options))


def _stage(options):
    world = pliant.World(options.source, backend=options.backend)
    report = to_usd(options.out, world, options.seconds, fps=options.fps, source=options.over)
    print(f"{options.out}: {report.time:.4g} s")
    if not report.diverged:
        return 0
    print(f"pliant: {report.message}", file=sys.stderr)
    return 4
