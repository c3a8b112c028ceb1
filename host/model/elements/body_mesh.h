// One body divided into elements, before its nodes get slots in the Model.
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

/// The node order of a sweep over the elements (Cuthill-McKee), and the number of elements at each node.
struct NodeOrder {
  std::vector<std::int32_t> order, valence;
};

struct BodyElements;

/// The elements of a body that an edit has divided or removed, by those of the whole body.
struct ElementParts {
  std::shared_ptr<const BodyElements> whole = nullptr;  ///< nullptr: the elements are those of the whole body, or its copies
  std::vector<std::int32_t> of = {};                    ///< [elements] the element of `whole` that it is, or is part of
  std::vector<std::int32_t> before = {};                ///< [elements] the same of the body before the last edit
};

/// A body without its surface.
struct BodyElements {
  std::vector<Vec3d> nodes;                        ///< undeformed positions [m]
  std::vector<std::array<std::int32_t, 4>> tets;   ///< positive volume
  std::vector<std::array<std::int32_t, 8>> hexes;  ///< corners in bit order (x, y, z)
  std::vector<double> fill;                        ///< per element
  std::vector<LatticeNode> lattice_nodes;          ///< one per node for a lattice, otherwise empty
  std::vector<Cell> cells;                         ///< one per hexahedron for a lattice of hexahedra, otherwise empty
  std::shared_ptr<const Lattice> lattice;          ///< the uncut lattice, if the body is one
  Partition partition;                             ///< of the lattice's cells, unless body.model is tled
  std::vector<std::uint64_t> samples;              ///< per cell of a lattice: Cell::samples
  std::vector<std::int32_t> copy_of;  ///< for a cut body: the uncut cell of each element (of each six tetrahedra of a lattice)
  ElementParts parts;
  VirtualNodes virtual_nodes;
  std::vector<EdgeNode> edge_nodes;  ///< ModelBody::edge_nodes
  std::size_t whole_nodes = 0;       ///< of a cut or torn body: its nodes before, which keep their numbers; 0: it is whole
  std::vector<Cell> matching_cells;  ///< the shape-matching cells
  double spacing = 0;                ///< [m]
  std::shared_ptr<const NodeOrder> uncut_order;  ///< order of the uncut body, if known; valid for the cut body
  [[nodiscard]] std::size_t size() const { return tets.size() + hexes.size(); }
  [[nodiscard]] std::span<const std::int32_t> corners(std::size_t e) const {
    return tets.empty() ? std::span<const std::int32_t>(hexes[e]) : tets[e];
  }
  /// Returns true if element e is a finite element.
  [[nodiscard]] bool operational(std::size_t e) const {
    return partition.operational.empty() || partition.operational[tets.empty() ? e : e / 6] != 0;
  }
  /// Returns true if only shape matching moves node n.
  [[nodiscard]] bool matching(std::size_t n) const {
    return !partition.kind.empty() && partition.kind[n] == NodeKind::matching;
  }
};

struct BodySurface {
  std::vector<Vec3d> surface;  ///< vertices [m]
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 8>> surface_nodes;
  std::vector<std::array<double, 8>> surface_weights;
  std::vector<std::int32_t> surface_cell;         ///< lattice cell that contains each vertex; empty for a volume mesh
  double surface_volume = 0;                      ///< volume before cuts [m^3]
  std::vector<char> triangle_cut;                 ///< for a cut body: whether the triangle lies on a cut
  std::vector<Vec3d> triangle_middle;             ///< ModelBody::triangle_middle
  bool wants_middles = true;                      ///< whether cuts update triangle_middle, which pressures need
  std::shared_ptr<const SurfaceTexture> texture;  ///< ModelBody::texture
  std::vector<std::int32_t> triangle_source;      ///< ModelBody::triangle_source
  std::optional<SurfaceChanges> changes;          ///< of the last edit; empty: unknown
};

struct BodyMesh : BodyElements, BodySurface {};

/// Loads the body's mesh and divides it into elements.
BodyMesh make_body_mesh(const Body& body);
std::vector<BodyMesh> make_body_meshes(const Scene& scene);

/// Gives a body without a surface that of its triangles, whose corners are nodes: the vertices are the nodes they use.
void surface_on_nodes(BodyMesh& solid);

/// Repeats the choice of the lattice's operational cells, for the current body.model.
void repartition(const Body& body, BodyElements& solid);

/// As build_model(scene), for bodies that are already divided into elements; their partitions are chosen again.
Model build_model(const Scene& scene, std::span<const BodyMesh* const> solids);
Model build_model(const Scene& scene, const std::vector<BodyMesh>& solids);

/// First part of build_model: without surfaces and boundary conditions. It does not read the BodySurface of a body, which may
/// be computed concurrently. `previous`: a model of the same bodies before an edit, whose unchanged parts are reused.
Model build_elements(const Scene& scene, std::span<const BodyMesh* const> solids, const Model* previous = nullptr);
/// Second part. With `changes`, the model contains the surface of its only body before an edit, and only these entries
/// differ.
void add_surfaces(std::span<const BodyMesh* const> solids, Model& model, const SurfaceChanges* changes = nullptr);

/// Returns the corners of a lattice cell from its six consecutive tetrahedra (kKuhnTets).
std::array<std::int32_t, 8> cell_corners(const std::array<std::int32_t, 4>* tets);

/// Returns all nodes in Cuthill-McKee order: breadth first over the elements, from a peripheral node of each connected part.
std::vector<std::int32_t> sweep_order(const BodyElements& solid);
NodeOrder node_order(const BodyElements& solid);

}  // namespace pliant
