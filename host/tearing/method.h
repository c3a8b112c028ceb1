// Methods that Pliant's cutting is compared with (docs/references.md): removal of the crossed elements, decomposition of them
// into smaller tetrahedra, and separation along existing faces. Each works on plain elements and makes a new mesh; the surface
// of such a mesh is the boundary of its elements. docs/cutting.md compares them.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cutting/blade/blade.h"
#include "cutting/topology/cut_cell.h"
#include "model/elements/body_mesh.h"
#include "tearing/breaking.h"

namespace pliant {

/// A body as plain elements: tetrahedra, or hexahedra with their corners in bit order.
struct ElementMesh {
  std::vector<Vec3d> nodes;  ///< rest [m]
  std::vector<std::array<std::int32_t, 4>> tets;
  std::vector<std::array<std::int32_t, 8>> hexes;
  std::vector<double> fill;  ///< per element: material over its volume
};

ElementMesh plain_mesh(const BodyMesh& solid);
/// Every hexahedron as its six Kuhn tetrahedra, in order; a mesh of tetrahedra as it is.
ElementMesh kuhn_tetrahedra(const ElementMesh& mesh);
/// The elements as a body ready for build_model(scene, solids), its surface their boundary. Nodes without an element are left
/// out.
BodyMesh solid_of(const ElementMesh& mesh);

/// Boundary triangles, outward.
std::vector<std::array<std::int32_t, 3>> boundary_of(const ElementMesh& mesh);
/// Mean ratio 12 (3 V)^(2/3) / (sum of squared edges) of a tetrahedron: 1 if regular, 0 if flat, negative if inverted.
double tet_quality(const std::array<Vec3d, 4>& x);
/// Mean length of the tetrahedra's edges [m].
double mean_edge(const ElementMesh& mesh);
/// 2 / the highest frequency of a single element [s] at rest: the stable step that can be counted on.
double element_bound(const ElementMesh& mesh, const Material& material);

/// Edges of a surface that are not used by exactly two triangles, once in each direction: 0 if it is closed.
std::int64_t singular_edges(const std::vector<std::array<std::int32_t, 3>>& triangles);

/// Figures of one mesh.
struct MeshFigures {
  std::int64_t elements = 0, nodes = 0;  ///< nodes that an element has
  double material = 0;                   ///< volume of the elements, fill counted [m^3]
  double enclosed = 0;                   ///< by the boundary [m^3]
  double least_quality = 0;              ///< of the tetrahedra
  std::int64_t singular_edges = 0;       ///< of the boundary
  std::int32_t pieces = 0;               ///< sets of elements that share nodes
  [[nodiscard]] bool closed() const { return singular_edges == 0; }
};
MeshFigures figures_of(const ElementMesh& mesh);

/// The mesh that a method produces.
struct MethodResult {
  ElementMesh mesh;
  std::vector<std::int32_t> node_from;     ///< [nodes] node of the mesh before, -1: new on an edge or inside an element
  std::vector<std::int32_t> element_from;  ///< [elements] element of the mesh before (after kuhn_tetrahedra, where it is used)
  std::int64_t crossed = 0;                ///< elements (removal, decomposition) or faces (separation) that the sweep crosses
  double distance = 0;                     ///< separation: mean distance of the cut's nodes from the sweep [m]
  double distance_before = 0;              ///< the same before nodes were moved
};

/// Leave out every element that a triangle touches, with its mass.
MethodResult remove_crossed(const ElementMesh& mesh, std::span<const SweepTriangle> sweep);

/// Divide every tetrahedron with a crossed edge along its crossings, alike on both sides of a face (quadrilaterals along the
/// diagonal at the lowest node), and part those that are completely cut; nodes on the cut are doubled. One corner or two
/// against two: 4 or 6 tetrahedra; any other pattern: a fan around the element's centroid. Hexahedra are split by Kuhn first.
MethodResult decompose_crossed(const ElementMesh& mesh, std::span<const SweepTriangle> sweep);

struct SeparationOptions {
  bool remesh = true;          ///< move the nodes of the cut onto the sweep
  double least_quality = 0.2;  ///< a move may not make a tetrahedron worse than this, unless it was so before
  /// With a law: of the faces that the sweep crosses only those that the physical criterion breaks too, by the stress of
  /// `displacement` [nodes] [m] in `material`.
  const BreakingLaw* law = nullptr;
  const Material* material = nullptr;
  std::span<const Vec3d> displacement;
};

/// Part the tetrahedra along existing faces: those between two elements whose centroids lie on different sides of the sweep.
MethodResult separate_crossed(const ElementMesh& mesh, std::span<const SweepTriangle> sweep,
                              const SeparationOptions& options = {});

/// Corners of the faces of an element, counter-clockwise from outside, and of its edges: hexahedra with corners in bit order,
/// their faces in the order of lattice_cell_shape().
template <std::size_t Corners>
struct ElementShape;
template <>
struct ElementShape<4> {
  static constexpr const auto& faces = kTetFaces;
  static constexpr const auto& edges = kTetEdges;
};
template <>
struct ElementShape<8> {
  static constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  static constexpr std::array<std::array<int, 2>, 12> edges{
      {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
};

/// A face of an element: ElementShape::faces[face], of a tetrahedron kTetFaces[face] (cut_cell.h).
struct TetFace {
  std::int32_t tet = 0;
  std::int8_t face = 0;
  friend bool operator==(const TetFace&, const TetFace&) = default;
};
/// The face across which another element lies, for each element and face; tet -1 on the boundary.
std::vector<std::array<TetFace, 4>> element_neighbors(const std::vector<std::array<std::int32_t, 4>>& tets);
std::vector<std::array<TetFace, 6>> element_neighbors(const std::vector<std::array<std::int32_t, 8>>& hexes);

/// What lies next to each other in a mesh. `Corners` of an element.
template <std::size_t Corners>
struct ElementAdjacency {
  ElementAdjacency(const std::vector<std::array<std::int32_t, Corners>>& elements, std::size_t nodes);
  [[nodiscard]] std::span<const std::int32_t> at(std::int32_t node) const {
    return {at_node.data() + offset[node], at_node.data() + offset[node + 1]};
  }
  std::vector<std::array<TetFace, ElementShape<Corners>::faces.size()>> neighbors;  ///< element_neighbors()
  std::vector<std::int32_t> offset, at_node;                                        ///< the elements at each node, ascending
};
extern template struct ElementAdjacency<4>;
extern template struct ElementAdjacency<8>;

/// Opens a mesh at faces: `mesh` with `cut` faces ([elements], bit f; both sides). Elements at a node that no uncut face
/// connects there get separate nodes. If they are connected only by an edge, the faces of the smaller part at one end of the
/// edge are cut as well and added to `cut`. Nodes without cut faces (and not in `touched`) do not change. Returns node_from
/// of the current nodes.
///
/// `wait` (may be null): cut faces that may stay closed at the end of a cut, where both sides still share the nodes of an edge:
/// cutting further faces there would lead away from the cut. Those that do are taken out of `cut` and left in `wait`.
std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, 4>>& tets, std::size_t nodes,
                                        std::vector<std::uint8_t>& cut, std::span<const std::int32_t> touched = {},
                                        std::vector<TetFace>* wait = nullptr);
std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, 8>>& hexes, std::size_t nodes,
                                        std::vector<std::uint8_t>& cut, std::span<const std::int32_t> touched = {},
                                        std::vector<TetFace>* wait = nullptr);
/// The same of a mesh that is opened again and again, each time as it was at first: `at_first` belongs to it.
template <std::size_t Corners>
std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, Corners>>& elements,
                                        const ElementAdjacency<Corners>& at_first, std::vector<std::uint8_t>& cut,
                                        std::span<const std::int32_t> touched, std::vector<TetFace>* wait);

}  // namespace pliant
