// One body cut into elements, before it gets its place among the slots of the Model.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "lattice/lattice.h"
#include "model/matching/partition.h"
#include "model/model.h"

namespace pliant {

/// The order in which a sweep over the elements meets the nodes (Cuthill-McKee), and the number of elements at each node.
struct NodeOrder {
  std::vector<std::int32_t> order, valence;
};

/// Everything but the surface.
struct BodyElements {
  std::vector<Vec3d> nodes;                        ///< rest positions [m]
  std::vector<std::array<std::int32_t, 4>> tets;   ///< positive volume
  std::vector<std::array<std::int32_t, 8>> hexes;  ///< corners in bit order (x, y, z)
  std::vector<double> fill;                        ///< per element
  std::vector<LatticeNode> lattice_nodes;          ///< one per node if the body is a lattice, else empty
  std::vector<Cell> cells;                         ///< one per hexahedron if the body is a lattice of hexahedra, else empty
  std::shared_ptr<const Lattice> lattice;          ///< uncut, if the body is one
  Partition partition;                             ///< of the lattice's cells, if body.model is not tled
  std::vector<std::uint64_t> samples;              ///< per cell of a lattice: Cell::samples
  std::vector<std::int32_t> copy_of;  ///< if the body is cut: per element (six tetrahedra of a lattice: one) its uncut cell
  VirtualNodes virtual_nodes;
  std::vector<Cell> matching_cells;              ///< the cells left to shape matching
  double spacing = 0;                            ///< [m]
  std::shared_ptr<const NodeOrder> uncut_order;  ///< of the uncut body, if it was found already; the body may be cut
  [[nodiscard]] std::size_t size() const { return tets.size() + hexes.size(); }
  [[nodiscard]] std::span<const std::int32_t> corners(std::size_t e) const {
    return tets.empty() ? std::span<const std::int32_t>(hexes[e]) : tets[e];
  }
  /// Whether element e is a finite element.
  [[nodiscard]] bool operational(std::size_t e) const {
    return partition.operational.empty() || partition.operational[tets.empty() ? e : e / 6] != 0;
  }
  /// Whether shape matching alone moves node n.
  [[nodiscard]] bool matching(std::size_t n) const {
    return !partition.kind.empty() && partition.kind[n] == NodeKind::matching;
  }
};

struct BodySurface {
  std::vector<Vec3d> surface;  ///< vertices [m]
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 8>> surface_nodes;
  std::vector<std::array<double, 8>> surface_weights;
  std::vector<std::int32_t> surface_cell;  ///< the lattice cell in which each vertex is embedded; empty for a volume mesh
  double surface_volume = 0;               ///< uncut [m^3]
  std::vector<char> triangle_cut;          ///< if the body is cut: whether the triangle lies on a cut
  std::vector<Vec3d> triangle_middle;      ///< ModelBody::triangle_middle
  bool wants_middles = true;               ///< whether a cut keeps triangle_middle: pressures need it
  std::optional<SurfaceChanges> changes;   ///< by the last edit; nothing: not known
};

struct BodyMesh : BodyElements, BodySurface {};

/// Load the body's mesh and fill it.
BodyMesh make_body_mesh(const Body& body);
std::vector<BodyMesh> make_body_meshes(const Scene& scene);

/// Choose the operational cells of a lattice anew, as body.model says now.
void repartition(const Body& body, BodyElements& solid);

/// Like build_model(scene), for bodies that are loaded and filled already; their partition is chosen anew.
Model build_model(const Scene& scene, std::span<const BodyMesh* const> solids);
Model build_model(const Scene& scene, const std::vector<BodyMesh>& solids);

/// The first part of it: no surfaces and no boundary conditions, and no look at the BodySurface of a body, which may be made
/// meanwhile. `previous`, a model of the same bodies before an edit, lends what did not change.
Model build_elements(const Scene& scene, std::span<const BodyMesh* const> solids, const Model* previous = nullptr);
/// The next one. With `changes`, the model has the surface from before an edit of its only body already, and only these differ.
void add_surfaces(std::span<const BodyMesh* const> solids, Model& model, const SurfaceChanges* changes = nullptr);

/// The corners of a lattice cell from its six tetrahedra (kKuhnTets), which follow each other.
std::array<std::int32_t, 8> cell_corners(const std::array<std::int32_t, 4>* tets);

/// All nodes in Cuthill-McKee order: breadth first over the elements from a node at the far end of each connected part.
std::vector<std::int32_t> sweep_order(const BodyElements& solid);
NodeOrder node_order(const BodyElements& solid);

}  // namespace pliant
