// The time loop of `pliant run`: batches between frames, until the end that was asked for.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace pliant::cli {

/// When a run ends. The first limit that is reached wins; equilibrium and divergence always end it.
struct RunEnd {
  std::optional<std::int64_t> step;  ///< number of the last step
  std::optional<double> time;        ///< [s] on the scene's clock
};

struct RunResult {
  std::int64_t steps = 0;
  double seconds = 0;      ///< wall time of stepping, without output [s]
  double ms_per_step = 0;  ///< median over batches
  std::string diverged;    ///< the message; empty: it did not
  std::int64_t diverged_step = 0;
  bool interrupted = false;
};

class RunLoop {
 public:
  RunLoop(Simulation& simulation, const RunEnd& end) : simulation_(simulation), end_(end) {}
  /// Steps still to do at the present size of the step.
  [[nodiscard]] std::int64_t remaining() const;
  /// Run to the end; calls `frame` at every multiple of `every` steps (0: never) and `after_batch` with the steps done after
  /// every batch. After a divergence the simulation holds the last good state.
  RunResult run(std::int64_t every, const std::function<void()>& frame, const std::function<void(std::int64_t)>& after_batch);

 private:
  Simulation& simulation_;
  RunEnd end_;
};

}  // namespace pliant::cli
