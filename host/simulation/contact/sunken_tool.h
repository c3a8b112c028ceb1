// Tools that stand below the surface of a body although contact keeps points of the surface out of them.
#pragma once
#include <vector>

#include "geometry/vec.h"
#include "model/contact/contact.h"
#include "model/model.h"
#include "simulation/state/run_report.h"

namespace pliant {

/// Simulated time between two looks at the tools [s].
inline constexpr double sunken_look_every = 0.25;
/// A tool that stands deeper below the surface, in cells, has passed it.
inline constexpr double sunken_cells = 1;

/// The surfaces of the bodies as they are.
class BodySurfaces {
 public:
  /// `u`: RunContext::u(). The model must outlive this object.
  BodySurfaces(const Model& model, const std::vector<double>& u);

  /// Returns where a tool at this pose is deepest below the surface of a body. A half space never is: no tissue is behind it
  /// without being deep in it. Of bodies whose triangles are larger than their cells the depth is the distance from a point of
  /// contact. Costs a pass over the triangles for each point of the tool that is looked at.
  [[nodiscard]] SunkenTool deepest(const ToolForm& form, const Pose& pose, double time) const;

 private:
  template <class Visit>
  void triangles(const ModelBody& body, Visit&& visit) const;
  [[nodiscard]] SunkenTool deepest_in(std::size_t b, const ToolForm& form, const Pose& at, const ToolMoment& moment) const;
  /// Whether a line along z from x meets the surface of a body.
  [[nodiscard]] bool may_be_inside(const ModelBody& body, const Vec3d& x) const;
  /// By the generalised winding number.
  [[nodiscard]] bool is_inside(const ModelBody& body, const Vec3d& x) const;
  /// From the surface of a body [m].
  [[nodiscard]] double distance(const ModelBody& body, const Vec3d& x) const;

  struct Facet {
    Vec3d x{}, area{};  ///< place [m], and undeformed area along the undeformed normal [m^2]
  };
  void add_points(std::size_t b, const std::vector<double>& u);
  [[nodiscard]] const std::vector<Facet>& points_of(const ModelBody& body) const {
    return coarse_[static_cast<std::size_t>(&body - model_.bodies.data())];
  }

  const Model& model_;
  std::vector<Vec3d> vertices_;
  std::vector<vec::Box> boxes_;             ///< [bodies]
  std::vector<std::vector<Facet>> coarse_;  ///< [bodies] points of contact, where triangles are too large to show dents
};

}  // namespace pliant
