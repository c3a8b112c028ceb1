// The topology of a cut body by the virtual node algorithm (Molino, Bao and Fedkiw 2004).
//
// Edges between nodes of the uncut body are cut, each at one point. A cell is *completely cut* if the graph of its corners
// and uncut edges is disconnected; it is then replaced by one copy per component. In a copy the corners of its component are
// real, the others virtual. Real corners at one node are one node. Copies on both sides of a face share the nodes of that
// face if one of its corners is real in both. The copies depend only on the set of cut edges: edits may come in any order or
// grouping. Where their parts lie does not: a cut stays where it was made (cut_cell.h).
//
// CutTopology holds the cut edges and cells and numbers the elements. CellNeighbors finds the cells at a node, an edge or a
// face; CutDivision computes where the components of a cell lie and how they share its material; CutNodes numbers the nodes.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "cutting/topology/cell_neighbors.h"
#include "cutting/topology/cut_division.h"
#include "cutting/topology/cut_mesh.h"
#include "cutting/topology/cut_nodes.h"

namespace pliant {

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
  [[nodiscard]] std::span<const std::int32_t> cells_at_face(std::int32_t cell, int face) const {
    return neighbors_.at_face(cell, face);
  }
  [[nodiscard]] std::vector<std::int32_t> cells_at_edge(const NodePair& edge) const { return neighbors_.at_edge(edge); }

  /// As in CutDivision, for a cell as it is cut now.
  [[nodiscard]] CutTet tet(std::int32_t cell, int tet) const { return division_.tet(cell, cell_at_[cell], tet); }
  [[nodiscard]] int label_at(std::int32_t cell, const Vec3d& x) const { return division_.label_at(cell, cell_at_[cell], x); }
  [[nodiscard]] int label_in(std::int32_t cell, int tet, const std::array<double, 4>& weight) const {
    return division_.label_in(cell, cell_at_[cell], tet, weight);
  }
  /// For many places in one tetrahedron.
  [[nodiscard]] TetDivision division(std::int32_t cell, int tet) const {
    return cell_at_[cell] == nullptr ? divide({}, {}, {}) : division_.of(cell, *cell_at_[cell], tet);
  }
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
  using OldCuts = std::map<std::int32_t, CellCut>;  ///< changed cells before the edit

  void check(const CutEdges& edges) const;
  OldCuts mark(const CutEdges& edges, CutEdit& edit);
  void number_elements(const OldCuts& old, CutEdit& edit);

  std::shared_ptr<const CutMesh> mesh_;
  CellNeighbors neighbors_;
  CutEdges edges_;
  std::int32_t edit_ = 0;  ///< the last one
  std::map<std::int32_t, CellCut> cells_;
  std::vector<const CellCut*> cell_at_;  ///< [cells] into cells_, nullptr: no edge is cut
  CutDivision division_;
  CutNodes nodes_;
  CutElements elements_;
};

}  // namespace pliant
