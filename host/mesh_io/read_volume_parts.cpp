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
    {2, {"triangles", flat, 3}},
    {3, {"quadrangles", flat, 4}},
    {4, {"tetrahedra", tet, 4}},
    {5, {"hexahedra", hex, 8}},
    {6, {"prisms", unsupported, 6}},
    {7, {"pyramids", unsupported, 5}},
    {8, {"lines", flat, 3}},
    {9, {"triangles", flat, 6}},
    {10, {"quadrangles", flat, 9}},
    {11, {"tetrahedra", tet, 10}},
    {12, {"hexahedra", hex, 27}},
    {13, {"prisms", unsupported, 18}},
    {14, {"pyramids", unsupported, 14}},
    {15, {"points", flat, 1}},
    {16, {"quadrangles", flat, 8}},
    {17, {"hexahedra", hex, 20}},
    {18, {"prisms", unsupported, 15}},
    {19, {"pyramids", unsupported, 13}},
    {20, {"triangles", flat, 9}},
    {21, {"triangles", flat, 10}},
    {22, {"triangles", flat, 12}},
    {23, {"triangles", flat, 15}},
    {24, {"triangles", flat, 15}},
    {25, {"triangles", flat, 21}},
    {26, {"lines", flat, 4}},
    {27, {"lines", flat, 5}},
    {28, {"lines", flat, 6}},
    {29, {"tetrahedra", tet, 20}},
    {30, {"tetrahedra", tet, 35}},
    {31, {"tetrahedra", tet, 56}},
    {36, {"quadrangles", flat, 16}},
    {92, {"hexahedra", hex, 64}},
    {93, {"hexahedra", hex, 125}},
};

// VTK user's guide, "VTK file formats", linear and nonlinear cell types.
constexpr Row kVtk[] = {
    {1, {"vertices", flat, 1}},
    {2, {"vertices", flat, 0}},
    {3, {"lines", flat, 2}},
    {4, {"lines", flat, 0}},
    {5, {"triangles", flat, 3}},
    {6, {"triangle strips", flat, 0}},
    {7, {"polygons", flat, 0}},
    {8, {"pixels", flat, 4}},
    {9, {"quads", flat, 4}},
    {10, {"tetrahedra", tet, 4}},
    {11, {"voxels", voxel, 8}},
    {12, {"hexahedra", hex, 8}},
    {13, {"wedges", unsupported, 6}},
    {14, {"pyramids", unsupported, 5}},
    {15, {"pentagonal prisms", unsupported, 10}},
    {16, {"hexagonal prisms", unsupported, 12}},
    {21, {"lines", flat, 3}},
    {22, {"triangles", flat, 6}},
    {23, {"quads", flat, 8}},
    {24, {"tetrahedra", tet, 10}},
    {25, {"hexahedra", hex, 20}},
    {26, {"wedges", unsupported, 15}},
    {27, {"pyramids", unsupported, 13}},
    {28, {"quads", flat, 9}},
    {29, {"hexahedra", hex, 27}},
    {30, {"quads", flat, 6}},
    {31, {"wedges", unsupported, 12}},
    {32, {"wedges", unsupported, 18}},
    {33, {"hexahedra", hex, 24}},
    {34, {"triangles", flat, 7}},
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

void add_cell(RawMesh& mesh, const CellType& type, std::int64_t number, std::span<const std::int32_t> nodes, const Cursor& at) {
  switch (type.kind) {
    case flat:
      ++mesh.others[type.name];
      return;
    case tet:
      mesh.tets.push_back(corners<4>(nodes, type.name, number, at));
      mesh.tet_numbers.push_back(number);
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
