// The Model: everything that does not change during a run, in double precision. Nodes are numbered by slot, the index into
// the node buffers: first the bricks of the lattices (256 slots each, many without a node), then one empty brick, then the
// other nodes ordered so that neighbours are close, padded to a multiple of 16, then the nodes of shape matching.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/texture.h"
#include "model/contact/contact.h"
#include "model/elements/batches.h"
#include "model/elements/element_materials.h"
#include "model/links/links.h"
#include "model/matching/partition.h"
#include "scene/scene.h"

namespace pliant {

/// The embedded surface of all bodies, for pressure and rendering.
struct ModelSurface {
  std::vector<Vec3d> rest;                         ///< [m]
  std::vector<std::array<std::int32_t, 8>> nodes;  ///< slots; unused corners repeat the first one with weight 0
  std::vector<std::array<double, 8>> weights;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> triangle_body;
  std::vector<char> triangle_cut;  ///< whether it lies on a cut; empty: no cuts
};

/// The entries of a surface that an edit changed, ascending.
struct SurfaceChanges {
  std::vector<std::int32_t> vertices;    ///< new, or with changed undeformed position or weights
  std::vector<std::int32_t> reembedded;  ///< these, and those whose nodes may have changed
  std::vector<std::int32_t> triangles;   ///< new, or with changed corners
};

/// Nodes created by a cut: each belongs to the far side of elements whose material belongs to other nodes, its anchors.
struct VirtualNodes {
  std::int32_t first = -1;           ///< nodes from here on are virtual; -1: none
  std::vector<std::int32_t> offset;  ///< [virtual nodes + 1] into `anchor`
  std::vector<std::int32_t> anchor;  ///< real nodes of the elements at each virtual node, ascending
};

/// A node that decomposition made on an edge, or a copy of it. It is held or moved if both ends are, and forces stay with the
/// ends.
struct EdgeNode {
  std::int32_t node = 0;
  std::array<std::int32_t, 2> ends{};  ///< nodes of the whole body
};

struct ModelBody {
  std::string name;
  ElementKind element{};
  ElementMaterials materials;
  std::vector<std::int32_t> slot;                  ///< slot of each node, in the order of the mesh or lattice
  std::vector<Vec3d> rest;                         ///< [m]
  std::vector<std::array<std::int32_t, 4>> tets;   ///< indices of the body's nodes, for output
  std::vector<std::array<std::int32_t, 8>> hexes;  ///< indices of the body's nodes in VTK order, for output
  std::int32_t first_vertex = 0, vertices = 0;     ///< its part of the surface
  std::int32_t first_triangle = 0, triangles = 0;
  VirtualNodes virtual_nodes;
  std::vector<EdgeNode> edge_nodes;    ///< ascending
  bool remade = false;                 ///< blades have divided or removed elements
  std::vector<Vec3d> triangle_middle;  ///< for a cut surface: centroid of the uncut triangle that contains each, NaN on a cut
  std::shared_ptr<const SurfaceTexture> texture;  ///< of the uncut surface; null: its file has no texture coordinates
  std::vector<std::int32_t>
      triangle_source;  ///< with a texture: the uncut triangle that contains each, -1: none; empty: itself
  double spacing = 0;   ///< cell size of its lattice [m]; 0 for a volume mesh
  std::int64_t operational_nodes = 0, matching_nodes = 0, interface_nodes = 0;
  std::int64_t operational_elements = 0;  ///< number of finite elements among elements()
  double mass = 0;                        ///< [kg]
  double added_mass = 0;                  ///< inertia without weight, in addition to mass [kg]
  double volume = 0;                      ///< of the elements, including fill [m^3]
  double surface_volume = 0;              ///< volume inside the input surface [m^3]
  [[nodiscard]] std::int64_t elements() const { return static_cast<std::int64_t>(tets.size() + hexes.size()); }
};

/// A prescribed or fixed node.
struct Constraint {
  std::int32_t slot = 0;
  std::int32_t axes = 0;    ///< bit mask of x, y, z
  std::int32_t turned = 0;  ///< subset of axes that a rotation prescribes
  std::array<std::int32_t, 3>
      curve{};     ///< per component; for a rotation that of cosine minus one, followed by that of the sine
  Vec3d target{};  ///< [m]; for a rotated component Circle::cosine
  Vec3d sine{};    ///< [m]; for a rotated component Circle::sine
  /// Returns true if all three components are fixed.
  [[nodiscard]] bool holds() const { return axes == 7 && target == Vec3d{} && sine == Vec3d{}; }
};

/// A force on a node with a curve.
struct NodeForce {
  std::int32_t slot = 0;
  Vec3d force{};  ///< [N]
  std::int32_t curve = 0;
  bool reserved = false;  ///< placeholder for Simulation::set_forces
};

struct TrianglePressure {
  std::int32_t triangle = 0;
  double pressure = 0;  ///< [Pa]
  std::int32_t curve = 0;
};

/// Inertia added to a node's mass [kg].
struct NodeInertia {
  std::int32_t slot = 0;
  double inertia = 0;
};

/// Added inertia, and Model::mass and Model::added without it.
struct Ballast : NodeInertia {
  double mass = 0, added = 0;
};

struct Model {
  std::vector<ModelBody> bodies;
  bool recovers = false;                     ///< Inverted::recover
  std::int32_t bricks = 0;                   ///< number without the empty one; 0 if there are none
  std::vector<std::int32_t> brick_neighbor;  ///< [bricks + 1][16]
  std::vector<std::int32_t> brick_rows;      ///< [bricks + 1][2] rows with cells, rows with nodes (layout.h)
  std::vector<double> brick_fill;            ///< [bricks + 1][256]
  std::vector<std::int64_t> brick_cell;      ///< [bricks][256] index of the cell in its body, -1: none
  std::vector<std::int32_t> brick_body;      ///< [bricks]
  std::int32_t list_base = 0;                ///< first slot after the bricks
  std::int32_t list_end = 0;          ///< first slot after the nodes of list elements, a multiple of 16; shape matching follows
  std::int32_t slots = 0;             ///< all slots, a multiple of 16
  std::vector<Vec3d> rest;            ///< [slots]
  std::vector<double> mass;           ///< [slots] lumped mass including added inertia [kg]; 0: no node
  std::vector<double> added;          ///< [slots] part of `mass` that has no weight (Scene::least_fill, ballast); empty: none
  std::vector<Ballast> ballast;       ///< included in `mass` and `added` (ballast.h), ascending slots
  std::vector<double> damping;        ///< [slots] c [1/s]
  std::vector<Vec3d> velocity;        ///< [slots] initial [m/s]
  std::vector<Vec3d> displacement;    ///< [slots] initial [m]; empty: none
  std::vector<ElementBatch> batches;  ///< elements outside the bricks
  std::vector<BrickBatch> brick_batches;
  std::vector<FlsmBatch> flsm;
  Links links;  ///< springs between nodes and other points; empty: none
  ModelSurface surface;
  std::vector<Curve> curves;
  std::int32_t gravity_curve = 0;                ///< curve of gravity; 0: constant
  std::vector<Constraint> constraints;           ///< one per constrained node, ascending slots
  std::vector<NodeForce> forces;                 ///< ascending slots
  std::vector<TrianglePressure> pressures;       ///< ascending triangles
  std::shared_ptr<const ToolForms> tools;        ///< shapes of Scene::tools; null: no tools
  std::shared_ptr<const ContactPoints> contact;  ///< null without contact
  std::optional<TissueContact> tissue_contact;   ///< set if tissue contact is enabled
  std::vector<ContactLaw> contact_laws;          ///< one per tool
  double element_bound = 0;                      ///< 2 / max element frequency [s], safe for small strain
  std::string bound_element;                     ///< the element that determines it
  double network_bound = 0;                      ///< the same of networks of springs alone, safe however they deform; 0: none
  double shortest = 0;                           ///< cube root of the smallest element's volume [m]
  double least_fill = 0;                         ///< minimum fill of a cell, as a fraction of a full cell's mass
  /// Mass without added inertia [kg].
  [[nodiscard]] double own_mass(std::size_t slot) const { return mass[slot] - (added.empty() ? 0 : added[slot]); }
  [[nodiscard]] std::int64_t nodes() const;  ///< without unused slots
  [[nodiscard]] std::int64_t elements() const;
};

/// Loads the meshes of a scene, divides them into elements, numbers them and computes the element data. Throws Error for bad
/// input (an empty selection, an inverted element, ...).
Model build_model(const Scene& scene);

}  // namespace pliant
