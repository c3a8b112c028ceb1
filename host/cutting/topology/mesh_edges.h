// All edges of a body, to see which are stretched too far.
#pragma once
#include <span>
#include <vector>

#include "cutting/topology/cut_topology.h"

namespace pliant {

class MeshEdges {
 public:
  explicit MeshEdges(const CutMesh& mesh);
  /// What is to be cut because it is longer than `times` its length at rest, each edge in its middle: edges that are not cut,
  /// and where an edge of a divided cell's copy is four times as long as that, all edges at the copy's real corners: what hangs
  /// there comes off. `x` [m] are present positions of the nodes of `body`, which has this mesh. One with an end that is not
  /// finite is left alone.
  [[nodiscard]] CutEdges longer(const CutTopology& body, std::span<const Vec3d> x, double times) const;

 private:
  void free_corners(const CutTopology& body, std::span<const Vec3d> x, double times, CutEdges& out) const;

  std::vector<NodePair> pairs_;           ///< ascending
  std::vector<double> squared_;           ///< length at rest [m^2]
  std::vector<std::int32_t> first_, at_;  ///< [nodes + 1] and the pairs at each node
};

}  // namespace pliant
