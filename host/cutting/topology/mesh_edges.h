// The edges of a body, to see which are stretched too far.
#pragma once
#include <span>
#include <vector>

#include "cutting/topology/cut_topology.h"

namespace pliant {

/// Whole tissue, none of whose corners belongs to a cell with a cut edge, parts at this many times the limit: it hangs by no
/// thread, and a soft organ stretches far under its own weight before anything touches it.
inline constexpr double kWholeStretch = 4;

/// What a cut or tear has just freed takes a while to spring back: only what is stretched this many times further has not been
/// freed by it.
inline constexpr double kFreedStretch = 2;

class MeshEdges {
 public:
  explicit MeshEdges(const CutMesh& mesh);
  /// What is to be cut because it is longer than `times` its length at rest, in the middle of its edges: of a tetrahedron the
  /// long edge, of a lattice cell with one all that lead to the other side; four times as long where no cell at its ends has a
  /// cut edge; and where an edge of a divided cell's copy is twice as long, all edges of the cell at the copy's real corners:
  /// what hangs there comes off. `x` [m] are present positions of the nodes of `body`, which has this mesh. An edge with an end
  /// that is not finite is left alone.
  [[nodiscard]] CutEdges longer(const CutTopology& body, std::span<const Vec3d> x, double times) const;

 private:
  void part(const CutTopology& body, const NodePair& pair, CutEdges& out) const;
  void free_corners(const CutTopology& body, std::span<const Vec3d> x, double times, CutEdges& out) const;

  std::vector<NodePair> pairs_;  ///< edges of tetrahedra, edges of lattice cells without diagonals; ascending
  std::vector<double> squared_;  ///< length at rest [m^2]
};

}  // namespace pliant
