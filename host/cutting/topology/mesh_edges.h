// Finds overstretched edges of a body.
#pragma once
#include <span>
#include <vector>

#include "cutting/topology/cut_topology.h"

namespace pliant {

/// Factor on the limit for tissue away from cuts (no corner belongs to a cell with a cut edge). Such tissue is not a thin
/// remain of a cut, and a soft organ stretches far under its own weight without any contact.
inline constexpr double kWholeStretch = 4;

/// Further factor: tissue just freed by a cut or tear takes some time to spring back, so only edges stretched by this much
/// more count.
inline constexpr double kFreedStretch = 2;

class MeshEdges {
 public:
  explicit MeshEdges(const CutMesh& mesh);
  /// Returns the edges to cut, in their middle, because an edge is longer than `times` its undeformed length: for a
  /// tetrahedron the long edge, for a lattice cell all edges to the other side; with four times the limit if no cell at its
  /// ends has a cut edge. If an edge of a divided cell's copy is twice as long as the limit, all edges of the cell at the
  /// copy's real corners are cut, which separates it. `x` [m]: current positions of the nodes of `body`, which has this mesh.
  /// Edges with a non-finite end are skipped.
  [[nodiscard]] CutEdges longer(const CutTopology& body, std::span<const Vec3d> x, double times) const;

 private:
  void part(const CutTopology& body, const NodePair& pair, CutEdges& out) const;
  void free_corners(const CutTopology& body, std::span<const Vec3d> x, double times, CutEdges& out) const;

  std::vector<NodePair> pairs_;  ///< edges of tetrahedra, edges of lattice cells without diagonals; ascending
  std::vector<double> squared_;  ///< length at rest [m^2]
};

}  // namespace pliant
