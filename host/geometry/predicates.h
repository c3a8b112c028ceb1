// Exact geometric decisions. Points are snapped to a fine integer grid once; every decision is then the exact sign of an
// integer determinant, and ties are broken by simulation of simplicity (Edelsbrunner and Muecke 1990): the answers are those of
// points moved by infinitesimal amounts that depend on their ids alone. So no decision is ever "on the plane", and all
// decisions about the same points agree with each other.
#pragma once
#include <array>
#include <cstdint>

#include "geometry/vec.h"

namespace pliant {

/// A point on the grid of an ExactFrame. The same id has to mean the same point; different points may coincide.
struct ExactPoint {
  std::array<std::int64_t, 3> x{};
  std::int64_t id = 0;
};

/// The integer grid: 2^38 steps from the middle of a box to its sides, 4e-12 of its half width.
class ExactFrame {
 public:
  ExactFrame() = default;
  /// Points to be snapped should lie in `box`; those outside are moved to its border.
  explicit ExactFrame(const vec::Box& box);
  [[nodiscard]] ExactPoint snap(const Vec3d& p, std::int64_t id) const;
  /// Width of a grid step [m].
  [[nodiscard]] double step() const { return 1 / scale_; }

 private:
  Vec3d middle_{};
  double scale_ = 1;
};

/// 1 if d lies in front of the triangle (a, b, c), on the side from which it is seen counter-clockwise, that is, if the
/// tetrahedron (a, b, c, d) has positive volume; else -1. Never 0. The four ids have to differ.
int orient(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d);

/// Whether the segment from u to w crosses the triangle (a, b, c): 1 from its back to its front, -1 from its front to its back,
/// 0 not at all. The five ids have to differ.
int crosses(const ExactPoint& u, const ExactPoint& w, const ExactPoint& a, const ExactPoint& b, const ExactPoint& c);
/// The same where u and w are known to lie on different sides of the triangle.
bool passes(const ExactPoint& u, const ExactPoint& w, const ExactPoint& a, const ExactPoint& b, const ExactPoint& c);

}  // namespace pliant
