// The cells of an uncut body at its nodes, edges and faces.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cutting/topology/cut_mesh.h"

namespace pliant {

class CellNeighbors {
 public:
  /// Throws Error if an index is out of range. The mesh must outlive it.
  explicit CellNeighbors(const CutMesh& mesh);

  /// Cells that have a node, ascending.
  [[nodiscard]] std::span<const std::int32_t> at_node(std::int32_t node) const {
    return {node_cells_.data() + node_offset_[node], node_cells_.data() + node_offset_[node + 1]};
  }
  /// Cells that share all nodes of a cell's local face; nearly always one or none.
  [[nodiscard]] std::span<const std::int32_t> at_face(std::int32_t cell, int face) const {
    const std::size_t at = static_cast<std::size_t>(cell) * mesh_.shape->faces.size() + static_cast<std::size_t>(face);
    return {face_cells_.data() + face_offset_[at], face_cells_.data() + face_offset_[at + 1]};
  }
  /// Cells that have an edge, ascending.
  [[nodiscard]] std::vector<std::int32_t> at_edge(const NodePair& edge) const;
  /// Number in the shape of the edge between two nodes of a cell, -1 if it has none.
  [[nodiscard]] int edge_of(std::int32_t cell, std::int32_t a, std::int32_t b) const;

 private:
  void find_at_nodes();
  void find_at_faces();

  const CutMesh& mesh_;
  std::vector<std::int32_t> node_offset_, node_cells_;  ///< cells at each node
  std::vector<std::int32_t> face_offset_, face_cells_;  ///< cells across each face of each cell
};

}  // namespace pliant
