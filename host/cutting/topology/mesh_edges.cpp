#include "cutting/topology/mesh_edges.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "geometry/vec.h"

namespace pliant {

namespace {

/// Copies take a while to spring back after the edge between them has parted: only those that are stretched this much further
/// have not been freed by it.
constexpr double kFar = 4;

bool is_long(const Vec3d& a, const Vec3d& b, double squared) {
  const Vec3d d = vec::sub(a, b);
  const double now = vec::dot(d, d);
  return now > squared && now <= std::numeric_limits<double>::max();
}

}  // namespace

MeshEdges::MeshEdges(const CutMesh& mesh) {
  for (const auto& cell : mesh.cells) {
    for (const auto& [a, b] : mesh.shape->edges) pairs_.push_back(node_pair(cell[a], cell[b]));
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  for (const auto& [a, b] : pairs_) {
    const Vec3d d = vec::sub(mesh.rest[a], mesh.rest[b]);
    squared_.push_back(vec::dot(d, d));
  }
  first_.resize(mesh.rest.size() + 1);
  for (const NodePair& pair : pairs_) {
    for (const std::int32_t n : pair) ++first_[n + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  at_.resize(2 * pairs_.size());
  std::vector<std::int32_t> next = first_;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for (const std::int32_t n : pairs_[i]) at_[next[n]++] = static_cast<std::int32_t>(i);
  }
}

CutEdges MeshEdges::longer(const CutTopology& body, std::span<const Vec3d> x, double times) const {
  CutEdges out;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (!is_long(x[pairs_[i][0]], x[pairs_[i][1]], times * times * squared_[i])) continue;
    if (!body.edges().contains(pairs_[i])) out[pairs_[i]] = 0.5;
  }
  free_corners(body, x, kFar * times, out);
  return out;
}

void MeshEdges::free_corners(const CutTopology& body, std::span<const Vec3d> x, double times, CutEdges& out) const {
  const CutMesh& mesh = body.mesh();
  const CutElements& elements = body.elements();
  for (const auto& [cell, cut] : body.cells()) {
    for (int k = 0; cut.components > 1 && k < cut.components; ++k) {
      const std::int32_t e = cut.element[k];
      if (e < 0) continue;
      const bool stretched = std::any_of(mesh.shape->edges.begin(), mesh.shape->edges.end(), [&](const auto& edge) {
        const auto& [a, b] = edge;
        const Vec3d rest = vec::sub(mesh.rest[mesh.cells[cell][a]], mesh.rest[mesh.cells[cell][b]]);
        return is_long(x[elements.nodes[e][a]], x[elements.nodes[e][b]], times * times * vec::dot(rest, rest));
      });
      for (int a = 0; stretched && a < mesh.shape->corners; ++a) {
        if ((elements.real[e] >> a & 1) == 0) continue;
        const std::int32_t node = mesh.cells[cell][a];
        for (std::int32_t i = first_[node]; i < first_[node + 1]; ++i) {
          if (!body.edges().contains(pairs_[at_[i]])) out[pairs_[at_[i]]] = 0.5;
        }
      }
    }
  }
}

}  // namespace pliant
