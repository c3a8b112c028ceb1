// Cutting of a moving body by a blade. The blade's path is mapped to the undeformed body: points of the blade, at most half
// an edge apart, are mapped to the rest position of the material there (inverse_map.h), and the mapped sweep is tested
// against the undeformed edges. The last line of the blade is stored in rest coordinates, and the next sweep begins with
// exactly these points. So successive sweeps join exactly, no bridge remains between them however the body deforms, and
// tissue that is pulled across a resting blade is cut too.
#pragma once
#include <span>
#include <vector>

#include "cutting/blade/blade.h"
#include "cutting/blade/inverse_map.h"
#include "cutting/blade/rest_edges.h"
#include "cutting/topology/cut_topology.h"

namespace pliant {

/// A point of a blade that is carried by the body.
struct TracePoint {
  std::int32_t place = 0;  ///< along the blade: place / 2^levels of the way from its first end
  std::int32_t node = -1;  ///< without material nearby: the real node that carries it, with the offset `carried.rest` [m]
  MaterialPoint carried{};
};

/// The last line of a blade.
struct BladeTrace {
  BladeSegment blade{};
  int levels = 0;
  std::vector<TracePoint> points;  ///< ascending places; other points did not move with material
};

inline constexpr int kMostLevels = 30;  ///< limit on the subdivision of a blade, which may be 2^29 edges long

/// Pairs of points of a body that a blade may come between: by default the ends of its edges.
struct SweptPairs {
  RestEdges& between;
  std::span<const Vec3d> rest, now;  ///< [points] at rest, and where they are [m]
  std::size_t carriers = 0;          ///< the nodes below this one keep their numbers when the body is cut
  /// Of each node how far others are that were the same node before faces opened, 0 where none was [m]; empty: nowhere. A sweep
  /// in such a gap crosses nothing.
  std::span<const double> gap = {};
  /// Where elements are divided along the cut, a point in its gap belongs to the nearest face of it, as with virtual nodes: not
  /// to material beyond that face, which the body does not have there.
  bool faces_end = false;
};

class BladeSweep {
 public:
  /// `x` [m]: current positions of all nodes of the body's elements. `edge` [m]: mean undeformed edge of a cell.
  BladeSweep(const CutTopology& body, std::span<const Vec3d> x, RestEdges& edges, double edge)
      : BladeSweep(body, x, SweptPairs{edges, body.mesh().rest, x, body.mesh().rest.size()}, edge) {}
  BladeSweep(const CutTopology& body, std::span<const Vec3d> x, const SweptPairs& pairs, double edge);

  /// Returns whether a blade in this box [m] is near enough to the body to be followed.
  [[nodiscard]] bool reaches(const vec::Box& box) const { return reach_.overlaps(box); }
  /// Sweeps from the stored line to the blade's next segment, which is then stored. Both move along straight lines in the
  /// current configuration.
  void move(BladeTrace& front, const BladeSegment& to);
  /// Sweeps from points that the body carries (at `from` now) to others, each along a straight line, and returns the material
  /// at the end of each. Neighbours in the list are neighbours along the blade; a point without material (cell -1) in `carried`
  /// begins where `from` says.
  std::vector<MaterialPoint> advance(std::span<const MaterialPoint> carried, std::span<const Vec3d> from,
                                     std::span<const Vec3d> until);
  /// Pairs crossed so far, without edges that are cut already. An edge crossed several times is cut at the first crossing.
  [[nodiscard]] const CutEdges& crossed() const { return crossed_; }

 private:
  struct Vertex {
    MaterialPoint carried{};
    Vec3d now{};
  };
  struct Row {
    int levels = 0;
    std::int64_t first = 0;  ///< place of the first vertex
    std::vector<Vertex> vertices;
    [[nodiscard]] const Vertex* at(std::int64_t place) const {
      const bool known = place >= first && place < first + static_cast<std::int64_t>(vertices.size());
      return known && vertices[static_cast<std::size_t>(place - first)].carried.cell >= 0
                 ? &vertices[static_cast<std::size_t>(place - first)]
                 : nullptr;
    }
  };
  [[nodiscard]] Row stored(const BladeTrace& front) const;
  void strip(const Row& a, const Row& b);
  [[nodiscard]] bool in_gap(const Vertex& v) const;
  void triangle(const Vertex* a, const Vertex* b, const Vertex* c);
  [[nodiscard]] std::array<std::int64_t, 2> range(const BladeTrace& front, const BladeSegment& to, int levels) const;
  [[nodiscard]] Vertex vertex(const Vec3d& p, InverseMap& map) const;
  void end_at_face(Vertex& v) const;
  [[nodiscard]] Row mapped(int levels, std::int64_t first, const std::vector<Vec3d>& points, InverseMap& map) const;
  void keep(BladeTrace& front, const Row& last) const;
  [[nodiscard]] std::int32_t nearest_node(const Vec3d& p) const;

  const CutTopology& body_;
  std::span<const Vec3d> x_;
  SweptPairs pairs_;
  double edge_;
  vec::Box reach_;
  CutEdges crossed_;
};

}  // namespace pliant
