#include "mesh_io/read_volume_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pliant::volume_file {
namespace {

using enum CellKind;
using Row = std::pair<int, CellType>;

// Gmsh reference manual, "MSH file format", element types.
constexpr Row kGmsh[] = {
    {1, {"lines", flat, 2}},
    {2, {"triangles", triangle, 3}},
    {3, {"quadrangles", quad, 4}},
    {4, {"tetrahedra", tet, 4}},
    {5, {"hexahedra", hex, 8}},
    {6, {"prisms", unsupported, 6}},
    {7, {"pyramids", unsupported, 5}},
    {8, {"lines", flat, 3}},
    {9, {"triangles", triangle, 6}},
    {10, {"quadrangles", quad, 9}},
    {11, {"tetrahedra", tet, 10}},
    {12, {"hexahedra", hex, 27}},
    {13, {"prisms", unsupported, 18}},
    {14, {"pyramids", unsupported, 14}},
    {15, {"points", flat, 1}},
    {16, {"quadrangles", quad, 8}},
    {17, {"hexahedra", hex, 20}},
    {18, {"prisms", unsupported, 15}},
    {19, {"pyramids", unsupported, 13}},
    {20, {"triangles", triangle, 9}},
    {21, {"triangles", triangle, 10}},
    {22, {"triangles", triangle, 12}},
    {23, {"triangles", triangle, 15}},
    {24, {"triangles", triangle, 15}},
    {25, {"triangles", triangle, 21}},
    {26, {"lines", flat, 4}},
    {27, {"lines", flat, 5}},
    {28, {"lines", flat, 6}},
    {29, {"tetrahedra", tet, 20}},
    {30, {"tetrahedra", tet, 35}},
    {31, {"tetrahedra", tet, 56}},
    {36, {"quadrangles", quad, 16}},
    {92, {"hexahedra", hex, 64}},
    {93, {"hexahedra", hex, 125}},
};

// VTK user's guide, "VTK file formats", linear and nonlinear cell types.
constexpr Row kVtk[] = {
    {1, {"vertices", flat, 1}},
    {2, {"vertices", flat, 0}},
    {3, {"lines", flat, 2}},
    {4, {"lines", flat, 0}},
    {5, {"triangles", triangle, 3}},
    {6, {"triangle strips", flat, 0}},
    {7, {"polygons", flat, 0}},
    {8, {"pixels", pixel, 4}},
    {9, {"quads", quad, 4}},
    {10, {"tetrahedra", tet, 4}},
    {11, {"voxels", voxel, 8}},
    {12, {"hexahedra", hex, 8}},
    {13, {"wedges", unsupported, 6}},
    {14, {"pyramids", unsupported, 5}},
    {15, {"pentagonal prisms", unsupported, 10}},
    {16, {"hexagonal prisms", unsupported, 12}},
    {21, {"lines", flat, 3}},
    {22, {"triangles", triangle, 6}},
    {23, {"quads", quad, 8}},
    {24, {"tetrahedra", tet, 10}},
    {25, {"hexahedra", hex, 20}},
    {26, {"wedges", unsupported, 15}},
    {27, {"pyramids", unsupported, 13}},
    {28, {"quads", quad, 9}},
    {29, {"hexahedra", hex, 27}},
    {30, {"quads", quad, 6}},
    {31, {"wedges", unsupported, 12}},
    {32, {"wedges", unsupported, 18}},
    {33, {"hexahedra", hex, 24}},
    {34, {"triangles", triangle, 7}},
    {35, {"lines", flat, 4}},
    {36, {"polygons", flat, 0}},
    {37, {"pyramids", unsupported, 19}},
    {42, {"polyhedra", unsupported, 0}},
    {68, {"lines", flat, 0}},
    {69, {"triangles", flat, 0}},
    {70, {"quads", flat, 0}},
    {71, {"tetrahedra", tet, 0}},
    {72, {"hexahedra", hex, 0}},
    {73, {"wedges", unsupported, 0}},
    {74, {"pyramids", unsupported, 0}},
    {75, {"lines", flat, 0}},
    {76, {"triangles", flat, 0}},
    {77, {"quads", flat, 0}},
    {78, {"tetrahedra", tet, 0}},
    {79, {"hexahedra", hex, 0}},
    {80, {"wedges", unsupported, 0}},
    {81, {"pyramids", unsupported, 0}},
};

const CellType* find(std::span<const Row> table, std::int64_t type) {
  const auto it = std::find_if(table.begin(), table.end(), [type](const Row& row) { return row.first == type; });
  return it == table.end() ? nullptr : &it->second;
}

template <std::size_t N>
std::array<std::int32_t, N> corners(std::span<const std::int32_t> nodes, const char* name, std::int64_t number,
                                    const Cursor& at) {
  if (nodes.size() < N)
    at.fail(fmt::format("element {} of the {} has {} nodes, at least {} are needed", number, name, nodes.size(), N));
  std::array<std::int32_t, N> out;
  std::copy_n(nodes.begin(), N, out.begin());
  return out;
}

}  // namespace

