#include "cutting/blade/inverse_map.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pliant {
namespace {

using Weights = std::array<double, 4>;

constexpr double kInside = -1e-9;
constexpr int kBisections = 10;
constexpr std::uint8_t kNotFinite = 1 << 6;
constexpr double kFarthest = 3;  ///< that a map is continued, in edges

/// Barycentric coordinates; not finite in a tetrahedron without volume.
Weights barycentric(const std::array<Vec3d, 4>& x, const Vec3d& p) {
  const Vec3d a = vec::sub(x[1], x[0]), b = vec::sub(x[2], x[0]), c = vec::sub(x[3], x[0]), r = vec::sub(p, x[0]);
  const Vec3d bc = vec::cross(b, c), ar = vec::cross(a, r);
  const double scale = 1 / vec::dot(a, bc);
  const double wa = scale * vec::dot(r, bc), wb = scale * vec::dot(c, ar), wc = -scale * vec::dot(b, ar);
  return {1 - wa - wb - wc, wa, wb, wc};
}

Vec3d blend(const std::array<Vec3d, 4>& x, const Weights& w) {
  Vec3d p{};
  for (std::size_t a = 0; a < 4; ++a) p = vec::add(p, vec::mul(x[a], w[a]));
  return p;
}

double least(const Weights& w) { return std::min({w[0], w[1], w[2], w[3]}); }

Weights clamped(Weights w) {
  double sum = 0;
  for (double& v : w) sum += v = std::max(v, 0.0);
  for (double& v : w) v /= sum;
  return w;
}

Weights mix(const Weights& a, const Weights& b, double t) {
  Weights w;
  for (std::size_t i = 0; i < 4; ++i) w[i] = a[i] + t * (b[i] - a[i]);
  return w;
}

vec::Box grown(vec::Box box, double by) {
  for (int a = 0; a < 3; ++a) {
    box.lower[a] -= by;
    box.upper[a] += by;
  }
  return box;
}

}  // namespace

Vec3d present_position(const CutTopology& body, std::span<const Vec3d> x, const MaterialPoint& point) {
  const auto in = [&](std::int32_t element) {
    Vec3d p{};
    for (std::size_t a = 0; a < 4; ++a) {
      const int corner = body.mesh().shape->tets[point.tet][a];
      p = vec::add(p, vec::mul(x[body.elements().nodes[element][corner]], point.weight[a]));
    }
    return p;
  };
  const auto cut = body.cells().find(point.cell);
  if (cut == body.cells().end() || cut->second.components == 1) return in(point.cell);
  // The point lies on the cut: both sides have carried it away from where the blade was, and the front is between them.
  Vec3d sum{};
  double count = 0;
  for (const std::int32_t element : cut->second.element) {
    if (element < 0) continue;
    sum = vec::add(sum, in(element));
    ++count;
  }
  return count > 0 ? vec::mul(sum, 1 / count) : in(point.cell);
}

InverseMap::InverseMap(const CutTopology& body, std::span<const Vec3d> x, const vec::Box& region, double edge, double reach)
    : body_(body), x_(x), edge_(edge), reach_(reach), hash_(1.5 * edge) {
  const vec::Box near = grown(region, reach);
  // Beyond which sides of the region a node lies: an element is far where all its nodes lie beyond one side.
  std::vector<std::uint8_t> beyond(x.size());
  for (std::size_t n = 0; n < x.size(); ++n) {
    for (int a = 0; a < 3; ++a) {
      beyond[n] |= static_cast<std::uint8_t>((x[n][a] < near.lower[a]) << 2 * a | (x[n][a] > near.upper[a]) << (2 * a + 1));
    }
    if (!vec::finite(x[n])) beyond[n] |= kNotFinite;
  }
  const auto& nodes = body.elements().nodes;
  const int corners = body.mesh().shape->corners;
  for (std::size_t e = 0; e < nodes.size(); ++e) {
    unsigned all = 0xff, any = 0;
    for (int a = 0; a < corners; ++a) {
      all &= beyond[nodes[e][a]];
      any |= beyond[nodes[e][a]];
    }
    if (all != 0 || (any & kNotFinite) != 0) continue;
    vec::Box box;
    for (int a = 0; a < corners; ++a) box.extend(x[nodes[e][a]]);
    all_.extend(box);
    hash_.insert(box, static_cast<std::int32_t>(element_.size()));
    element_.push_back(static_cast<std::int32_t>(e));
  }
}

