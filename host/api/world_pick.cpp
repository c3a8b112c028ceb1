// What a ray meets of the surface that the user sees.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "api/world_call.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

using Weights = std::array<double, 3>;

/// A vertex in coordinates in which the ray is the third axis, without the third.
struct Across {
  double x = 0, y = 0;
};

/// The shear that turns a ray into the third axis (S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle intersection", 2013,
/// section 3.1). It is made once per vertex, so triangles that share an edge have the same numbers for it.
class Shear {
 public:
  Shear(const Vec3d& origin, const Vec3d& direction) : origin_(origin) {
    const auto shorter = [](double a, double b) { return std::abs(a) < std::abs(b); };
    z_ = static_cast<std::size_t>(std::max_element(direction.begin(), direction.end(), shorter) - direction.begin());
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    for (std::size_t c = 0; c < 3; ++c) direction_[c] = direction[c] / std::abs(direction[z_]);  // no square overflows
  }
  [[nodiscard]] Across across(const Vec4f& p) const {
    const double ahead = depth(p);
    return {p[x_] - origin_[x_] - direction_[x_] * ahead, p[y_] - origin_[y_] - direction_[y_] * ahead};
  }
  /// Along the ray, in units of length().
  [[nodiscard]] double depth(const Vec4f& p) const { return (p[z_] - origin_[z_]) * direction_[z_]; }
  [[nodiscard]] double length() const { return vec::norm(direction_); }

 private:
  Vec3d origin_, direction_{};  ///< the largest component of the direction is 1 or -1
  std::size_t x_ = 0, y_ = 1, z_ = 2;
};

/// The barycentric weights of the axis in a triangle, or false if it passes outside. An edge function is a difference of two
/// products, which has the sign of the exact difference or is 0 even in rounded arithmetic. Zero belongs to both triangles of
/// an edge, so the axis cannot pass between them (Woop et al. 2013, section 3.2).
bool weigh(const Across& a, const Across& b, const Across& c, Weights& weights) {
  const auto edge = [](const Across& p, const Across& q) { return p.x * q.y - p.y * q.x; };
  weights = {edge(b, c), edge(c, a), edge(a, b)};
  const auto [least, most] = std::minmax({weights[0], weights[1], weights[2]});
  const double sum = weights[0] + weights[1] + weights[2];
  if ((least < 0 && most > 0) || !(std::abs(sum) > 0)) return false;
  for (double& w : weights) w /= sum;
  return true;
}

/// Which sides of the two planes through the axis a vertex is on, a bit for each. A triangle whose vertices have one in common
/// is passed, which rules out nearly all of them.
std::uint8_t sides_of(const Across& p) {
  return static_cast<std::uint8_t>((p.x > 0 ? 1 : 0) | (p.x < 0 ? 2 : 0) | (p.y > 0 ? 4 : 0) | (p.y < 0 ? 8 : 0));
}

struct Hit {
  std::size_t triangle = 0;
  Weights weights{};
  double depth = HUGE_VAL;
};

Hit nearest_hit(const Frame& frame, const Shear& shear) {
  std::vector<Across> across(frame.positions.size());
  std::vector<std::uint8_t> sides(frame.positions.size());
  for (std::size_t v = 0; v < across.size(); ++v) {
    across[v] = shear.across(frame.positions[v]);
    sides[v] = sides_of(across[v]);
  }
  Hit nearest;
  Weights weights{};
  for (std::size_t i = 0; i < frame.triangles.size(); ++i) {
    const Triangle& t = frame.triangles[i];
    if ((sides[t[0]] & sides[t[1]] & sides[t[2]]) != 0) continue;
    if (!weigh(across[t[0]], across[t[1]], across[t[2]], weights)) continue;
    double depth = 0;
    for (std::size_t k = 0; k < 3; ++k) depth += weights[k] * shear.depth(frame.positions[t[k]]);
    if (depth > 0 && depth < nearest.depth) nearest = {i, weights, depth};
  }
  return nearest;
}

Vec3d position_of(const Frame& frame, std::int32_t vertex) {
  const Vec4f& p = frame.positions[vertex];
  return {p[0], p[1], p[2]};
}

PickedPoint picked_point(const Frame& frame, const Hit& hit, double length) {
  const Triangle& t = frame.triangles[hit.triangle];
  const std::array<Vec3d, 3> x{position_of(frame, t[0]), position_of(frame, t[1]), position_of(frame, t[2])};
  PickedPoint found;
  for (std::size_t b = 0; b < frame.body_triangles.size(); ++b) {
    if (hit.triangle - frame.body_triangles[b].first < frame.body_triangles[b].count) found.body = b;
  }
  found.triangle = hit.triangle;
  found.weights = hit.weights;
  for (std::size_t k = 0; k < 3; ++k) found.point = vec::add(found.point, vec::mul(x[k], hit.weights[k]));
  const auto nearer = [&](const Vec3d& a, const Vec3d& b) {
    return vec::norm(vec::sub(a, found.point)) < vec::norm(vec::sub(b, found.point));
  };
  found.vertex = t[static_cast<std::size_t>(std::min_element(x.begin(), x.end(), nearer) - x.begin())];
  const Vec3d normal = vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0]));
  const double area = vec::norm(normal);
  if (area > 0) found.normal = vec::mul(normal, 1 / area);
  found.distance = hit.depth * length;
  return found;
}

void check_ray(const Vec3d& origin, const Vec3d& direction) {
  if (vec::finite(origin) && vec::finite(direction) && direction != Vec3d{}) return;
  throw Error(ErrorCode::usage,
              fmt::format("pick: got a ray from [{}] m in the direction [{}]; allowed are finite numbers and a "
                          "direction that is not zero",
                          fmt::join(origin, ", "), fmt::join(direction, ", ")));
}

}  // namespace

std::optional<PickedPoint> World::pick(const Vec3d& origin, const Vec3d& direction) const {
  const api::Call call(impl_, false);
  check_ray(origin, direction);
  std::shared_ptr<const api::FrameData> seen;
  {
    const std::lock_guard lock(impl_->mutex);
    seen = impl_->frames.seen();
  }
  if (seen == nullptr) return std::nullopt;
  const Shear shear(origin, direction);
  const Hit hit = nearest_hit(seen->frame, shear);
  if (hit.depth == HUGE_VAL) return std::nullopt;
  return picked_point(seen->frame, hit, shear.length());
}

}  // namespace pliant