const CellType* gmsh_cell(std::int64_t type) { return find(kGmsh, type); }
const CellType* vtk_cell(std::int64_t type) { return find(kVtk, type); }

namespace {

/// The entry of this name, new if there is none.
template <class List>
auto& named(List& list, const std::string& name) {
  const auto it = std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.name == name; });
  if (it != list.end()) return *it;
  list.push_back({name, {}, {}});
  return list.back();
}

}  // namespace

RawMesh::Array& array_named(RawMesh& mesh, const std::string& name) { return named(mesh.arrays, name); }

namespace {

/// As tags, which are whole.
void add_tags(RawMesh& mesh, const std::string& name, std::int64_t first_cell, std::span<const std::int64_t> values) {
  RawMesh::Array& array = array_named(mesh, name);
  for (std::size_t i = 0; i < values.size(); ++i) array.cell.push_back(first_cell + static_cast<std::int64_t>(i));
  array.value.insert(array.value.end(), values.begin(), values.end());
}

/// As values of a field.
template <class T>
void add_values(RawMesh& mesh, const std::string& name, std::int64_t first_cell, std::span<const T> values) {
  RawMesh::Values& array = named(mesh.values, name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    array.cell.push_back(first_cell + static_cast<std::int64_t>(i));
    array.value.push_back(static_cast<double>(values[i]));
  }
}

}  // namespace

void add_cell_values(RawMesh& mesh, const std::string& name, std::int64_t first_cell, std::span<const std::int64_t> values) {
  add_tags(mesh, name, first_cell, values);
  add_values(mesh, name, first_cell, values);
}

void add_cell_values(RawMesh& mesh, const std::string& name, std::int64_t first_cell, std::span<const double> values) {
  add_values(mesh, name, first_cell, values);
  constexpr double most = 9007199254740992.0;  // 2^53: larger ones have lost their units
  std::vector<std::int64_t> whole;
  for (const double v : values) {
    if (!(std::fabs(v) <= most) || v != std::floor(v)) return;
    whole.push_back(static_cast<std::int64_t>(v));
  }
  add_tags(mesh, name, first_cell, whole);
}

void add_cell(RawMesh& mesh, const CellType& type, std::int64_t number, std::span<const std::int32_t> nodes, const Cursor& at) {
  const std::int64_t cell = mesh.cells++;
  switch (type.kind) {
    case triangle:
    case quad:
    case pixel:
      if (mesh.tagged) {
        std::array<std::int32_t, 4> c{nodes[0], nodes[1], nodes[2], -1};
        if (type.kind != triangle) c[3] = nodes[3];
        if (type.kind == pixel) std::swap(c[2], c[3]);
        mesh.faces.push_back(c);
        mesh.face_cell.push_back(cell);
      }
      [[fallthrough]];
    case flat:
      ++mesh.others[type.name];
      return;
    case tet:
      mesh.tets.push_back(corners<4>(nodes, type.name, number, at));
      mesh.tet_numbers.push_back(number);
      if (mesh.tagged) mesh.tet_cell.push_back(cell);
      return;
    case hex:
    case voxel: {
      auto c = corners<8>(nodes, type.name, number, at);
      if (type.kind == voxel) {
        std::swap(c[2], c[3]);
        std::swap(c[6], c[7]);
      }
      mesh.hexes.push_back(c);
      mesh.hex_numbers.push_back(number);
      if (mesh.tagged) mesh.hex_cell.push_back(cell);
      return;
    }
    case unsupported:
      at.fail(fmt::format("element {} is one of the {}, which cannot be used; allowed are tetrahedra and hexahedra", number,
                          type.name));
  }
}

void add_point(RawMesh& mesh, NodeNumbers& numbers, std::int64_t number, const Vec3d& x, const Cursor& at) {
  if (mesh.points.size() >= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    at.fail("more than 2147483647 nodes");
  if (!numbers.add(number)) at.fail(fmt::format("node {} appears twice", number));
  mesh.points.push_back(x);
  mesh.point_numbers.push_back(number);
}

std::int32_t node_of(const NodeNumbers& numbers, std::int64_t number, std::int64_t element, const Cursor& at) {
  const std::int32_t index = numbers.find(number);
  if (index < 0) at.fail(fmt::format("element {} names node {}, which the file does not define", element, number));
  return index;
}

}  // namespace pliant::volume_file
