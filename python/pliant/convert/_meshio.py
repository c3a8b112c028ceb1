"""Scenes from meshes that meshio reads: Abaqus, ANSYS, CGNS, Gmsh, MED, Nastran, VTK, XDMF and others."""
import os
import warnings
from pathlib import Path

import numpy as np

from pliant.convert._files import MATERIAL, input_error, scene_of, stands_on_its_foot, write_obj, write_vtu

_LINEAR = {"triangle6": "triangle", "triangle7": "triangle", "quad8": "quad", "quad9": "quad", "tetra10": "tetra", "hexahedron20": "hexahedron",
           "hexahedron27": "hexahedron"}
_CORNERS = {"triangle": 3, "quad": 4, "tetra": 4, "hexahedron": 8}
_IGNORED = {"vertex", "line", "line3"}
_TAGS = ("gmsh:physical", "medit:ref", "cellentityids", "materialids", "material", "region", "label")  # docs/scene.md: where `region` looks first


def _read(mesh):
    try:
        import meshio
    except ImportError:
        raise ImportError("pliant.convert.from_meshio needs meshio: pip install meshio") from None
    if isinstance(mesh, meshio.Mesh):
        return mesh
    try:
        return meshio.read(mesh)
    except meshio.ReadError as error:
        raise input_error(f"{os.fspath(mesh)}: meshio cannot read it: {error}") from None


def _blocks(mesh):
    """(number in the mesh, linear cell type, corners) of each block that Pliant has a use for."""
    blocks = []
    for number, block in enumerate(mesh.cells):
        kind = _LINEAR.get(block.type, block.type)
        if kind in _IGNORED:
            continue
        if kind not in _CORNERS:
            raise input_error(f"cells of the type {block.type!r}; Pliant has tetrahedra, hexahedra, triangles and quadrangles")
        if kind != block.type:
            warnings.warn(f"{block.type} cells are taken as {kind}: their straight edges between the corners", stacklevel=4)
        blocks.append((number, kind, np.asarray(block.data)[:, :_CORNERS[kind]]))
    return blocks


def _cell_data(mesh, blocks):
    """By name, one number for each cell of the blocks: the arrays of cell data, and the cell sets as 0 and 1."""
    data = {}
    for name, parts in mesh.cell_data.items():
        arrays = [np.asarray(parts[number]) for number, _, _ in blocks]
        arrays = [a[:, 0] if a.ndim == 2 and a.shape[1] == 1 else a for a in arrays]
        if all(a.ndim == 1 and a.dtype.kind in "iubf" for a in arrays):
            data[name] = np.concatenate(arrays)
        else:
            warnings.warn(f"cell data {name!r} has more than one number for each cell and is left out", stacklevel=4)
    for name, parts in mesh.cell_sets.items():
        if name.startswith("gmsh:bounding") or name in data:
            continue
        marks = []
        for number, _, corners in blocks:
            mark = np.zeros(len(corners), np.int64)
            if parts[number] is not None:
                mark[np.asarray(parts[number], dtype=np.int64)] = 1
            marks.append(mark)
        data[name] = np.concatenate(marks)
    return data


def _region(key, mesh, data):
    """The selection of a region: a tag by its number, or a name of field data (Gmsh) or of a cell set."""
    tags = [name for wanted in _TAGS for name in data if name.lower() == wanted and data[name].dtype.kind in "iub"]
    if isinstance(key, str) and key in mesh.field_data and "gmsh:physical" in data:
        return {"region": int(np.ravel(mesh.field_data[key])[0]), "data": "gmsh:physical"}
    if isinstance(key, str) and key in mesh.cell_sets and key in data:
        return {"region": 1, "data": key}
    if isinstance(key, (int, np.integer)) and tags and np.any(data[tags[0]] == key):
        return {"region": int(key), "data": tags[0]}
    known = sorted({*mesh.field_data, *(n for n in mesh.cell_sets if n in data)})
    numbers = sorted(set(data[tags[0]].tolist())) if tags else []
    raise input_error(f"the mesh has no region {key!r}; it has the names {known} and the tags {numbers}")


def _material(material, data, volume):
    young = material.get("young")
    if isinstance(young, dict) and young.get("field") not in (data if volume else ()):
        raise input_error(f"the mesh has no cell data {young.get('field')!r} for the modulus; it has {sorted(data)}")
    return dict(material)


def from_meshio(mesh, file, *, name=None, material=MATERIAL, regions=None, scale=1.0, nodes=2000, gravity=(0, -9.81, 0), hold_bottom=False):
    """A scene with one body from a mesh: a dict for pliant.World or save_scene. The mesh goes to `file`, which the scene names.

    mesh: a meshio.Mesh, or a file that meshio reads. file: a .vtu for tetrahedra or hexahedra, an .obj for a surface, which is filled with a lattice
    of about `nodes` nodes. scale: metres per unit of the mesh. material: of the body; `"young": {"field": NAME}` takes cell data of the mesh.
    regions: by tag (a number) or name (a physical group of Gmsh, a cell set) the material of that part. hold_bottom: holds the lowest twentieth against
    gravity. Triangles beside tetrahedra stay in the file, so that fixed, prescribed and pressures can name them by `region`.
    """
    source = _read(mesh)
    file = Path(file)
    points = np.zeros((len(source.points), 3))
    points[:, :source.points.shape[1]] = np.asarray(source.points, np.float64) * scale
    blocks = _blocks(source)
    kinds = {kind for _, kind, _ in blocks}
    solid = kinds & {"tetra", "hexahedron"}
    if not kinds:
        raise input_error("the mesh has no tetrahedra, hexahedra, triangles or quadrangles")
    if len(solid) > 1:
        raise input_error("a body is made of tetrahedra or of hexahedra; the mesh has both")
    wanted = ".vtu" if solid else ".obj"
    if file.suffix.lower() != wanted:
        raise input_error(f"{file}: a mesh of {' and '.join(sorted(solid or kinds))} is written as {wanted}")
    data = _cell_data(source, blocks)
    body = {"name": name or file.stem, "material": _material(material, data, solid)}
    if solid:
        write_vtu(file, points, [(kind, corners) for _, kind, corners in blocks], data)
        body |= {"mesh": str(file.resolve()), "element": "tet4anp" if "tetra" in solid else "hex8"}
        parts = [{**_region(key, source, data), "material": _material(of, data, True)} for key, of in (regions or {}).items()]
        body |= {"inclusions": parts} if parts else {}
    else:
        if regions:
            raise input_error("regions are parts of a volume mesh; a surface is filled with one material (or with `inclusions` of the scene)")
        write_obj(file, points, [face for _, _, corners in blocks for face in corners.tolist()])
        body |= {"surface": str(file.resolve()), "lattice": {"nodes": int(nodes)}}
    if hold_bottom:
        used = np.unique(np.concatenate([corners.ravel() for _, _, corners in blocks]))
        body["fixed"] = stands_on_its_foot(points[used], int(np.argmax(np.abs(gravity))))
    return scene_of(body["name"], [body], [float(g) for g in gravity])
