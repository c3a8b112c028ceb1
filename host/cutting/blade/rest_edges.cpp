#include "cutting/blade/rest_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_set>

namespace pliant {

std::int64_t blade_point_number(const Vec3d& p) {
  std::uint64_t h = 0x9e3779b97f4a7c15U;
  for (const double c : p) {
    h ^= std::bit_cast<std::uint64_t>(c + 0.0);  // -0 is 0
    h *= 0xff51afd7ed558ccdU;
    h ^= h >> 32;
  }
  return static_cast<std::int64_t>(h >> 2 | std::uint64_t{1} << 62);  // above every node
}

RestEdges::RestEdges(const CutMesh& mesh, double edge)
    : mesh_(mesh), hash_(edge > 0 ? edge : 1, std::bit_ceil(std::max<std::size_t>(mesh.cells.size(), 64))) {
  vec::Box all;
  for (const Vec3d& p : mesh.rest) all.extend(p);
  double size = edge;
  for (int a = 0; a < 3; ++a) size = std::max(size, all.upper[a] - all.lower[a]);
  for (int a = 0; a < 3; ++a) {  // blades may also be next to the body
    all.lower[a] -= size;
    all.upper[a] += size;
  }
  frame_ = ExactFrame(all);
  for (std::size_t n = 0; n < mesh.rest.size(); ++n) {
    node_.push_back(frame_.snap(mesh.rest[n], static_cast<std::int64_t>(n)));
  }
  side_.resize(node_.size());
  std::unordered_set<std::uint64_t> met;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    own_edges_.push_back(0);
    for (std::size_t e = 0; e < mesh.shape->edges.size(); ++e) {
      const NodePair pair = node_pair(mesh.cells[c][mesh.shape->edges[e][0]], mesh.cells[c][mesh.shape->edges[e][1]]);
      const std::uint64_t key = static_cast<std::uint64_t>(pair[0]) << 32 | static_cast<std::uint32_t>(pair[1]);
      if (met.insert(key).second) own_edges_.back() |= 1U << e;
    }
    vec::Box box, exact;
    for (int a = 0; a < mesh.shape->corners; ++a) {
      const auto& x = node_[mesh.cells[c][a]].x;
      box.extend(mesh.rest[mesh.cells[c][a]]);
      exact.extend(Vec3d{static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])});
    }
    hash_.insert(box, static_cast<std::int32_t>(c));
    middle_.push_back(vec::mul(vec::add(exact.lower, exact.upper), 0.5));
    reach_.push_back(vec::mul(vec::sub(exact.upper, exact.lower), 0.5));
  }
}

RestEdges::Plane::Plane(const std::array<ExactPoint, 3>& t) {
  Vec3d u{}, v{};
  for (int k = 0; k < 3; ++k) {
    base_[k] = static_cast<double>(t[0].x[k]);
    u[k] = static_cast<double>(t[1].x[k] - t[0].x[k]);
    v[k] = static_cast<double>(t[2].x[k] - t[0].x[k]);
  }
  normal_ = vec::cross(u, v);
  for (int k = 0; k < 3; ++k) {  // of two products and their difference, with room
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    error_[k] = 1e-15 * (std::abs(u[i] * v[j]) + std::abs(u[j] * v[i]));
  }
}

bool RestEdges::Plane::misses(const Vec3d& middle, const Vec3d& reach) const {
  double distance = 0, extent = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = middle[k] - base_[k];
    distance += normal_[k] * d;
    extent += std::abs(normal_[k]) * reach[k] + (error_[k] + 1e-15 * std::abs(normal_[k])) * (std::abs(d) + reach[k]);
  }
  return std::abs(distance) > extent;
}

double RestEdges::place(const NodePair& pair, const std::array<Vec3d, 3>& t) const {
  const Vec3d normal = vec::cross(vec::sub(t[1], t[0]), vec::sub(t[2], t[0]));
  const double from = vec::dot(normal, vec::sub(mesh_.rest[pair[0]], t[0]));
  const double to = vec::dot(normal, vec::sub(mesh_.rest[pair[1]], t[0]));
  const double at = from / (from - to);
  return std::isfinite(at) ? std::clamp(at, kLeastCrossing, 1 - kLeastCrossing) : 0.5;
}

}  // namespace pliant
