// The current position of the tissue, to check tools that appear in it or move faster than contact can follow.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "geometry/distance.h"
#include "model/contact/contact.h"
#include "model/model.h"

namespace pliant {

/// Depth inside a body at which a tool may start, as a fraction of a cell; contact pushes the tissue out.
inline constexpr double tool_start_depth = 0.25;
/// Speed in cells per second up to which a tool may be driven without a check.
inline constexpr double tool_cells_per_second = 100;

/// The deepest point of overlap between tool and tissue.
struct ToolOverlap {
  double depth = 0;        ///< [m]; 0: no overlap
  std::int32_t body = -1;  ///< index in the model
  Vec3d where{};           ///< [m]
};

/// Returns true if the tool travels a cell on its way in less time than contact needs to respond.
[[nodiscard]] bool is_too_fast(const ToolForm& form, const Pose& from, const Pose& to, double seconds, double cell);

/// Share of the way from one pose to another that a tool may go in this time without being too fast, at most 1.
[[nodiscard]] double share_in_time(const ToolForm& form, const Pose& from, const Pose& to, double seconds, double cell);

class PresentTissue {
 public:
  /// `u`: RunContext::u(). The model must have contact points and must outlive this object.
  PresentTissue(const Model& model, std::vector<double> u);

  /// Returns the depth of a tool at this pose and time in tissue. Checks points of the tissue's surface against the tool, and
  /// at most `samples` points of the tool against the bodies, which detects tools that lie wholly inside or pass between
  /// surface points.
  [[nodiscard]] ToolOverlap overlap(const ToolForm& form, const Pose& pose, double time, std::size_t samples = 64) const;
  /// Returns a point on the straight way between two poses where the tool is deeper in tissue than allowed at a start and
  /// deeper than at `from`: the first contact point that it meets, or if there is none, the first of its own points.
  [[nodiscard]] ToolOverlap in_the_way(const ToolForm& form, const Pose& from, const Pose& to, double time) const;

  /// Throws Error (bad_input) if the tool starts deeper in a body than a quarter of a cell.
  void refuse_inside(const std::string& name, const ToolForm& form, const Pose& pose, double time) const;
  /// Throws Error (bad_input) if the tool is_too_fast() and tissue is in its way.
  void refuse_in_the_way(const std::string& name, const ToolForm& form, const Pose& from, const Pose& to, double time,
                         double seconds) const;

 private:
  [[nodiscard]] ToolOverlap overlap_of_points(const ToolForm& form, const Pose& pose, double time) const;
  [[nodiscard]] Vec3d placed(const Vec3d& rest, const std::int32_t* nodes, const double* weights) const;
  [[nodiscard]] const SurfaceDistance* surface() const;

  const Model& model_;
  std::vector<double> u_;
  std::vector<Vec3d> points_;  ///< contact points
  vec::Box box_;               ///< bounding box of points_
  mutable std::unique_ptr<SurfaceDistance> surface_;
};

}  // namespace pliant
