#include "haptics/proxy.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_tree.h"
#include "geometry/vec.h"

namespace pliant::haptics {
namespace {

constexpr double kResting = 1e-9;  // of the radius: what counts as touching, and as resting
constexpr double kLevel = 1e-6;    // of the radius: how far a triangle may rise above a plane that it shares

/// The vector in unit length, or `otherwise` where it has none.
Vec3d unit_or(const Vec3d& v, const Vec3d& otherwise) {
  const double size = vec::norm(v);
  return size > 0 ? vec::mul(v, 1 / size) : otherwise;
}

}  // namespace

bool ProxyForce::surface(std::span<const Triangle> triangles) noexcept {
  count_ = 0;
  for (const Triangle& t : triangles.first(std::min(triangles.size(), kTriangles))) {
    triangles_[count_] = t;
    normals_[count_] = unit_or(vec::cross(vec::sub(t[1], t[0]), vec::sub(t[2], t[0])), {});
    if (normals_[count_] == Vec3d{}) continue;
    const Vec3d centre = vec::mul(vec::add(t[0], vec::add(t[1], t[2])), 1.0 / 3);
    double extent = 0;
    for (const Vec3d& corner : t) extent = std::max(extent, vec::norm(vec::sub(corner, centre)));
    centres_[count_] = centre;
    extents_[count_++] = extent;
  }
  return triangles.size() <= kTriangles;
}

void ProxyForce::receive(const FrameReport& /*report*/) noexcept {}

/// At an edge or corner the triangle that is seen the least askew counts: its side of the surface is the proxy's.
ProxyForce::Near ProxyForce::nearest(double reach) noexcept {
  Near best{0, HUGE_VAL, {}};
  double frontal = 0;
  close_count_ = 0;
  for (std::size_t t = 0; t < count_; ++t) {
    if (vec::norm(vec::sub(proxy_, centres_[t])) - extents_[t] > reach) continue;
    close_[close_count_++] = t;
    points_[t] = closest_on_triangle(proxy_, triangles_[t][0], triangles_[t][1], triangles_[t][2]);
    const Vec3d away = vec::sub(proxy_, points_[t]);
    const double distance = vec::norm(away), height = std::abs(vec::dot(away, normals_[t]));
    const bool same = std::abs(distance - best.distance) <= kResting * radius_;
    if (same ? height <= frontal : distance > best.distance) continue;
    best = {t, distance, points_[t]};
    frontal = height;
  }
  return best;
}

void ProxyForce::put_outside(const Near& near) noexcept {
  const Vec3d& normal = normals_[near.triangle];
  if (near.distance >= radius_) return;
  const Vec3d away = vec::sub(proxy_, near.point);
  const bool behind = vec::dot(away, normal) < 0;
  proxy_ = vec::add(near.point, vec::mul(behind ? normal : unit_or(away, normal), radius_));
}

ProxyForce::Plane ProxyForce::plane_for(std::size_t triangle, const Plane& below, const Vec3d& goal) const noexcept {
  const auto along = [&](const Vec3d& normal) {
    double highest = -HUGE_VAL;
    for (const Vec3d& corner : triangles_[triangle]) highest = std::max(highest, vec::dot(normal, corner));
    return Plane{normal, highest + radius_};
  };
  const Plane shared = along(below.normal);
  if (shared.offset <= below.offset + kLevel * radius_) return {below.normal, below.offset};
  const Vec3d &point = points_[triangle], &normal = normals_[triangle];
  const Vec3d towards = unit_or(vec::sub(proxy_, point), normal);
  const Plane between{towards, std::min(vec::dot(towards, point) + radius_, vec::dot(towards, proxy_))};
  const Plane own = along(normal);
  const bool apart = vec::dot(normal, proxy_) >= own.offset - kLevel * radius_;
  const bool freer = own.offset - vec::dot(normal, goal) < between.offset - vec::dot(towards, goal);
  return apart && freer ? own : between;
}

Vec3d ProxyForce::nearest_allowed(const Vec3d& goal, std::size_t planes) const noexcept {
  std::array<const Plane*, kTouched> touched{};
  std::array<double, kTouched> push{};
  std::size_t count = 0;
  Vec3d x = goal;
  for (std::size_t pass = 0; pass < 4 * kTouched; ++pass) {
    const Plane* worst = nullptr;
    double depth = kResting * radius_;
    for (std::size_t p = 0; p < planes; ++p) {
      const double into = planes_[p].offset - vec::dot(planes_[p].normal, x);
      if (into > depth) {
        depth = into;
        worst = &planes_[p];
      }
    }
    if (worst == nullptr) return x;
    if (std::find(touched.begin(), touched.begin() + count, worst) == touched.begin() + count) {
      if (count == kTouched) return proxy_;  // too many: it stays where it is allowed to be
      touched[count++] = worst;
    }
    double moved = HUGE_VAL;
    for (int sweep = 0; sweep < 200 && moved > 0.1 * kResting * radius_; ++sweep) {
      moved = 0;
      for (std::size_t t = 0; t < count; ++t) {
        const double more = std::max(touched[t]->offset - vec::dot(touched[t]->normal, x), -push[t]);
        push[t] += more;
        x = vec::add(x, vec::mul(touched[t]->normal, more));
        moved = std::max(moved, std::abs(more));
      }
    }
    if (moved > 0.1 * kResting * radius_) return proxy_;  // planes so nearly opposite that the ascent does not end
  }
  return proxy_;
}

Wrench ProxyForce::tick(const Pose& tool, double /*dt*/) noexcept {
  const Vec3d& goal = tool.position;
  if (!vec::finite(goal)) return {};
  if (!started_) proxy_ = goal;
  started_ = true;
  for (int round = 0; round < kRounds; ++round) {
    const Near near = nearest(vec::norm(vec::sub(goal, proxy_)) + 3 * radius_);  // the proxy may be put up to 2 radii away
    if (close_count_ == 0) {
      proxy_ = goal;
      break;
    }
    const Vec3d before = proxy_;
    put_outside(near);
    if (proxy_ != before) {
      for (std::size_t c = 0; c < close_count_; ++c) {
        const Triangle& t = triangles_[close_[c]];
        points_[close_[c]] = closest_on_triangle(proxy_, t[0], t[1], t[2]);
      }
    }
    const Vec3d up = unit_or(vec::sub(proxy_, near.point), normals_[near.triangle]);
    const Plane below{up, std::min(vec::dot(up, near.point) + radius_, vec::dot(up, proxy_))};
    const double reach = vec::norm(vec::sub(goal, proxy_)) + radius_;
    std::size_t planes = 0;
    for (std::size_t c = 0; c < close_count_; ++c) {
      const std::size_t t = close_[c];
      if (vec::norm(vec::sub(proxy_, points_[t])) <= reach) planes_[planes++] = plane_for(t, below, goal);
    }
    const Vec3d next = nearest_allowed(goal, planes);
    const bool rests = vec::norm(vec::sub(next, proxy_)) <= kResting * radius_;
    proxy_ = next;
    if (rests) break;
  }
  return {vec::mul(vec::sub(proxy_, goal), stiffness_), {}};
}

}  // namespace pliant::haptics
