// The surface of a cut body: the original surface, split along the cut and closed by caps. It depends only on the original
// surface and on how the cells are cut. An edit recomputes only the affected part, and errors do not accumulate.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "cutting/surface/cell_interface.h"
#include "cutting/surface/overlay.h"
#include "cutting/topology/cut_topology.h"
#include "lattice/lattice.h"
#include "model/model.h"

namespace pliant {

enum class SurfaceKind : std::uint8_t {
  original,
  cut,    ///< a face of the cut
  filler  ///< closes a hole of the input surface
};

/// A vertex is embedded in the component of a lattice cell: u = sum_a weight[a] u(node a of that component's element),
/// trilinear at `local`.
struct CutSurfaceVertex {
  Vec3d rest{};                ///< [m]
  overlay::Carrier carrier{};  ///< cell of the lattice, and component (0 in a whole cell)
  std::array<double, 3> local{};
};

class CutSurface {
 public:
  /// `surface`: its vertices and triangles keep their numbers; triangles that close its holes follow. `lattice` must be built
  /// from it.
  CutSurface(const TriangleMesh& surface, const Lattice& lattice);
  ~CutSurface();

  /// Updates after an edit that changed these cells. The cost is proportional to the surface in and around them.
  void update(const CutTopology& topology, const std::vector<std::int32_t>& cells);
  /// The same with the cells' states; cells with one component become whole again.
  void update(const std::vector<overlay::CutGridCell>& cells);

  /// Vertices never change their number; unused ones remain.
  [[nodiscard]] const std::vector<CutSurfaceVertex>& vertices() const { return vertices_; }
  /// Outward. An uncut original triangle, or one piece of a cut one, keeps its number.
  [[nodiscard]] const std::vector<std::array<std::int32_t, 3>>& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<SurfaceKind>& kinds() const { return kinds_; }
  /// The triangle of the uncut surface that contains a triangle, -1 on a cut.
  [[nodiscard]] std::int32_t original_of(std::int32_t triangle) const {
    return owners_[triangle].cap ? -1 : owners_[triangle].what;
  }
  /// Embedding of a vertex: nodes of `topology` (numbers of CutElements) and trilinear weights with sum 1.
  void embedding(const CutTopology& topology, std::int32_t vertex, std::array<std::int32_t, 8>& nodes,
                 std::array<double, 8>& weights) const;
  /// Returns the changes since the last call, or since the original surface. A vertex counts as changed if it is new or
  /// embedded elsewhere.
  [[nodiscard]] SurfaceChanges take_changes();

 private:
  struct Owner {
    bool cap = false;
    std::int32_t what = 0;   ///< original triangle, or cut face
    std::int32_t place = 0;  ///< in its list of slots
  };
  struct Base;
  std::vector<std::int32_t>& slots_of(const Owner& owner);
  void replace(const Owner& owner, const overlay::Patch& patch, SurfaceKind kind);
  void set(std::int32_t slot, const std::array<std::int32_t, 3>& triangle, SurfaceKind kind, const Owner& owner);
  void remove_last_slot(std::vector<std::int32_t>& slots);
  std::int32_t vertex(const overlay::CutVertex& v);
  void embed(std::int32_t vertex, const overlay::Carrier& carrier);
  void embed_outside(const overlay::CutGridCell& cell);

  std::unique_ptr<Base> base_;
  std::vector<CutSurfaceVertex> vertices_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<SurfaceKind> kinds_;
  std::vector<Owner> owners_;
  std::unordered_map<overlay::VertexKey, std::int32_t, overlay::VertexKeyHash> vertex_of_;
  std::unordered_map<std::int32_t, std::vector<std::int32_t>> piece_slots_, cap_slots_;
  SurfaceChanges changes_;  ///< unordered, may contain duplicates and removed entries
};

}  // namespace pliant
