// The topology of a cut body by the virtual node algorithm (Molino, Bao and Fedkiw 2004).
//
// What is cut are edges between nodes of the uncut body, each at one point. A cell is *completely cut* when the graph of its
// corners through its uncut edges falls apart; it is then replaced by one copy per component. In a copy the corners of its
// component are real, the others virtual. Real corners at one node are one node. Copies on both sides of a face share the nodes
// of that face when one of its corners is real in both. Everything here is a function of the set of cut edges alone: edits may
// come in any order or grouping.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "cutting/cut_cell.h"

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

/// What became of a cell whose edges are cut.
struct CellCut {
  std::array<std::int8_t, 8> label{};  ///< component of each corner; components are numbered by their lowest corner
  int components = 1;                  ///< 1: not completely cut yet, the cell is whole
  std::int32_t first_copy = -1;        ///< element of component 1; component 0 keeps the cell's own number, the rest follow
};

/// Elements 0 .. cells - 1 are the cells, those cut completely being the copies of their component 0; the other copies follow,
/// ascending by cell and component. Nodes 0 .. nodes - 1 are those of the uncut body: where a node is real in some element that
/// is the real node. Virtual nodes follow.
struct CutElements {
  std::vector<std::array<std::int32_t, 8>> nodes;  ///< [elements] corners as in CutMesh::cells
  std::vector<std::int32_t> cell;                  ///< [elements] of the uncut body
  std::vector<std::uint8_t> real;                  ///< [elements] bit a: corner a is real
  std::vector<double> fill;                        ///< [elements] of a whole cell's volume; copies of a cell add up to its fill
  std::vector<std::int32_t> origin;  ///< [nodes] node of the uncut body at the same place; of the first ones themselves
};

class CutTopology {
 public:
  explicit CutTopology(std::shared_ptr<const CutMesh> mesh);

  [[nodiscard]] const CutMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const CutEdges& edges() const { return edges_; }
  [[nodiscard]] const CutElements& elements() const { return elements_; }
  /// Cells with a cut edge, ascending. Those with components > 1 have copies.
  [[nodiscard]] const std::map<std::int32_t, CellCut>& cells() const { return cells_; }
  /// The element that holds component `label` of a cell.
  [[nodiscard]] std::int32_t element_of(std::int32_t cell, int label) const;
  /// Cells with a face in common with `cell` across its local face, -1 ended (nearly always one or none).
  [[nodiscard]] std::vector<std::int32_t> cells_at_face(std::int32_t cell, int face) const;

  /// The division of tetrahedron `tet` (of mesh().shape) of a cell. Points that cells share have the same bits in each.
  [[nodiscard]] CutTet tet(std::int32_t cell, int tet) const;
  /// Component that holds a point of the cell at rest [m]: that of the flag's tetrahedron it lies in.
  [[nodiscard]] int label_at(std::int32_t cell, const Vec3d& x) const;

  /// Cut further edges; those that are cut already stay as they are. Returns the cells whose `CellCut` changed, ascending. Only
  /// they and their neighbours are looked at.
  std::vector<std::int32_t> cut(const CutEdges& edges);

  /// Pieces: the number of connected sets of elements, and of which each element is one.
  [[nodiscard]] std::int32_t pieces(std::vector<std::int32_t>* piece_of = nullptr) const;

 private:
  std::shared_ptr<const CutMesh> mesh_;
  CutEdges edges_;
  std::map<std::int32_t, CellCut> cells_;
  CutElements elements_;
};

}  // namespace pliant