MaterialPoint InverseMap::find(const Vec3d& p) {
  MaterialPoint out;
  if (all_.distance2(p) >= reach_ * reach_) return out;
  const vec::Box box{p, p};
  hits_.clear();
  hash_.query(box, [&](std::int32_t item) { hits_.push_back(item); });
  std::sort(hits_.begin(), hits_.end());
  for (const std::int32_t item : hits_) {
    if (inside(element_[item], p, out)) return out;
  }
  Best best{reach_ * reach_, {}};
  // The nearest boxes first: most of the others then cannot hold anything nearer.
  near_.clear();
  hash_.query(grown(box, reach_), [&](std::int32_t item) {
    const double distance2 = hash_.box(item).distance2(p);
    if (distance2 < best.distance2) near_.emplace_back(distance2, element_[item]);
  });
  std::sort(near_.begin(), near_.end());
  for (const auto& [distance2, element] : near_) {
    if (distance2 >= best.distance2) break;
    nearest(element, p, best);
  }
  return best.point;
}

std::array<Vec3d, 4> InverseMap::corners(std::int32_t element, int tet) const {
  std::array<Vec3d, 4> out;
  for (std::size_t a = 0; a < 4; ++a) out[a] = x_[body_.elements().nodes[element][body_.mesh().shape->tets[tet][a]]];
  return out;
}

std::array<Vec3d, 4> InverseMap::rest_corners(std::int32_t cell, int tet) const {
  std::array<Vec3d, 4> out;
  for (std::size_t a = 0; a < 4; ++a) out[a] = body_.mesh().rest[body_.mesh().cells[cell][body_.mesh().shape->tets[tet][a]]];
  return out;
}

/// Which places of a tetrahedron belong to an element's own part, not its virtual one.
class InverseMap::OwnPart {
 public:
  OwnPart(const CutTopology& body, std::int32_t element, int tet)
      : body_(body), element_(element), cell_(body.elements().cell[element]), tet_(tet) {
    const auto real = body.elements().real[element];
    int own = 0;
    for (const int corner : body.mesh().shape->tets[tet]) own += real >> corner & 1;
    whole_ = own == 4;
    if (body.divided(cell_) && own > 0 && own < 4) division_ = body.division(cell_, tet);
  }
  [[nodiscard]] bool holds(const Weights& weight) const {
    if (!division_) return whole_;
    return body_.element_of(cell_, body_.label_in(cell_, tet_, *division_, weight)) == element_;
  }

 private:
  const CutTopology& body_;
  std::int32_t element_, cell_;
  int tet_;
  bool whole_ = false;
  std::optional<TetDivision> division_;  ///< of one that has corners in several parts
};

bool InverseMap::inside(std::int32_t element, const Vec3d& p, MaterialPoint& out) const {
  const auto tets = static_cast<int>(body_.mesh().shape->tets.size());
  for (int t = 0; t < tets; ++t) {
    const Weights w = barycentric(corners(element, t), p);
    if (!(least(w) >= kInside) || !OwnPart(body_, element, t).holds(w)) continue;
    const std::int32_t cell = body_.elements().cell[element];
    out = {cell, t, w, blend(rest_corners(cell, t), w)};
    return true;
  }
  return false;
}

/// Move a place in an element's virtual part to the face of the cut, on the way to one of the element's real corners.
bool InverseMap::to_own_part(std::int32_t element, int tet, const OwnPart& part, Weights& weight) const {
  const auto& corner = body_.mesh().shape->tets[tet];
  int real = -1;
  for (int a = 0; a < 4; ++a) {
    if ((body_.elements().real[element] >> corner[a] & 1) == 0) continue;
    if (real < 0 || weight[a] > weight[real]) real = a;
  }
  if (real < 0) return false;
  Weights own{};
  own[real] = 1;
  double low = 0, high = 1;  // own part at `high`
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (low + high);
    (part.holds(mix(weight, own, middle)) ? high : low) = middle;
  }
  weight = mix(weight, own, high);
  return true;
}

void InverseMap::nearest(std::int32_t element, const Vec3d& p, Best& best) const {
  const auto tets = static_cast<int>(body_.mesh().shape->tets.size());
  const std::int32_t cell = body_.elements().cell[element];
  for (int t = 0; t < tets; ++t) {
    const std::array<Vec3d, 4> x = corners(element, t);
    const Weights w = barycentric(x, p);
    if (!std::isfinite(w[0] + w[1] + w[2] + w[3])) continue;
    Weights at = clamped(w);
    const auto distance2 = [&] {
      const Vec3d d = vec::sub(blend(x, at), p);
      return vec::dot(d, d);
    };
    double d2 = distance2();
    if (!(d2 < best.distance2)) continue;
    const std::array<Vec3d, 4> rest = rest_corners(cell, t);
    const OwnPart part(body_, element, t);
    if (!part.holds(at)) {
      if (!to_own_part(element, t, part, at)) continue;
      d2 = distance2();
      if (!(d2 < best.distance2)) continue;
      best = {d2, {cell, t, at, blend(rest, at)}};
      continue;
    }
    const double away = vec::norm(vec::sub(blend(rest, w), blend(rest, at)));
    const double most = kFarthest * edge_;
    const Weights outside = away > most ? mix(at, w, most / away) : w;
    best = {d2, {cell, t, outside, blend(rest, outside)}};
  }
}

}  // namespace pliant
