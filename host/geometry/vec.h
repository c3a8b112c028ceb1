// Arithmetic on Vec3d for the set-up code (double; no bit of it reaches a backend except through the Model).
#pragma once
#include <cmath>

#include "geometry/vec3.h"

namespace pliant::vec {

inline Vec3d add(const Vec3d& a, const Vec3d& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3d sub(const Vec3d& a, const Vec3d& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3d mul(const Vec3d& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Vec3d& a) { return std::sqrt(dot(a, a)); }
inline bool finite(const Vec3d& a) { return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]); }

/// Axis-aligned box; empty until the first point is added.
struct Box {
  Vec3d lower{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3d upper{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  void extend(const Vec3d& p) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = p[a] < lower[a] ? p[a] : lower[a];
      upper[a] = p[a] > upper[a] ? p[a] : upper[a];
    }
  }
  void extend(const Box& b) {
    extend(b.lower);
    extend(b.upper);
  }
  [[nodiscard]] bool overlaps(const Box& b) const {
    for (int a = 0; a < 3; ++a) {
      if (b.lower[a] > upper[a] || b.upper[a] < lower[a]) return false;
    }
    return true;
  }
  /// Squared distance from p; 0 inside.
  [[nodiscard]] double distance2(const Vec3d& p) const {
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
      const double d = p[a] < lower[a] ? lower[a] - p[a] : p[a] > upper[a] ? p[a] - upper[a] : 0;
      sum += d * d;
    }
    return sum;
  }
};

}  // namespace pliant::vec
