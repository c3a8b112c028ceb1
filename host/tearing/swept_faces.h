// What blades find in a body that parts along the faces of its elements: the elements as they hang together now, and between
// the middles of neighbours a line, which a blade that comes between the two crosses. The lines are those of the undeformed
// body, in which a sweep is followed (cutting/blade/blade_trace.h), so the faces that open do not depend on the deformation.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "cutting/blade/blade_trace.h"
#include "tearing/torn_body.h"

namespace pliant {

class SweptFaces {
 public:
  /// `body` must outlive it.
  explicit SweptFaces(const TornBody& body);

  /// Call after body.tear() or part(): takes its nodes.
  void follow();
  /// The elements, with the nodes of body.solid(); none is divided.
  [[nodiscard]] const CutTopology& topology() const { return *topology_; }
  /// Mean edge of an undeformed element [m].
  [[nodiscard]] double edge() const { return edge_; }
  /// A sweep over the body with its nodes at `x` [m], which must outlive it. It crosses pairs of elements. The next call ends
  /// it.
  [[nodiscard]] BladeSweep sweep(std::span<const Vec3d> x);
  /// Pairs of elements that triangles [m] come between now (crossed_edges).
  [[nodiscard]] CutEdges crossed(std::span<const Vec3d> x, std::span<const SweepTriangle> triangles);
  /// Removes pairs whose common face is broken, or waits.
  void keep_joined(CutEdges& pairs) const;
  /// The common faces of these pairs.
  [[nodiscard]] std::vector<TetFace> faces(const CutEdges& pairs) const;

 private:
  [[nodiscard]] TetFace face_between(const NodePair& pair) const;
  void place_middles(std::span<const Vec3d> x);
  void measure_gaps(std::span<const Vec3d> x);

  const TornBody& body_;
  std::unique_ptr<CutTopology> middles_;  ///< a cell per element, whose edges lead from its middle to those of its neighbours
  std::unique_ptr<RestEdges> lines_;
  std::unique_ptr<CutTopology> topology_;
  std::vector<Vec3d> now_;   ///< the middles of the last sweep [m]
  std::vector<double> gap_;  ///< of each node, see SweptPairs [m]
  double edge_ = 0;
};

}  // namespace pliant
