#include "cutting/rest_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>

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
  for (int a = 0; a < 3; ++a) {  // blades are looked at next to the body, too
    all.lower[a] -= size;
    all.upper[a] += size;
  }
  frame_ = ExactFrame(all);
  for (std::size_t n = 0; n < mesh.rest.size(); ++n) {
    node_.push_back(frame_.snap(mesh.rest[n], static_cast<std::int64_t>(n)));
  }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    vec::Box box;
    for (int a = 0; a < mesh.shape->corners; ++a) box.extend(mesh.rest[mesh.cells[c][a]]);
    hash_.insert(box, static_cast<std::int32_t>(c));
  }
}

double RestEdges::place(const NodePair& pair, const std::array<Vec3d, 3>& t) const {
  const Vec3d normal = vec::cross(vec::sub(t[1], t[0]), vec::sub(t[2], t[0]));
  const double from = vec::dot(normal, vec::sub(mesh_.rest[pair[0]], t[0]));
  const double to = vec::dot(normal, vec::sub(mesh_.rest[pair[1]], t[0]));
  const double at = from / (from - to);
  return std::isfinite(at) ? std::clamp(at, kLeastCrossing, 1 - kLeastCrossing) : 0.5;
}

}  // namespace pliant
