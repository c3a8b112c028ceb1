// Maps current positions to rest positions of the material there, because a blade's path is followed in the undeformed body.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "cutting/topology/cut_topology.h"
#include "geometry/spatial_hash.h"
#include "geometry/vec.h"

namespace pliant {

/// A point carried by a body: inside one of its tetrahedra, or near it.
struct MaterialPoint {
  std::int32_t cell = -1, tet = 0;  ///< of the uncut body; -1: no material nearby
  std::array<double, 4> weight{};   ///< barycentric; negative ones outside
  Vec3d rest{};                     ///< [m]
};

/// Returns the current position of a carried point. `x` [m]: current positions of all nodes of the body's elements.
Vec3d present_position(const CutTopology& body, std::span<const Vec3d> x, const MaterialPoint& point);

/// Searches the material at points. Inside the body a point belongs to the surrounding tetrahedron; outside, up to `reach`
/// away, to the nearest one, whose affine map is extended by at most three edges. In the gap of a cut it belongs to the
/// nearest face of the cut, so that both sides of the gap map to the same rest position.
class InverseMap {
 public:
  /// `edge` [m]: mean undeformed edge of a cell. Only points in `region` can be found.
  InverseMap(const CutTopology& body, std::span<const Vec3d> x, const vec::Box& region, double edge, double reach);
  [[nodiscard]] MaterialPoint find(const Vec3d& p);

 private:
  struct Best {
    double distance2;
    MaterialPoint point;
  };
  class OwnPart;
  [[nodiscard]] bool inside(std::int32_t element, const Vec3d& p, MaterialPoint& out) const;
  void nearest(std::int32_t element, const Vec3d& p, Best& best) const;
  [[nodiscard]] std::array<Vec3d, 4> corners(std::int32_t element, int tet) const;
  [[nodiscard]] std::array<Vec3d, 4> rest_corners(std::int32_t cell, int tet) const;
  [[nodiscard]] bool to_own_part(std::int32_t element, int tet, const OwnPart& part, std::array<double, 4>& weight) const;

  const CutTopology& body_;
  std::span<const Vec3d> x_;
  double edge_, reach_;
  SpatialHash hash_;
  std::vector<std::int32_t> element_;  ///< items of the hash
  vec::Box all_;                       ///< bounding box of all of them
  std::vector<std::int32_t> hits_;
  std::vector<std::pair<double, std::int32_t>> near_;
};

}  // namespace pliant
