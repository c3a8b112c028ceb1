"""What reading and writing stages of OpenUSD share."""
import os

import numpy as np

from pliant.convert._files import input_error


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
    matrix = np.array(UsdGeom.XformCache(time).GetLocalToWorldTransform(prim), dtype=np.float64)
    matrix[:, :3] *= UsdGeom.GetStageMetersPerUnit(prim.GetStage())
    return matrix


def moved(points, matrix):
    return points @ matrix[:3, :3] + matrix[3, :3]


def check_cells(corners, points, prim, cell="a cell"):
    if corners.size == 0:
        raise input_error(f"{prim.GetPath()}: it has no cells")
    if corners.min() < 0 or corners.max() >= len(points):
        raise input_error(f"{prim.GetPath()}: {cell} names the point {corners.max() if corners.min() >= 0 else corners.min()} of {len(points)}")
