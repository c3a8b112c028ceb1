// Where the components of a cut cell lie, and how its material is shared among them.
#pragma once
#include <array>
#include <cstdint>

#include "cutting/topology/cut_mesh.h"

namespace pliant {

/// The cells of one body. `cut`: the state of a cell; nullptr: none of its edges is cut.
class CutDivision {
 public:
  /// Both must outlive it.
  CutDivision(const CutMesh& mesh, const CutEdges& edges) : mesh_(mesh), edges_(edges) {}

  /// Returns the division of tetrahedron `tet` (of CutMesh::shape) of a cell. Points shared by cells have identical bits in
  /// each.
  [[nodiscard]] CutTet tet(std::int32_t cell, const CellCut* cut, int tet) const;
  [[nodiscard]] TetDivision of(std::int32_t cell, const CellCut& cut, int tet) const;
  /// Component that holds a point of the cell at rest [m]: that of the tetrahedron it lies in, or the nearest one.
  [[nodiscard]] int label_at(std::int32_t cell, const CellCut* cut, const Vec3d& x) const;
  /// The same by barycentric coordinates in one of its tetrahedra.
  [[nodiscard]] int label_in(std::int32_t cell, const CellCut* cut, int tet, const std::array<double, 4>& weight) const;

  /// Gives tetrahedra that now have several components the centre that they keep.
  void place_centres(CellCut& cut) const;
  /// Shares the material of a cell among its components.
  void share(std::int32_t cell, CellCut& cut) const;
  /// The parts of a divided component keep its material fraction, whatever crossings were found since: copies are deformed
  /// differently, so moving material between them would lose or gain energy and momentum.
  void inherit(const CellCut& before, CellCut& cut) const;

 private:
  [[nodiscard]] DivisionPoints points(const CellCut& cut, int tet) const;

  const CutMesh& mesh_;
  const CutEdges& edges_;
};

}  // namespace pliant
