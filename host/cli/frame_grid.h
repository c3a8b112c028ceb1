// Times of frames: every given number of steps, or the first step at or after each multiple of a simulated time.
#pragma once
#include <cstdint>
#include <string>

#include "simulation/simulation.h"

namespace pliant::cli {

class FrameGrid {
 public:
  /// Never.
  FrameGrid() = default;
  /// Parses "100" (steps), "16ms" or "0.016s" (simulated time; also us). Throws Error with the allowed forms.
  static FrameGrid parse(const std::string& every);
  static FrameGrid of_seconds(double seconds);
  static FrameGrid of_steps(std::int64_t steps);

  /// The present state has its frame: the next is due at the next multiple after it.
  void start(const Simulation& simulation);
  /// Steps until the next frame if the step stays as it is, at least 1.
  [[nodiscard]] std::int64_t steps_left(const Simulation& simulation) const;
  /// Whether the present state has come to the next frame; the one after it is due then.
  bool take(const Simulation& simulation);

 private:
  std::int64_t steps_ = 0;  ///< 0: none
  double seconds_ = 0;      ///< [s]; 0: none
  std::int64_t next_step_ = 0;
  double next_ = 0;  ///< multiple of seconds_
};

}  // namespace pliant::cli
