#include "tearing/remade_body.h"

#include <algorithm>
#include <limits>

#include "geometry/vec.h"
#include "tearing/uncut_mesh.h"

namespace pliant {
namespace {

/// Six times the signed volume of a tetrahedron.
double volume6(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return vec::dot(vec::cross(vec::sub(b, a), vec::sub(c, a)), vec::sub(d, a));
}

}  // namespace

RemadeBody::RemadeBody(std::shared_ptr<const BodyMesh> whole) : whole_(std::move(whole)), solid_(*whole_) {
  solid_.parts.whole = whole_;
  for (std::size_t e = 0; e < solid_.size(); ++e) solid_.parts.of.push_back(static_cast<std::int32_t>(e));
  solid_.parts.before = solid_.parts.of;
  solid_.whole_nodes = whole_->nodes.size();
  elements_changed();
  edge_ = mean_edge(topology_->mesh());
}

void RemadeBody::elements_changed() {
  const auto fill = [](Parts& parts, std::size_t elements, const std::vector<std::int32_t>& from) {
    parts.assign(elements, {});
    for (std::size_t e = 0; e < from.size(); ++e)
      parts[static_cast<std::size_t>(from[e])].push_back(static_cast<std::int32_t>(e));
  };
  const std::vector<std::int32_t>& before = solid_.parts.before;
  fill(of_whole_, whole_->size(), solid_.parts.of);
  const std::size_t had = topology_ == nullptr ? before.size() : topology_->mesh().cells.size();
  fill(of_before_, had, before);
  topology_ = std::make_unique<CutTopology>(uncut_mesh(solid_));
}

/// Barycentric coordinates of a place in a tetrahedron at rest.
std::array<double, 4> RemadeBody::weights(std::int32_t e, const Vec3d& rest) const {
  std::array<Vec3d, 4> x;
  for (std::size_t a = 0; a < 4; ++a) x[a] = solid_.nodes[solid_.tets[e][a]];
  const double all = volume6(x[0], x[1], x[2], x[3]);
  return {volume6(rest, x[1], x[2], x[3]) / all, volume6(x[0], rest, x[2], x[3]) / all, volume6(x[0], x[1], rest, x[3]) / all,
          volume6(x[0], x[1], x[2], rest) / all};
}

/// Of several tetrahedra the one that a place is in, or least far out of; -1: there is none. An element that has not been
/// divided is alone, and need not be a tetrahedron.
std::int32_t RemadeBody::nearest(const std::vector<std::int32_t>& elements, const Vec3d& rest) const {
  if (elements.size() == 1) return elements[0];
  std::int32_t best = -1;
  double most = -std::numeric_limits<double>::infinity();
  for (const std::int32_t e : elements) {
    const std::array<double, 4> w = weights(e, rest);
    const double least = *std::min_element(w.begin(), w.end());
    if (!(least > most)) continue;
    most = least;
    best = e;
  }
  return best;
}

std::int32_t RemadeBody::element_at(std::int32_t e, const Vec3d& rest) const {
  return nearest(of_whole_[static_cast<std::size_t>(e)], rest);
}

void RemadeBody::follow(MaterialPoint& point) const {
  if (point.cell < 0 || static_cast<std::size_t>(point.cell) >= of_before_.size()) return;
  const std::vector<std::int32_t>& parts = of_before_[static_cast<std::size_t>(point.cell)];
  const std::int32_t e = nearest(parts, point.rest);
  if (e >= 0 && parts.size() > 1) point.weight = weights(e, point.rest);
  point.cell = e;
}

}  // namespace pliant
