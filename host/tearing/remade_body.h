// A body of plain elements that blades make anew where they pass: the elements are divided (DividedBody) or removed
// (ThinnedBody). What both share, as the edits of a running simulation see it.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "cutting/blade/blade_trace.h"
#include "model/elements/body_mesh.h"
#include "tearing/node_origins.h"

namespace pliant {

class RemadeBody {
 public:
  RemadeBody(const RemadeBody&) = delete;
  RemadeBody& operator=(const RemadeBody&) = delete;
  virtual ~RemadeBody() = default;

  /// What triangles [m] meet with the nodes of solid() at `x` [m], in the numbers of the whole body: edges with the share of
  /// the way, or elements, each as a pair with itself. Throws Error for triangles that are not finite.
  [[nodiscard]] virtual CutEdges crossed(std::span<const Vec3d> x, std::span<const SweepTriangle> triangles) = 0;
  /// Whether blades are followed in the undeformed body (sweep); if not, by the triangles that they sweep where the body is.
  [[nodiscard]] virtual bool follows_at_rest() const = 0;
  /// A sweep over the body with its nodes at `x` [m], which must outlive it; it finds edges of the whole body. The next call
  /// ends it.
  [[nodiscard]] virtual BladeSweep sweep(std::span<const Vec3d> x) = 0;
  /// Removes what has been cut already.
  virtual void keep_new(CutEdges& crossed) const = 0;
  /// Makes the edit. Throws Error (bad_input), after which the body is unusable, for what is no edge or element of the whole
  /// body, or has been cut already.
  virtual NodeOrigins remake(const CutEdges& crossed) = 0;

  /// Elements of the whole body that are cut in part: the ends of a cut edge still hold together in them.
  [[nodiscard]] virtual std::int64_t cut_in_part() const { return 0; }
  /// The same among those that have one of these edges, which an edit has cut.
  [[nodiscard]] virtual std::int64_t cut_in_part(const CutEdges& /*crossed*/) const { return 0; }

  /// The body now. Nodes and vertices of the surface of the whole body keep their numbers, also where no element has them.
  [[nodiscard]] const BodyMesh& solid() const { return solid_; }
  /// The elements, with the nodes and numbers of solid(); none is cut.
  [[nodiscard]] const CutTopology& topology() const { return *topology_; }
  [[nodiscard]] const BodyMesh& whole() const { return *whole_; }
  /// Mean edge of an undeformed element of the whole body [m].
  [[nodiscard]] double edge() const { return edge_; }
  /// The element that element `e` of the whole body has become where `rest` [m] is at rest; -1: it is gone.
  [[nodiscard]] std::int32_t element_at(std::int32_t e, const Vec3d& rest) const;
  /// Gives a point that an element carried before the last edit the element that carries it now.
  void follow(MaterialPoint& point) const;

 protected:
  explicit RemadeBody(std::shared_ptr<const BodyMesh> whole);
  /// Call when the elements of solid_ and their `parts` are those of an edit.
  void elements_changed();

  std::shared_ptr<const BodyMesh> whole_;
  BodyMesh solid_;

 private:
  using Parts = std::vector<std::vector<std::int32_t>>;  ///< [elements of another body] the elements that it has become
  [[nodiscard]] std::array<double, 4> weights(std::int32_t e, const Vec3d& rest) const;
  [[nodiscard]] std::int32_t nearest(const std::vector<std::int32_t>& elements, const Vec3d& rest) const;

  Parts of_whole_, of_before_;
  std::unique_ptr<CutTopology> topology_;
  double edge_ = 0;
};

/// Cuts edges of tetrahedra and divides these there: decomposition (docs/cutting.md). Throws Error (bad_input) for a mesh of
/// hexahedra.
std::unique_ptr<RemadeBody> make_divided_body(std::shared_ptr<const BodyMesh> whole);
/// Removes elements that blades touch.
std::unique_ptr<RemadeBody> make_thinned_body(std::shared_ptr<const BodyMesh> whole);

}  // namespace pliant
