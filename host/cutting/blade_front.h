// The front of a cut: where a blade stands in the material. Tissue moves between two looks at the blade; what the blade sweeps
// is therefore measured from where its last place has been carried by the material, so that sweeps join and leave no bridges,
// and tissue that is pulled across a resting blade is cut.
#pragma once
#include <span>
#include <vector>

#include "cutting/blade.h"
#include "cutting/cut_topology.h"

namespace pliant {

/// A point of a blade inside a body.
struct FrontPoint {
  std::int32_t place = 0;          ///< along the blade: place / 2^levels of the way from its first end
  std::int32_t cell = 0, tet = 0;  ///< of the uncut body
  std::array<double, 4> weight{};  ///< barycentric
};

struct BladeFront {
  BladeSegment blade{};
  int levels = 0;
  std::vector<FrontPoint> points;  ///< ascending places; those that lie in no material are left out
};

/// Levels for points at most half of `edge` apart [m], at most 12.
int front_levels(const BladeSegment& blade, double edge);

/// Remember what of the body a blade stands in. `x` [m]: present positions of all nodes of the body's elements.
BladeFront hold_front(const CutTopology& body, std::span<const Vec3d> x, const BladeSegment& blade, int levels);

/// The 2^levels + 1 points of the blade where it was.
std::vector<Vec3d> front_points(const BladeFront& front);

/// Where the 2^levels + 1 points of the blade are now: those in the material carried by it, the others where they were.
std::vector<Vec3d> carried_front(const BladeFront& front, const CutTopology& body, std::span<const Vec3d> x);

/// What is swept from a line of points to a blade, whose points have the same places.
std::vector<SweepTriangle> sweep_to(const std::vector<Vec3d>& from, const BladeSegment& to);

}  // namespace pliant
