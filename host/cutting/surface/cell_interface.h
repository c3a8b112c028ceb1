// The cut surface inside one completely cut lattice cell: triangles between its components. A tetrahedron of the cell with two
// components gives one triangle (one corner apart) or two (two and two), one with more components or with a face whose three
// edges are cut is divided at points on its edges, in such faces, and at a centre.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "cutting/surface/surface_source.h"

namespace pliant::overlay {

/// The edges of a lattice cell's Kuhn tetrahedra: from a corner to one that has all its bits.
inline constexpr std::array<std::array<int, 2>, 19> kKuhnEdges{{{0, 1},
                                                                {0, 2},
                                                                {0, 3},
                                                                {0, 4},
                                                                {0, 5},
                                                                {0, 6},
                                                                {0, 7},
                                                                {1, 3},
                                                                {1, 5},
                                                                {1, 7},
                                                                {2, 3},
                                                                {2, 6},
                                                                {2, 7},
                                                                {3, 7},
                                                                {4, 5},
                                                                {4, 6},
                                                                {4, 7},
                                                                {5, 7},
                                                                {6, 7}}};
/// Number in kKuhnEdges, -1 for two corners that no edge joins.
int kuhn_edge(int a, int b);

/// The tetrahedra of a cell: their corners, one for each order of the axes in which a path leads from corner 0 to corner 7.
inline constexpr std::array<std::array<int, 4>, 6> kPaths{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};
/// The one that has these corners.
std::size_t path_of(std::array<int, 4> corners);

/// What carries a component: a component of a lattice cell.
struct Carrier {
  std::int32_t cell = -1;
  std::int32_t label = 0;
  friend bool operator==(const Carrier&, const Carrier&) = default;
};

/// A completely cut cell of the grid.
struct CutGridCell {
  GridIndex index{};
  bool air = false;                     ///< a cell that the lattice does not have, cut like its neighbours
  std::array<std::int8_t, 8> label{};   ///< component of each corner
  std::array<double, 19> crossing{};    ///< share of the way along each edge of kKuhnEdges; negative: not cut
  std::array<std::int32_t, 19> when{};  ///< number of the edit in which it was cut
  std::array<std::uint32_t, 6>
      centre{};                      ///< of each of its tetrahedra, edges whose points' mean it is; 0: all between components
  std::array<Carrier, 8> carrier{};  ///< of each component
  friend bool operator==(const CutGridCell&, const CutGridCell&) = default;
};

/// Corner positions of a cell's grid point plus one of its 8 corners.
inline GridIndex corner_index(const GridIndex& cell, int corner) {
  return {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
}

struct InterfacePoint {
  std::int64_t id = 0;  ///< the same in all cells that share the point
  Vec3d x{};            ///< [m]
};

struct InterfaceFace {
  std::array<std::int8_t, 3> point{};  ///< into CellInterface::points; seen counter-clockwise from the front
  std::int8_t back = 0, front = 0;     ///< components
  std::int8_t tet = 0;
};

struct CellInterface {
  std::vector<InterfacePoint> points;
  std::vector<InterfaceFace> faces;
};

CellInterface interface_of(const CutGrid& grid, const CutGridCell& cell);

/// The component that holds a point of the cell, -1 if the point lies outside the cell.
int component_at(const SurfaceSource& source, const CutGridCell& cell, const CellInterface& faces, const ExactPoint& p);

}  // namespace pliant::overlay
