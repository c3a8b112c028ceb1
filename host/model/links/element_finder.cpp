#include "model/links/element_finder.h"

#include <algorithm>

#include "geometry/barycentric.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

/// Barycentric coordinates of a point in a tetrahedron are at least minus this: the corners of a lattice differ from those of
/// its surface by rounding.
constexpr double kSlack = 1e-6;

/// The mean size of the elements' boxes.
double edge_of(const BodyElements& solid) {
  double sum = 0;
  for (std::size_t e = 0; e < solid.size(); ++e) {
    vec::Box box;
    for (const std::int32_t n : solid.corners(e)) box.extend(solid.nodes[n]);
    sum += std::max({box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
  }
  return sum / static_cast<double>(solid.size());
}

}  // namespace

ElementFinder::ElementFinder(const BodyElements& solid) : solid_(solid), edge_(edge_of(solid)), hash_(edge_) {
  for (std::size_t e = 0; e < solid.size(); ++e) {
    vec::Box box;
    for (const std::int32_t n : solid.corners(e)) box.extend(solid.nodes[n]);
    hash_.insert(box, static_cast<std::int32_t>(e));
  }
}

Held ElementFinder::find(const Vec3d& p) {
  Held best;
  double most = -1;
  vec::Box at;
  for (const double side : {-kSlack, kSlack}) {
    Vec3d near_p = p;
    for (double& c : near_p) c += side * edge_;
    at.extend(near_p);
  }
  std::vector<std::int32_t> near;
  hash_.query(at, [&](std::int32_t e) { near.push_back(e); });
  std::sort(near.begin(), near.end());
  for (const std::int32_t e : near) {
    const std::optional<Held> held = in_element(e, p);
    if (!held) continue;
    const double real = real_weight(*held);
    if (real > most + kSlack) {
      most = real;
      best = *held;
    }
  }
  return best;
}

std::optional<Held> ElementFinder::in_tet(std::int32_t e, const std::array<std::int32_t, 4>& nodes, const Vec3d& p) const {
  std::array<Vec3d, 4> x{};
  for (std::size_t a = 0; a < 4; ++a) x[a] = solid_.nodes[nodes[a]];
  const std::array<double, 4> w = barycentric_weights(x, p);
  if (!std::all_of(w.begin(), w.end(), [](double v) { return v >= -kSlack; })) return {};
  return Held{e, nodes, w};
}

/// In one of the six tetrahedra of a hexahedron the displacement of the point is linear in those of four corners.
std::optional<Held> ElementFinder::in_element(std::int32_t e, const Vec3d& p) const {
  const std::span<const std::int32_t> corners = solid_.corners(static_cast<std::size_t>(e));
  if (corners.size() == 4) return in_tet(e, {corners[0], corners[1], corners[2], corners[3]}, p);
  for (const auto& tet : kKuhnTets) {
    if (auto held = in_tet(e, {corners[tet[0]], corners[tet[1]], corners[tet[2]], corners[tet[3]]}, p)) return held;
  }
  return {};
}

double ElementFinder::real_weight(const Held& held) const {
  const std::int32_t first = solid_.virtual_nodes.first;
  double sum = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    if (first < 0 || held.nodes[a] < first) sum += held.weights[a];
  }
  return sum;
}

int ElementFinder::pairs(std::int32_t e, std::int32_t f, bool places) const {
  int count = 0;
  for (const std::int32_t m : solid_.corners(static_cast<std::size_t>(e))) {
    for (const std::int32_t n : solid_.corners(static_cast<std::size_t>(f))) {
      if (places ? solid_.nodes[m] == solid_.nodes[n] : m == n) ++count;
    }
  }
  return count;
}

}  // namespace pliant
