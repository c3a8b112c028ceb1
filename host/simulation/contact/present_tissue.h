// Where the tissue of a running simulation is, for tools that appear in it or are moved faster than contact can follow.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "geometry/distance.h"
#include "model/contact/contact.h"
#include "model/model.h"

namespace pliant {

/// Depth inside a body with which a tool may begin, as a share of a cell: contact pushes it out.
inline constexpr double tool_start_depth = 0.25;
/// Cells per second that a tool may be driven wherever it goes.
inline constexpr double tool_cells_per_second = 100;

/// The deepest place where tool and tissue are one in the other.
struct ToolOverlap {
  double depth = 0;        ///< [m]; 0: nowhere
  std::int32_t body = -1;  ///< of the model
  Vec3d where{};           ///< [m]
};

/// Whether a tool goes a cell on its way in less time than contact needs to meet what is there.
[[nodiscard]] bool is_too_fast(const ToolForm& form, const Pose& from, const Pose& to, double seconds, double cell);

class PresentTissue {
 public:
  /// The model must outlive it and have contact points. `u`: RunContext::u().
  PresentTissue(const Model& model, std::vector<double> u);

  /// How deep a tool at this pose and time is in tissue: points of the tissue's surface inside the tool, and points of the tool
  /// inside a body, which tell of tools that are wholly inside or pass between points. At most `samples` of the latter.
  [[nodiscard]] ToolOverlap overlap(const ToolForm& form, const Pose& pose, double time, std::size_t samples = 64) const;
  /// The first place on the straight way between two poses where the tool is deeper in tissue than it may begin, and deeper
  /// than it is at `from`.
  [[nodiscard]] ToolOverlap in_the_way(const ToolForm& form, const Pose& from, const Pose& to, double time) const;

  /// Throws Error (bad_input) for a tool that begins deeper in a body than a quarter of a cell.
  void refuse_inside(const std::string& name, const ToolForm& form, const Pose& pose, double time) const;
  /// Throws Error (bad_input) for a tool that is_too_fast() and has tissue in its way.
  void refuse_in_the_way(const std::string& name, const ToolForm& form, const Pose& from, const Pose& to, double time,
                         double seconds) const;

 private:
  [[nodiscard]] Vec3d placed(const Vec3d& rest, const std::int32_t* nodes, const double* weights) const;
  [[nodiscard]] const SurfaceDistance* surface() const;

  const Model& model_;
  std::vector<double> u_;
  std::vector<Vec3d> points_;  ///< of contact
  vec::Box box_;               ///< around them
  mutable std::unique_ptr<SurfaceDistance> surface_;
};

}  // namespace pliant
