// How a blade cuts a body that moves. Its path is followed at rest: points of the blade, at most half an edge apart, are mapped
// to where the material at that place was at rest (inverse_map.h), and what they sweep there is tested against edges that never
// move. The line where the blade stood last is kept at rest; the next sweep begins with these very points. So successive sweeps
// join exactly, no bridge is left between them however the body deforms, and tissue that is pulled across a resting blade is
// cut, too.
#pragma once
#include <span>
#include <vector>

#include "cutting/blade/blade.h"
#include "cutting/blade/inverse_map.h"
#include "cutting/blade/rest_edges.h"
#include "cutting/topology/cut_topology.h"

namespace pliant {

/// A point of a blade that goes with the body.
struct TracePoint {
  std::int32_t place = 0;  ///< along the blade: place / 2^levels of the way from its first end
  std::int32_t node = -1;  ///< with no material near: the real node that it goes with, `carried.rest` being the offset [m]
  MaterialPoint carried{};
};

/// Where a blade stood last.
struct BladeTrace {
  BladeSegment blade{};
  int levels = 0;
  std::vector<TracePoint> points;  ///< ascending places; the others are where they were
};

inline constexpr int kMostLevels = 30;  ///< of a blade: it may be 2^29 edges long

class BladeSweep {
 public:
  /// `x` [m]: present positions of all nodes of the body's elements. `edge` [m]: mean edge of a cell at rest.
  BladeSweep(const CutTopology& body, std::span<const Vec3d> x, RestEdges& edges, double edge);

  /// Whether a blade in this box [m] comes so near the body that it has to be followed.
  [[nodiscard]] bool reaches(const vec::Box& box) const { return reach_.overlaps(box); }
  /// Sweep from the front to the blade's next place, which becomes the front. Both along straight lines as seen now.
  void move(BladeTrace& front, const BladeSegment& to);
  /// Edges crossed so far that are not cut yet. An edge crossed several times is cut where it was crossed first.
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
  void triangle(const Vertex* a, const Vertex* b, const Vertex* c);
  [[nodiscard]] std::array<std::int64_t, 2> range(const BladeTrace& front, const BladeSegment& to, int levels) const;
  [[nodiscard]] Vertex vertex(const Vec3d& p, InverseMap& map) const;
  [[nodiscard]] Row mapped(int levels, std::int64_t first, const std::vector<Vec3d>& points, InverseMap& map) const;
  void keep(BladeTrace& front, const Row& last) const;
  [[nodiscard]] std::int32_t nearest_node(const Vec3d& p) const;

  const CutTopology& body_;
  std::span<const Vec3d> x_;
  RestEdges& edges_;
  double edge_;
  vec::Box reach_;
  CutEdges crossed_;
};

}  // namespace pliant
