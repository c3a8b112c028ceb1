#include "cutting/topology/mesh_edges.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "geometry/vec.h"

namespace pliant {
namespace {

bool is_long(const Vec3d& a, const Vec3d& b, double squared) {
  const Vec3d d = vec::sub(a, b);
  const double now = vec::dot(d, d);
  return now > squared && now <= std::numeric_limits<double>::max();
}

/// The axes along which two corners of a lattice cell differ, as bits.
unsigned axes_between(int a, int b) { return static_cast<unsigned>(a ^ b); }

}  // namespace

MeshEdges::MeshEdges(const CutMesh& mesh) {
  for (const auto& cell : mesh.cells) {
    for (const auto& [a, b] : mesh.shape->edges) {
      if (mesh.shape->corners == 8 && std::popcount(axes_between(a, b)) > 1) continue;
      pairs_.push_back(node_pair(cell[a], cell[b]));
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  for (const auto& [a, b] : pairs_) {
    const Vec3d d = vec::sub(mesh.rest[a], mesh.rest[b]);
    squared_.push_back(vec::dot(d, d));
  }
}

CutEdges MeshEdges::longer(const CutTopology& body, std::span<const Vec3d> x, double times) const {
  CutEdges out;
  std::vector<char> at_cut(body.mesh().rest.size(), false);
  for (const auto& [cell, cut] : body.cells()) {
    for (int a = 0; a < body.mesh().shape->corners; ++a) at_cut[static_cast<std::size_t>(body.mesh().cells[cell][a])] = true;
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const auto& [a, b] = pairs_[i];
    if (!is_long(x[a], x[b], times * times * squared_[i])) continue;
    const bool whole = !at_cut[static_cast<std::size_t>(a)] && !at_cut[static_cast<std::size_t>(b)];
    if (whole && !is_long(x[a], x[b], kWholeStretch * kWholeStretch * times * times * squared_[i])) continue;
    if (!body.edges().contains(pairs_[i])) part(body, pairs_[i], out);
  }
  free_corners(body, x, kFreedStretch * times, out);
  return out;
}

/// A lattice cell is cut along its Kuhn tetrahedra: its two halves part when its diagonals are cut as well.
void MeshEdges::part(const CutTopology& body, const NodePair& pair, CutEdges& out) const {
  const CutMesh& mesh = body.mesh();
  out[pair] = 0.5;
  if (mesh.shape->corners != 8) return;
  for (const std::int32_t cell : body.cells_at_edge(pair)) {
    const auto& nodes = mesh.cells[cell];
    const auto corner = [&](std::int32_t n) {
      return static_cast<int>(std::find(nodes.begin(), nodes.end(), n) - nodes.begin());
    };
    const unsigned axis = axes_between(corner(pair[0]), corner(pair[1]));
    for (const auto& [a, b] : mesh.shape->edges) {
      const NodePair other = node_pair(nodes[a], nodes[b]);
      if ((axes_between(a, b) & axis) != 0 && !body.edges().contains(other)) out[other] = 0.5;
    }
  }
}

void MeshEdges::free_corners(const CutTopology& body, std::span<const Vec3d> x, double times, CutEdges& out) const {
  const CutMesh& mesh = body.mesh();
  const CutElements& elements = body.elements();
  for (const auto& [cell, cut] : body.cells()) {
    const auto& nodes = mesh.cells[cell];
    for (int k = 0; cut.components > 1 && k < cut.components; ++k) {
      const std::int32_t e = cut.element[k];
      if (e < 0) continue;
      const bool stretched = std::any_of(mesh.shape->edges.begin(), mesh.shape->edges.end(), [&](const auto& edge) {
        const auto& [a, b] = edge;
        const Vec3d rest = vec::sub(mesh.rest[nodes[a]], mesh.rest[nodes[b]]);
        return is_long(x[elements.nodes[e][a]], x[elements.nodes[e][b]], times * times * vec::dot(rest, rest));
      });
      if (!stretched) continue;
      for (const auto& [a, b] : mesh.shape->edges) {
        const NodePair pair = node_pair(nodes[a], nodes[b]);
        const bool at_real = (elements.real[e] >> a & 1) != 0 || (elements.real[e] >> b & 1) != 0;
        if (at_real && !body.edges().contains(pair)) out[pair] = 0.5;
      }
    }
  }
}

}  // namespace pliant
