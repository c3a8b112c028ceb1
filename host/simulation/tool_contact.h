// Contact of a running simulation with its tools: poses and fixed-point units go to the device, forces come back.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/run_context.h"

namespace pliant {

/// What a tool feels: of one step, or the mean over the steps since somebody asked.
struct ToolLoad {
  Vec3d force{};     ///< on the tool [N]
  Vec3d torque{};    ///< about its origin [N m]
  double area = 0;   ///< of the tissue that touches it, at rest [m^2]
  double depth = 0;  ///< deepest point inside the tool, after contact [m]
  std::int64_t points = 0;
};

/// What became of a tool over a run.
struct ToolHistory {
  ToolLoad now;              ///< mean of the last batch
  double max_force = 0;      ///< of a batch's mean [N]
  double max_depth = 0;      ///< [m]
  double work = 0;           ///< done on the tissue by its rigid motion since the simulation was made [J]
  std::int64_t touched = 0;  ///< steps with contact
};

/// The number of a tool that is to be driven. Throws Error (usage) for a name that no tool has, or a pose or time that is none.
std::size_t check_drive(const Scene& scene, const std::string& name, const Pose& to, double seconds);

/// What became of the contact of tissue with tissue over a run.
struct TouchHistory {
  std::int64_t points = 0;  ///< points that touched in the last batch
  double max_depth = 0;     ///< deepest pair, after contact [m]
};

class ToolContact {
 public:
  explicit ToolContact(RunContext& run) : run_(run) {}

  /// Throws Error (bad_input) for a tool that begins inside a body, deeper than a quarter of a cell.
  void start();
  /// Poses for the next `steps` steps, and units. Nothing without tools.
  void begin_batch(std::int32_t steps);
  /// Read what the batch's tools felt. `steps`: how many were done.
  void end_batch(std::int32_t steps);
  /// What was felt belongs to a state: with the kept one it is kept, and comes back.
  void keep() { kept_ = history_; }
  void return_to_kept() { history_ = kept_; }

  /// One per tool of the scene.
  [[nodiscard]] const std::vector<ToolHistory>& history() const { return history_; }
  [[nodiscard]] const TouchHistory& tissue() const { return touch_; }
  /// Drive a tool from where it is now to a pose, which it has after `seconds`. Throws what check_drive() throws.
  void drive(const std::string& name, const Pose& to, double seconds);
  /// Where a tool is at a time [s].
  [[nodiscard]] Pose pose(std::size_t tool, double time) const;

 private:
  struct Units {
    double force = 0, torque = 0, area = 0;
  };
  [[nodiscard]] bool active() const;
  [[nodiscard]] Units units() const;

  /// Done on the tissue in a step of the batch by the force, and by the torque about the origin of a sequence's frame [J].
  [[nodiscard]] double work(std::size_t tool, std::int32_t step, const Vec3d& force, const Vec3d& torque) const;
  void look();
  void read_touch();

  RunContext& run_;
  std::vector<ToolHistory> history_, kept_;
  TouchHistory touch_;
  Units units_;              ///< of the present batch
  std::vector<Vec3d> arms_;  ///< [steps + 1][tools] from a tool's origin to that of a sequence's frame [m]
  std::vector<Pose> last_;   ///< [tools] one step before `last_step_`: driven tools do not know their past
  std::int64_t last_step_ = -1;
  std::vector<Pose> poses_;  ///< [steps + 2][tools], of a sequence's frame, from the step before the batch on
};

}  // namespace pliant
