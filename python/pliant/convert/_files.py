"""What the converters share: files of meshes that Pliant reads, and scenes."""
import base64
import copy
import json
import os
from pathlib import Path

import numpy as np

from pliant._core import Error

MATERIAL = {"law": "neo-hookean", "young": 5000.0, "poisson": 0.45, "density": 1000.0, "damping": 20.0}
"""A soft organ, where nobody says what the tissue is."""

VTK_CELLS = {"triangle": (5, 3), "quad": (9, 4), "tetra": (10, 4), "hexahedron": (12, 8)}
_VTK_TYPES = {"float64": "Float64", "int64": "Int64", "int32": "Int32", "uint8": "UInt8"}


def input_error(text):
    error = Error(text)
    error.code = 2
    return error


def _array(values, name, components=1):
    values = np.ascontiguousarray(values)
    data = values.tobytes()
    text = base64.b64encode(np.uint64(len(data)).tobytes() + data).decode()
    return f'<DataArray type="{_VTK_TYPES[values.dtype.name]}" Name="{name}" NumberOfComponents="{components}" format="binary">{text}</DataArray>\n'


def write_vtu(file, points, blocks, data):
    """points [n, 3] [m]; blocks: pairs of a cell type and its corners; data: by name one number for each cell, block after block."""
    connectivity = np.concatenate([np.asarray(corners, np.int64).ravel() for _, corners in blocks])
    sizes = np.concatenate([np.full(len(corners), VTK_CELLS[kind][1], np.int64) for kind, corners in blocks])
    types = np.concatenate([np.full(len(corners), VTK_CELLS[kind][0], np.uint8) for kind, corners in blocks])
    cells = "".join(_array(_storable(values), _escaped(name)) for name, values in data.items())
    text = ('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
            f'<UnstructuredGrid>\n<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(types)}">\n'
            f'<Points>\n{_array(np.asarray(points, np.float64), "Points", 3)}</Points>\n'
            f'<Cells>\n{_array(connectivity, "connectivity")}{_array(np.cumsum(sizes), "offsets")}{_array(types, "types")}</Cells>\n'
            f"<CellData>\n{cells}</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")
    _replace(file, text)


def write_obj(file, points, faces):
    """points [n, 3] [m]; faces: lists of three or more vertex numbers."""
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in np.asarray(points, dtype=np.float64).tolist()]
    lines += ["f " + " ".join(str(int(v) + 1) for v in face) + "\n" for face in faces]
    _replace(file, "".join(lines))


def _storable(values):
    values = np.asarray(values)
    return values.astype(np.int64) if values.dtype.kind in "iub" else values.astype(np.float64)


def _escaped(name):
    return name.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")


def _replace(file, text):
    """A file appears under its name only when it is complete."""
    file = Path(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(f"{file.name}.part{os.getpid()}")
    part.write_text(text, encoding="utf-8")
    os.replace(part, file)


def stands_on_its_foot(points, up):
    """The entry of `fixed` that holds the lowest twentieth of a body along the axis `up` (0 to 2)."""
    low, high = points[:, up].min(), points[:, up].max()
    place, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
    place[up], normal[up] = float(low + 0.05 * (high - low)), -1.0
    return [{"plane": [place, normal]}]


def scene_of(name, bodies, gravity):
    return {"format": "pliant-scene/1", "name": name, "gravity": gravity, "bodies": bodies}


def save_scene(scene, file):
    """Writes a scene file; meshes that are named by their whole path are named relative to it, so that the folder can move."""
    scene = copy.deepcopy(scene)
    folder = Path(file).resolve().parent
    for body in scene.get("bodies", []):
        for key in ("surface", "mesh"):
            if key in body and os.path.isabs(body[key]):
                body[key] = os.path.relpath(body[key], folder)
    _replace(file, json.dumps(scene, indent=2) + "\n")
