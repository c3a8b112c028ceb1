#include "haptics/safety.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace pliant::haptics {
namespace {

/// Returns whether it was too long. The square of a large vector may overflow, that of a small one cannot matter.
bool shortened_to(Vec3d& v, double limit) {
  const double size = std::hypot(v[0], v[1], v[2]);
  if (size <= limit) return false;
  const double greatest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  const Vec3d scaled = vec::mul(v, 1 / greatest);
  v = vec::mul(scaled, limit / vec::norm(scaled));
  return limit > 0;
}

}  // namespace

Wrench ForceGuard::tick(const Wrench& wrench, double age, double dt) noexcept {
  ++counts_.ticks;
  const bool stale = !(age <= options_.stale_after);
  if (stale) ++counts_.stale;
  if (stale && !stale_) ++counts_.gaps;
  stale_ = stale;
  const double time = stale ? options_.ramp : options_.rise;
  const double change = time > 0 ? std::max(dt, 0.0) / time : 1;
  level_ = std::clamp(level_ + (stale ? -change : change), 0.0, 1.0);
  if (!vec::finite(wrench.force) || !vec::finite(wrench.torque)) {
    ++counts_.not_finite;
    return {};
  }
  Wrench out = wrench;
  const bool force = shortened_to(out.force, limits_.force), torque = shortened_to(out.torque, limits_.torque);
  if (force || torque) ++counts_.limited;
  const double w = weight();
  return {vec::mul(out.force, w), vec::mul(out.torque, w)};
}

}  // namespace pliant::haptics
