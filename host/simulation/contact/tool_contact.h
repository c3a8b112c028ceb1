// Contact of a running simulation with its tools: poses and fixed-point units go to the device, forces come back.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/contact/contact_lists.h"
#include "simulation/state/run_context.h"
#include "simulation/state/run_report.h"

namespace pliant {

/// Throws Error (usage) for a pose that is none.
void check_pose(const std::string& name, const Pose& pose);
/// Throws Error (usage) for a pose or a time that is none.
void check_drive(const std::string& name, const Pose& to, double seconds);

class ToolContact {
 public:
  ToolContact(RunContext& run, RunReport& report) : run_(run), report_(report), lists_(run) {}

  /// Throws Error (bad_input) for a tool that begins inside a body, deeper than a quarter of a cell.
  void start();
  /// Poses for the next `steps` steps, and units. Nothing without tools.
  void begin_batch(std::int32_t steps);
  /// What is near, before a step of the batch. Returns how many of the next `steps` may run until it must be asked again.
  std::int32_t before_step(std::int32_t step_in_batch, std::int32_t steps);
  /// Read what the batch's tools felt. `steps`: how many were done.
  void end_batch(std::int32_t steps);

  /// The tools of the model: those of the scene, but for what the host added, removed or parked.
  [[nodiscard]] const std::vector<ContactTool>& tools() const { return tools_; }
  /// The model has the tools of the run state now. What tools have felt goes on with them.
  void follow();
  /// Drive a tool of the model from where it is now to a pose, which it has after `seconds`; at once if that is 0.
  void drive(std::size_t tool, const Pose& to, double seconds);
  /// Where a tool of the model is at a time [s].
  [[nodiscard]] Pose pose(std::size_t tool, double time) const;

 private:
  struct Units {
    double force = 0, torque = 0, area = 0;
  };
  [[nodiscard]] bool active() const;
  [[nodiscard]] Units units() const;
  /// How far the offset of a pair goes back in a search for partners, in spacings.
  [[nodiscard]] double touch_ease() const;

  /// Done on the tissue in a step of the batch by the force, and by the torque about the origin of a sequence's frame [J].
  [[nodiscard]] double work(std::size_t tool, std::int32_t step, const Vec3d& force, const Vec3d& torque) const;
  void read_touch();
  /// How far any point of a tool moves between two times, at most [m].
  [[nodiscard]] double motion(std::size_t tool, double from, double to) const;

  RunContext& run_;
  RunReport& report_;
  ContactLists lists_;
  std::vector<ContactTool> tools_;
  Units units_;               ///< of the present batch
  std::vector<char> summed_;  ///< per step of the batch: the passes of contact ran
  std::vector<Vec3d> arms_;   ///< [steps + 1][tools] from a tool's origin to that of a sequence's frame [m]
  std::vector<Pose> poses_;   ///< [steps + 2][tools], of a sequence's frame, from the step before the batch on
};

}  // namespace pliant
