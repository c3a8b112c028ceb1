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
  /// without being deep in it. Costs a pass over the triangles for each of some points of the tool.
  [[nodiscard]] SunkenTool deepest(const ToolForm& form, const Pose& pose, double time) const;

 private:
  template <class Visit>
  void triangles(const ModelBody& body, Visit&& visit) const;
  /// By the generalised winding number.
  [[nodiscard]] bool is_inside(const ModelBody& body, const Vec3d& x) const;
  /// From the surface of a body [m].
  [[nodiscard]] double distance(const ModelBody& body, const Vec3d& x) const;

  const Model& model_;
  std::vector<Vec3d> vertices_;
  std::vector<vec::Box> boxes_;  ///< [bodies]
};

}  // namespace pliant
