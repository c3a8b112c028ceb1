// The topology of a cut body by the virtual node algorithm (Molino, Bao and Fedkiw 2004).
//
// Edges between nodes of the uncut body are cut, each at one point. A cell is *completely cut* if the graph of its corners
// and uncut edges is disconnected; it is then replaced by one copy per component. In a copy the corners of its component are
// real, the others virtual. Real corners at one node are one node. Copies on both sides of a face share the nodes of that
// face if one of its corners is real in both. The result depends only on the set of cut edges: edits may come in any order or
// grouping.
// come in any order or grouping.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
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
  std::uint32_t cut = 0;               ///< bit i: edge i of the shape is cut
  std::array<std::int8_t, 8> label{};  ///< component of each corner; components are numbered by their lowest corner
  int components = 1;                  ///< 1: not completely cut yet, the cell is whole
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

class CutTopology {
 public:
  /// Throws Error if an index is out of range.
  explicit CutTopology(std::shared_ptr<const CutMesh> mesh);
  CutTopology(const CutTopology&) = delete;
  CutTopology& operator=(const CutTopology&) = delete;

  [[nodiscard]] const CutMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const CutEdges& edges() const { return edges_; }
  [[nodiscard]] const CutElements& elements() const { return elements_; }
  /// Cells with a cut edge. Those with components > 1 have copies.
  [[nodiscard]] const std::map<std::int32_t, CellCut>& cells() const { return cells_; }
  /// Whether a cell has copies.
  [[nodiscard]] bool divided(std::int32_t cell) const { return cell_at_[cell] != nullptr && cell_at_[cell]->components > 1; }
  /// Number of cells that are cut in part: the ends of one of their cut edges still hold together in the cell, at the tip of a
  /// cut or where a blade ended inside the cell. 0 when everything that was cut has come apart.
  [[nodiscard]] std::int64_t cut_in_part() const;
  /// Of these cells.
  [[nodiscard]] std::int64_t cut_in_part(std::span<const std::int32_t> cells) const;
  /// The element that holds component `label` of a cell, -1 if it has none.
  [[nodiscard]] std::int32_t element_of(std::int32_t cell, int label) const;
  /// Cells that share all nodes of a cell's local face; nearly always one or none.
  [[nodiscard]] std::span<const std::int32_t> cells_at_face(std::int32_t cell, int face) const;

  /// Cells that have an edge.
  [[nodiscard]] std::vector<std::int32_t> cells_at_edge(const NodePair& edge) const;

  /// Returns the division of tetrahedron `tet` (of mesh().shape) of a cell. Points shared by cells have identical bits in
  /// each.
  [[nodiscard]] CutTet tet(std::int32_t cell, int tet) const;
  /// Component that holds a point of the cell at rest [m]: that of the flag's tetrahedron it lies in, or the nearest one.
  [[nodiscard]] int label_at(std::int32_t cell, const Vec3d& x) const;
  /// The same by barycentric coordinates in one of its tetrahedra.
  [[nodiscard]] int label_in(std::int32_t cell, int tet, const std::array<double, 4>& weight) const;
  /// For many places in one tetrahedron. The cell is divided.
  [[nodiscard]] TetDivision division(std::int32_t cell, int tet) const { return division(cell, *cell_at_[cell], tet); }
  [[nodiscard]] int label_in(std::int32_t cell, int tet, const TetDivision& division,
                             const std::array<double, 4>& weight) const {
    return cell_at_[cell]->label[mesh_->shape->tets[tet][corner_at(division, weight)]];
  }

  /// Cuts further edges; those already cut do not change. Throws Error, with nothing changed, for a pair that is not an edge
  /// of a cell or a crossing that is not in (0, 1). Cost: the cells at new edges, plus a pass over all copies. `divided` (may
  /// be empty) is called with CutEdit::cells as soon as their division is known, unless there are none; code that does not
  /// need elements and their nodes may read the cells from then on, concurrently with the rest of this call.
  CutEdit cut(const CutEdges& edges, const std::function<void(const std::vector<std::int32_t>& cells)>& divided = {});
  /// Returns to a smaller set of cut edges (after an edit that failed elsewhere).
  void reset(const CutEdges& edges);

  /// Pieces: the number of sets of elements that share nodes, numbered by their lowest element, and the piece of each element.
  [[nodiscard]] std::int32_t pieces(std::vector<std::int32_t>* piece_of = nullptr) const;

 private:
  /// The nodes at one node of the uncut body: its copies of cells, grouped.
  struct Member {
    std::int32_t cell;
    std::int8_t component, corner;
  };
  struct NodeClass {
    std::int32_t node = -1;  ///< as of the last numbering
    bool real = false;
    std::vector<Member> members;
  };
  using OldCuts = std::map<std::int32_t, CellCut>;  ///< changed cells before the edit

  void find_neighbors();
  [[nodiscard]] int edge_of(std::int32_t cell, std::int32_t a, std::int32_t b) const;
  [[nodiscard]] std::span<const std::int32_t> cells_at_node(std::int32_t node) const;
  [[nodiscard]] const CellCut* find_cell(std::int32_t cell) const;
  [[nodiscard]] double crossing(std::int32_t a, std::int32_t b) const;
  OldCuts mark(const CutEdges& edges, CutEdit& edit);
  void label(CellCut& cell) const;
  [[nodiscard]] TetDivision division(std::int32_t cell, const CellCut& cut, int tet) const;
  void share(std::int32_t cell, CellCut& cut) const;
  /// The parts of a divided component keep its material fraction, whatever crossings were found since: copies are deformed
  /// differently, so moving material between them would lose or gain energy and momentum.
  void inherit(const CellCut& before, CellCut& cut) const;
  void number_elements(const OldCuts& old, CutEdit& edit);
  [[nodiscard]] std::vector<NodeClass> classes_at(std::int32_t node) const;
  void number_nodes(const OldCuts& old, const std::vector<std::array<std::int32_t, 8>>& old_nodes, CutEdit& edit);

  std::shared_ptr<const CutMesh> mesh_;
  std::vector<std::int32_t> node_offset_, node_cells_;  ///< cells at each node
  std::vector<std::int32_t> face_offset_, face_cells_;  ///< cells across each face of each cell
  CutEdges edges_;
  std::map<std::int32_t, CellCut> cells_;
  std::vector<const CellCut*> cell_at_;                     ///< [cells] into cells_, nullptr: no edge is cut
  std::map<std::int32_t, std::vector<NodeClass>> classes_;  ///< at nodes of cells with copies
  CutElements elements_;
};

}  // namespace pliant
