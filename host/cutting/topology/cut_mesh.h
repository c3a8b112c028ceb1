// The data of a cut body: the uncut mesh, its cut edges, the state of its cut cells, and the elements that replace them.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "cutting/topology/cut_cell.h"

namespace pliant {

/// The uncut body.
struct CutMesh {
  const CellShape* shape = nullptr;
  std::vector<Vec3d> rest;                         ///< [nodes] [m]
  std::vector<std::array<std::int32_t, 8>> cells;  ///< lattice corners in bit order; a tetrahedron uses the first four
  std::vector<double> fill;                        ///< [cells]
  /// [cells] which of the 4 x 4 x 4 samples of a lattice cell lie in material (lattice_cell.h); empty: all of every cell.
  std::vector<std::uint64_t> material;
};

/// Two nodes of the uncut body, the lower one first.
using NodePair = std::array<std::int32_t, 2>;
inline NodePair node_pair(std::int32_t a, std::int32_t b) { return a < b ? NodePair{a, b} : NodePair{b, a}; }

/// Cut edges and where they are cut: the share of the way from the lower to the higher node, in [kLeastCrossing, 1 -
/// kLeastCrossing].
using CutEdges = std::map<NodePair, double>;

/// The state of a cell with cut edges.
struct CellCut {
  std::uint32_t cut = 0;                 ///< bit i: edge i of the shape is cut
  std::array<std::int8_t, 8> label{};    ///< component of each corner; components are numbered by their lowest corner
  int components = 1;                    ///< 1: not completely cut yet, the cell is whole
  std::array<std::int32_t, 19> when{};   ///< number of the edit in which an edge of the shape was cut
  std::array<std::uint8_t, 6> centre{};  ///< DivisionPoints::centre of each tetrahedron of the shape
  /// The copy of each component; -1: the component has no material and no copy. One copy keeps the cell's own number.
  std::array<std::int32_t, 8> element{-1, -1, -1, -1, -1, -1, -1, -1};
  /// Fraction of the cell's material, 0 without a copy. If a component is divided later, the parts add up to its fraction.
  std::array<double, 8> share{};
};

/// Elements 0 .. cells - 1 are the cells, those cut completely being the copies of their first component with material; the
/// other copies follow, ascending by cell and component. Nodes 0 .. nodes - 1 are those of the uncut body, and real if any node
/// there is; further virtual nodes follow, ascending by origin.
struct CutElements {
  std::vector<std::array<std::int32_t, 8>> nodes;  ///< [elements] corners as in CutMesh::cells
  std::vector<std::int32_t> cell;                  ///< [elements] of the uncut body
  std::vector<std::uint8_t> real;                  ///< [elements] bit a: corner a is real
  std::vector<double> fill;                        ///< [elements] of a whole cell's volume; copies of a cell add up to its fill
  std::vector<std::int32_t> origin;  ///< [nodes] node of the uncut body at the same place; of the first ones themselves
};

/// The result of an edit. An edit that changed no element has empty lists.
struct CutEdit {
  std::vector<std::int32_t> cells;         ///< cells whose CellCut changed, ascending
  std::vector<std::int32_t> node_from;     ///< [nodes now] the node before
  std::vector<std::int32_t> element_from;  ///< [elements now] the element before
  [[nodiscard]] bool changed_elements() const { return !node_from.empty(); }
};

/// The components of the corners of a cell with cut edges: those that uncut edges join.
void label_components(const CellShape& shape, CellCut& cell);

}  // namespace pliant
