// A run that keeps to the wall clock, with a haptic thread per device.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "api/haptic_thread.h"
#include "api/pace.h"
#include "haptics/lockstep.h"

namespace pliant::cli {

/// A frame each sixtieth of a second: as much simulated time as has passed on the wall, as far as this machine can. Before a
/// frame the tools are driven to where their devices take them, after it the haptic threads receive the state of the tissue.
class Paced final : public haptics::RunGuide {
 public:
  /// Starts the threads. `rate`: their ticks per second. `stop` ends the waiting, `remark` receives the first rejected pose of
  /// each tool. `log` gets every drive; it and the simulation must outlive this. Throws Error (usage) for a rate out of range.
  Paced(const Simulation& simulation, const std::vector<haptics::HeldTool>& tools, double rate, std::function<bool()> stop,
        std::function<void(const std::string&)> remark, haptics::DriveLog& log);
  [[nodiscard]] std::int64_t steps_left(const Simulation& simulation) const override;
  bool next(Simulation& simulation) override;
  /// Ends the threads; the devices get a zero force.
  void release() noexcept;
  [[nodiscard]] HapticState state(std::size_t tool) { return hands_[tool].thread->state(); }
  /// On the hand [N].
  [[nodiscard]] double largest_force(std::size_t tool) const { return hands_[tool].largest_force; }

 private:
  struct Hand {
    std::shared_ptr<haptics::Instrument> instrument;
    std::unique_ptr<api::HapticThread> thread;
    double largest_force = 0;
    bool refused = false;  ///< reported
  };
  void end_frame(const Simulation& simulation);
  bool wait();

  std::function<bool()> stop_;
  std::function<void(const std::string&)> remark_;
  haptics::DriveLog& log_;
  std::vector<Hand> hands_;
  api::Pace pace_;
  double begin_, target_;  ///< of the frame, on the scene's clock [s]
  bool started_ = false;
};

}  // namespace pliant::cli
