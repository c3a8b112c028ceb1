// The nodes of a cut body's elements: which corners of the copies of cells are one node, and their numbers.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "cutting/topology/cell_neighbors.h"
#include "cutting/topology/cut_mesh.h"

namespace pliant {

class CutNodes {
 public:
  /// `cells`: the state of each cell, nullptr: no edge is cut. All must outlive it.
  CutNodes(const CutMesh& mesh, const CellNeighbors& neighbors, const std::vector<const CellCut*>& cells)
      : mesh_(mesh), neighbors_(neighbors), cells_(cells) {}

  /// Groups the corners of the copies again at the nodes of the cells that the edit changed, then numbers all nodes.
  /// `old_copies`: corners, before the edit, of the elements that follow those of the uncut body.
  void number(const std::vector<std::array<std::int32_t, 8>>& old_copies, CutElements& elements, CutEdit& edit);
  /// Forgets all copies.
  void clear() { classes_.clear(); }

 private:
  struct Member {
    std::int32_t cell;
    std::int8_t component, corner;
  };
  /// The corners of copies that are one node.
  struct NodeClass {
    std::int32_t node = -1;  ///< as of the last numbering
    bool real = false;
    std::vector<Member> members;
  };
  class Grouping;

  [[nodiscard]] const CellCut& cut_of(std::int32_t cell) const;
  [[nodiscard]] std::int32_t element_of(std::int32_t cell, int label) const {
    return cells_[cell] == nullptr ? cell : cells_[cell]->element[label];
  }
  void number_classes(CutElements& elements, CutEdit& edit);

  const CutMesh& mesh_;
  const CellNeighbors& neighbors_;
  const std::vector<const CellCut*>& cells_;
  std::map<std::int32_t, std::vector<NodeClass>> classes_;  ///< at nodes of cells with copies
};

}  // namespace pliant
