#include "model/nodes/whereabouts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "scene/closed_surface.h"

namespace pliant {
namespace {

/// From a point to the selection, 0 in it [m]; infinite where the selection is no place.
double distance_to(const Selection& where, const Vec3d& x) {
  switch (where.kind) {
    case Selection::Kind::box:
      return std::sqrt(vec::Box{where.a, where.b}.distance2(x));
    case Selection::Kind::sphere:
      return std::max(0.0, vec::norm(vec::sub(x, where.a)) - where.radius);
    case Selection::Kind::plane:
      return std::max(0.0, -vec::dot(vec::sub(x, where.a), where.b) / vec::norm(where.b));
    case Selection::Kind::surface:
      return where.surface == nullptr ? HUGE_VAL : where.surface->distance(x);
    case Selection::Kind::all:
    case Selection::Kind::nodes:
    case Selection::Kind::region:
      break;
  }
  return HUGE_VAL;
}

}  // namespace

vec::Box bounds_of(std::span<const Vec3d> points) {
  vec::Box box;
  for (const Vec3d& x : points) box.extend(x);
  return box;
}

std::string corners_text(const vec::Box& box) {
  return fmt::format("[{:.4g}] and [{:.4g}] m", fmt::join(box.lower, ", "), fmt::join(box.upper, ", "));
}

void NearestPoint::add(const Vec3d& point) {
  const double distance = distance_to(where_, point);
  if (!(distance < distance_)) return;
  distance_ = distance;
  at_ = point;
}

std::string NearestPoint::text(const char* what) const {
  if (!std::isfinite(distance_)) return "";
  return fmt::format("; the nearest {} is at [{:.4g}] m, {:.4g} m away", what, fmt::join(at_, ", "), distance_);
}

std::string nearest_text(const Selection& where, std::span<const Vec3d> points, const char* what) {
  NearestPoint nearest(where);
  for (const Vec3d& x : points) nearest.add(x);
  return nearest.text(what);
}

}  // namespace pliant
