// Contact with rigid tools: uploads poses and fixed-point units, reads back forces.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/contact/contact_lists.h"
#include "simulation/contact/contact_units.h"
#include "simulation/contact/parting_work.h"
#include "simulation/state/run_context.h"
#include "simulation/state/run_report.h"

namespace pliant {

/// Throws Error (usage) for an invalid pose.
void check_pose(const std::string& name, const Pose& pose);
/// Throws Error (usage) for an invalid pose or time.
void check_drive(const std::string& name, const Pose& to, double seconds);

class ToolContact {
 public:
  ToolContact(RunContext& run, RunReport& report) : run_(run), report_(report), lists_(run), parting_(run) {}

  /// Throws Error (bad_input) for a tool that starts inside a body, deeper than a quarter of a cell, or for bodies that
  /// overlap.
  void start();
  /// Uploads the poses for the next `steps` steps, and the units. Does nothing without contact points.
  void begin_batch(std::int32_t steps);
  /// Updates the contact lists before a step of the batch. Returns how many of the next `steps` steps may run before the next
  /// update.
  std::int32_t before_step(std::int32_t step_in_batch, std::int32_t steps);
  /// Reads the tool forces of the batch. `steps`: number of steps done.
  void end_batch(std::int32_t steps);

  /// The tools of the model: those of the scene, with the host's additions, removals and parking.
  [[nodiscard]] const std::vector<ContactTool>& tools() const { return tools_; }
  /// Index of a tool of the model by name; empty: it is parked, or there is none.
  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const;
  /// Call after the model has got the tools of the run state. Tools that remain keep their statistics.
  void follow();
  /// Moves a tool of the model from its current pose to `to` within `seconds` [s]; at once if that is 0.
  void drive(std::size_t tool, const Pose& to, double seconds);
  /// Returns the force of contact on every contact point in the last step [N]: that of all tools and of tissue. Empty if
  /// nothing touched, or where it is not known: before the first step and after the state was changed.
  [[nodiscard]] std::vector<Vec3d> point_forces() const;
  /// Force and torque of each step of the last batch, shape [steps][tools]; it ended after step batch_end().
  [[nodiscard]] const std::vector<Wrench>& step_forces() const { return felt_.step_forces; }
  [[nodiscard]] std::int64_t batch_end() const { return felt_.batch_end; }
  /// The clock that it ended by; the next batch may have another step.
  [[nodiscard]] const Clock& batch_clock() const { return felt_.batch_clock; }
  /// Of the last step; empty where it is not known: before the first step and after the tools or the state were changed.
  [[nodiscard]] std::optional<Wrench> last_force(std::size_t tool) const;
  /// Forces on the tools in the last batch, to be put back after the simulation has gone ahead.
  struct Felt {
    std::vector<Wrench> step_forces;
    std::int64_t batch_end = -1;
    Clock batch_clock;
  };
  [[nodiscard]] const Felt& felt() const { return felt_; }
  void put_back(const Felt& felt) { felt_ = felt; }
  /// point_forces() on the nodes [N], by slot; empty where they are.
  [[nodiscard]] std::vector<Vec3d> node_forces() const;
  /// What gripped points give back when they return to their places in the grip: force times distance [J], since a grip holds
  /// against a force at any distance.
  [[nodiscard]] double held_energy() const;
  /// Statistics of a tool of the model.
  [[nodiscard]] const ToolHistory& history(std::size_t tool) const { return report_.tools[tool]; }
  /// Returns where each tool of the model is deepest below the surface of a body now.
  [[nodiscard]] std::vector<SunkenTool> sunken_now() const;
  /// Returns the pose of a tool of the model at a time [s].
  [[nodiscard]] Pose pose(std::size_t tool, double time) const;

 private:
  [[nodiscard]] bool active() const;
  /// Fraction of a spacing by which the initial offset of a pair is reduced in each search for partners.
  [[nodiscard]] double touch_ease() const;

  /// Returns the work on the tissue in a step of the batch, by the force and by the torque about the origin of a sequence's
  /// frame [J].
  [[nodiscard]] double work(std::size_t tool, std::int32_t step, const Wrench& on_tool) const;
  void read_touch();
  /// Around a search before a step of the batch, where the energy is watched.
  void count_parting(std::int32_t step_in_batch, bool before);
  /// At intervals: finds tools that stand below the surface. Call after a batch of `steps` steps.
  void look_for_sunken(std::int32_t steps);
  /// Call before a batch: notes which blades with faces are in the scene.
  void begin_faces();
  /// `step_ago` [s], or since then the time at which the host has placed the tool where it is: it did not go there.
  [[nodiscard]] double went_from(std::size_t tool, double step_ago) const;
  /// Upper bound of the distance that any point of a tool moves between two times [m].
  [[nodiscard]] double motion(std::size_t tool, double from, double to) const;

  RunContext& run_;
  RunReport& report_;
  ContactLists lists_;
  PartingWork parting_;
  std::vector<ContactTool> tools_;
  std::shared_ptr<const Model> extent_of_;  ///< model of extent_
  ContactExtent extent_;
  ContactUnits units_;               ///< of the current batch
  ContactUnits last_units_;          ///< of the batch before
  std::int64_t known_at_ = -1;       ///< step after which the buffers hold the forces of points; -1: none
  std::int64_t known_changes_ = -1;  ///< LoadedModel::changes() then
  Felt felt_;
  std::vector<char> summed_;  ///< per step of the batch: whether the contact passes ran
  std::vector<Vec3d> arms_;   ///< from a tool's origin to the origin of a sequence's frame, shape [steps + 1][tools] [m]
  std::vector<Pose> poses_;   ///< poses of a sequence's frame from the step before the batch on, shape [steps + 2][tools]
};

}  // namespace pliant
