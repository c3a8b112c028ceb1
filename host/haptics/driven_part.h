// What a device may drive in a simulation: a tool, or a blade that cuts by force.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pliant/wrench.h"
#include "scene/contact_tool.h"
#include "simulation/simulation.h"

namespace pliant::haptics {

/// The origin of a blade is the middle of its edge. Its turn takes the x axis to the direction from the first end to the
/// second.
Pose blade_pose(const BladeSegment& edge);
/// The edge of a blade of this length at a pose [m].
BladeSegment blade_edge(const Pose& pose, double length);

/// A tool of the model or a blade that is present, by its name. Of a tool and a blade with one name it is the tool.
class DrivenPart {
 public:
  /// Empty: there is none, the tool is parked, or the blade is nowhere at present.
  static std::optional<DrivenPart> find(const Simulation& simulation, const std::string& name);
  /// The names of all tools of the model, and of all blades that cut by force.
  static std::vector<std::string> names(const Simulation& simulation);

  [[nodiscard]] bool is_blade() const { return blade_; }
  /// Of the tool among ToolContact::tools(), or of the blade among BladePress::names().
  [[nodiscard]] std::size_t index() const { return index_; }
  [[nodiscard]] double length() const { return length_; }  ///< of a blade [m]
  [[nodiscard]] Pose pose(const Simulation& simulation, double time) const;
  /// On the part in the last step; empty where it is not known. Its mean over the steps of the last batch.
  [[nodiscard]] std::optional<Wrench> last(const Simulation& simulation) const;
  [[nodiscard]] Wrench mean(const Simulation& simulation) const;
  /// Of the last batch, shape [steps][tools] or [steps][blades]; empty where nothing is near a blade.
  [[nodiscard]] const std::vector<Wrench>& step_forces(const Simulation& simulation) const {
    return blade_ ? simulation.press().step_forces() : simulation.contact().step_forces();
  }
  /// Moves the part to `to` within `seconds` [s]. Throws Error as the simulation does, for a blade that is too fast among
  /// others.
  void drive(Simulation& simulation, const Pose& to, double seconds) const;
  /// `to`, or how far a blade comes within `seconds` at its greatest speed (TopologyEdits::drive_speed).
  [[nodiscard]] Pose within_reach(Simulation& simulation, const Pose& to, double seconds) const;

 private:
  std::string name_;
  bool blade_ = false;
  std::size_t index_ = 0;
  const Blade* own_ = nullptr;  ///< of the scene
  double length_ = 0;
};

}  // namespace pliant::haptics
