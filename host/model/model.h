// The Model: everything that does not change while a scene runs, in double precision. Nodes are numbered by slot, the index
// that the node buffers use: first the bricks of the lattices (256 slots each, many without a node), then one empty brick, then
// the nodes of all other bodies in an order that keeps neighbours close, padded to a multiple of 16, then those of shape
// matching.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "model/contact/contact.h"
#include "model/elements/batches.h"
#include "model/elements/element_materials.h"
#include "model/matching/partition.h"
#include "scene/scene.h"

namespace pliant {

/// The embedded surface of all bodies, for pressure and rendering.
struct ModelSurface {
  std::vector<Vec3d> rest;                         ///< [m]
  std::vector<std::array<std::int32_t, 8>> nodes;  ///< slots; unused corners repeat the first with weight 0
  std::vector<std::array<double, 8>> weights;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> triangle_body;
  std::vector<char> triangle_cut;  ///< whether it is a face that a blade made; empty: none
};

/// What an edit changed of a surface, ascending.
struct SurfaceChanges {
  std::vector<std::int32_t> vertices;    ///< that are new or have another place at rest or other weights
  std::vector<std::int32_t> reembedded;  ///< these, and those that may have other nodes
  std::vector<std::int32_t> triangles;   ///< that are new or have other corners
};

/// Nodes that a cut made: each holds the far side of elements whose material belongs to other nodes, its anchors.
struct VirtualNodes {
  std::int32_t first = -1;           ///< nodes from here on are virtual; -1: none is
  std::vector<std::int32_t> offset;  ///< [virtual nodes + 1] into `anchor`
  std::vector<std::int32_t> anchor;  ///< real nodes of the elements at each virtual node, ascending
};

struct ModelBody {
  std::string name;
  ElementKind element = ElementKind::hex8;
  ElementMaterials materials;
  std::vector<std::int32_t> slot;                  ///< slot of each node of the body, in the order of its mesh or lattice
  std::vector<Vec3d> rest;                         ///< [m]
  std::vector<std::array<std::int32_t, 4>> tets;   ///< body-local nodes, for output
  std::vector<std::array<std::int32_t, 8>> hexes;  ///< body-local nodes in VTK order, for output
  std::int32_t first_vertex = 0, vertices = 0;     ///< its part of the surface
  std::int32_t first_triangle = 0, triangles = 0;
  VirtualNodes virtual_nodes;
  std::vector<Vec3d>
      triangle_middle;  ///< if the surface is cut: centroid of the uncut triangle that each is part of, NaN on a cut
  double spacing = 0;   ///< of its lattice [m], 0 for a volume mesh
  std::int64_t operational_nodes = 0, matching_nodes = 0, interface_nodes = 0;
  std::int64_t operational_elements = 0;  ///< of elements(): those that are finite elements
  double mass = 0;                        ///< [kg]
  double added_mass = 0;                  ///< inertia without weight beside it [kg]
  double volume = 0;                      ///< of the elements, fill counted [m^3]
  double surface_volume = 0;              ///< enclosed by the input surface [m^3]
  [[nodiscard]] std::int64_t elements() const { return static_cast<std::int64_t>(tets.size() + hexes.size()); }
};

/// One prescribed (or fixed) node.
struct Constraint {
  std::int32_t slot = 0;
  std::int32_t axes = 0;                ///< bit mask of x, y, z
  std::int32_t turned = 0;              ///< of these, those that a rotation moves
  std::array<std::int32_t, 3> curve{};  ///< per component; of a turned one that of its cosine less one, its sine comes next
  Vec3d target{};                       ///< [m]; of a turned component Circle::cosine
  Vec3d sine{};                         ///< [m]; of a turned component Circle::sine
  /// Whether the node stays where it is in all three components.
  [[nodiscard]] bool holds() const { return axes == 7 && target == Vec3d{} && sine == Vec3d{}; }
};

/// A force on a node that follows a curve.
struct NodeForce {
  std::int32_t slot = 0;
  Vec3d force{};  ///< [N]
  std::int32_t curve = 0;
  bool reserved = false;  ///< for what Simulation::set_forces puts there
};

struct TrianglePressure {
  std::int32_t triangle = 0;
  double pressure = 0;  ///< [Pa]
  std::int32_t curve = 0;
};

/// Inertia of a node beside its mass [kg].
struct NodeInertia {
  std::int32_t slot = 0;
  double inertia = 0;
};

/// Such inertia, and what Model::mass and added were without it.
struct Ballast : NodeInertia {
  double mass = 0, added = 0;
};

struct Model {
  std::vector<ModelBody> bodies;
  bool recovers = false;                     ///< Inverted::recover
  std::int32_t bricks = 0;                   ///< without the empty one; 0 if there is none at all
  std::vector<std::int32_t> brick_neighbor;  ///< [bricks + 1][16]
  std::vector<std::int32_t> brick_rows;      ///< [bricks + 1][2] rows with a cell, rows with a node (layout.h)
  std::vector<double> brick_fill;            ///< [bricks + 1][256]
  std::vector<std::int64_t> brick_cell;      ///< [bricks][256] number of the cell in its body, -1: none
  std::vector<std::int32_t> brick_body;      ///< [bricks]
  std::int32_t list_base = 0;                ///< first slot after the bricks
  std::int32_t list_end = 0;  ///< first slot after the nodes of list elements, a multiple of 16; then shape matching
  std::int32_t slots = 0;     ///< all slots, a multiple of 16
  std::vector<Vec3d> rest;    ///< [slots]
  std::vector<double> mass;   ///< [slots] lumped [kg], what accelerates; 0: no node
  std::vector<double>
      added;  ///< [slots] share of `mass` that is inertia without weight (Scene::least_fill, ballast); empty: none
  std::vector<Ballast> ballast;       ///< counted in `mass` and `added` (ballast.h), ascending slots
  std::vector<double> damping;        ///< [slots] c [1/s]
  std::vector<Vec3d> velocity;        ///< [slots] initial [m/s]
  std::vector<Vec3d> displacement;    ///< [slots] initial [m]; empty: none
  std::vector<ElementBatch> batches;  ///< of elements outside the bricks
  std::vector<BrickBatch> brick_batches;
  std::vector<FlsmBatch> flsm;
  ModelSurface surface;
  std::vector<Curve> curves;
  std::int32_t gravity_curve = 0;                ///< of gravity; 0: constant
  std::vector<Constraint> constraints;           ///< one per constrained node, ascending slots
  std::vector<NodeForce> forces;                 ///< ascending slots
  std::vector<TrianglePressure> pressures;       ///< ascending triangles
  std::shared_ptr<const ToolForms> tools;        ///< shapes of Scene::tools; null: it has none
  std::shared_ptr<const ContactPoints> contact;  ///< of the surfaces; null where nothing touches anything
  std::optional<TissueContact> tissue_contact;   ///< whether bodies touch each other and themselves
  std::vector<ContactLaw> contact_laws;          ///< one per tool
  double element_bound = 0;                      ///< 2 / max element frequency [s], safe for small strain
  std::string bound_element;                     ///< the element that gives it
  double shortest = 0;                           ///< cube root of the smallest element's volume [m]
  double least_fill = 0;                         ///< of a cell, as a share of a full one's mass
  /// Mass without added inertia [kg].
  [[nodiscard]] double own_mass(std::size_t slot) const { return mass[slot] - (added.empty() ? 0 : added[slot]); }
  [[nodiscard]] std::int64_t nodes() const;  ///< real nodes
  [[nodiscard]] std::int64_t elements() const;
};

/// Load the meshes of a scene, fill them, number, and precompute. Throws Error for bad input (no node in a boundary set, an
/// inverted element, ...).
Model build_model(const Scene& scene);

}  // namespace pliant
