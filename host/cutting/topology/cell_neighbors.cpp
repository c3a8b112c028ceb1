#include "cutting/topology/cell_neighbors.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "pliant/error.h"

namespace pliant {

CellNeighbors::CellNeighbors(const CutMesh& mesh) : mesh_(mesh) {
  find_at_nodes();
  find_at_faces();
}

void CellNeighbors::find_at_nodes() {
  const auto nodes = static_cast<std::int32_t>(mesh_.rest.size());
  const int corners = mesh_.shape->corners;
  node_offset_.assign(mesh_.rest.size() + 1, 0);
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    for (int a = 0; a < corners; ++a) {
      const std::int32_t n = mesh_.cells[c][a];
      if (n < 0 || n >= nodes) {
        throw Error(ErrorCode::internal, fmt::format("cell {} of a body to cut names node {} of {}", c, n, nodes));
      }
      ++node_offset_[n + 1];
    }
  }
  std::partial_sum(node_offset_.begin(), node_offset_.end(), node_offset_.begin());
  node_cells_.resize(mesh_.cells.size() * static_cast<std::size_t>(corners));
  std::vector<std::int32_t> next(node_offset_.begin(), node_offset_.end() - 1);
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    for (int a = 0; a < corners; ++a) node_cells_[next[mesh_.cells[c][a]]++] = static_cast<std::int32_t>(c);
  }
}

void CellNeighbors::find_at_faces() {
  const CellShape& shape = *mesh_.shape;
  face_offset_.assign(1, 0);
  face_offset_.reserve(mesh_.cells.size() * shape.faces.size() + 1);
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    const auto& corners = mesh_.cells[c];
    for (const auto& face : shape.faces) {
      for (const std::int32_t other : at_node(corners[face[0]])) {
        if (other == static_cast<std::int32_t>(c)) continue;
        const auto& there = mesh_.cells[other];
        const bool shared = std::all_of(face.begin() + 1, face.end(), [&](int a) {
          return std::find(there.begin(), there.begin() + shape.corners, corners[a]) != there.begin() + shape.corners;
        });
        if (shared) face_cells_.push_back(other);
      }
      face_offset_.push_back(static_cast<std::int32_t>(face_cells_.size()));
    }
  }
}

int CellNeighbors::edge_of(std::int32_t cell, std::int32_t a, std::int32_t b) const {
  const auto& corners = mesh_.cells[cell];
  int from = -1, to = -1;
  for (int i = 0; i < mesh_.shape->corners; ++i) {
    if (corners[i] == a) from = i;
    if (corners[i] == b) to = i;
  }
  return from >= 0 && to >= 0 ? mesh_.shape->edge_of[from][to] : -1;
}

std::vector<std::int32_t> CellNeighbors::at_edge(const NodePair& edge) const {
  std::vector<std::int32_t> cells;
  for (const std::int32_t c : at_node(edge[0])) {
    if (edge_of(c, edge[0], edge[1]) >= 0) cells.push_back(c);
  }
  return cells;
}

}  // namespace pliant
