// From where things are now to where the material there was at rest: a blade's path is followed in the body at rest, where what
// it has swept does not move any more.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "cutting/topology/cut_topology.h"
#include "geometry/spatial_hash.h"
#include "geometry/vec.h"

namespace pliant {

/// A point carried by a body: inside one of its tetrahedra, or next to it.
struct MaterialPoint {
  std::int32_t cell = -1, tet = 0;  ///< of the uncut body; -1: no material is near
  std::array<double, 4> weight{};   ///< barycentric; negative ones outside
  Vec3d rest{};                     ///< [m]
};

/// Where the material that carries a point is now. `x` [m]: present positions of all nodes of the body's elements.
Vec3d present_position(const CutTopology& body, std::span<const Vec3d> x, const MaterialPoint& point);

/// Looks for the material at points. Inside the body a point goes with the tetrahedron around it. Outside, up to `reach` away,
/// with the nearest one, whose affine map is continued by at most three edges. In the gap of a cut it goes with the face of the
/// cut that is nearest, so that both sides of a gap lead to the same place at rest.
class InverseMap {
 public:
  /// `edge` [m]: mean edge of a cell at rest. Only points in `region` can be found.
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
  vec::Box all_;                       ///< that holds all of them
  std::vector<std::int32_t> hits_;
  std::vector<std::pair<double, std::int32_t>> near_;
};

}  // namespace pliant
