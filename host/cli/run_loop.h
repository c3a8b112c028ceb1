// The time loop of `pliant run`: batches between frames, until the requested end.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/frame_grid.h"
#include "haptics/run_guide.h"

namespace pliant::cli {

inline constexpr double kStepSlack = 1e-6;  ///< of a step: covers the rounding of time / dt at a multiple of the step
inline constexpr std::int64_t kMostSteps = 1'000'000'000'000'000;

/// Steps of the present length to the first one at or after `time` [s]; 0: it is reached.
std::int64_t steps_until(const Simulation& simulation, double time);

/// When a run ends. The first limit that is reached wins; equilibrium and divergence always end it.
struct RunEnd {
  std::optional<std::int64_t> step;  ///< number of the last step
  std::optional<double> time;        ///< [s] on the scene's clock
};

struct RunResult {
  std::int64_t steps = 0;
  double seconds = 0;                      ///< wall time of stepping, without output [s]
  double ms_per_step = 0;                  ///< median over batches
  double shortest_dt = 0, longest_dt = 0;  ///< of all steps [s]; 0: there was none
  std::string diverged;                    ///< the message; empty: it did not
  std::int64_t diverged_step = 0;
  bool interrupted = false;
};

/// The outputs of a run and their times.
struct DueOutput {
  FrameGrid grid;
  std::function<void()> write;
};

class RunLoop {
 public:
  /// `profile`: passes are timed, but for those of confirm(), which do not belong to the run. `guide`: has its say between the
  /// steps, and may end the run; null: there is none.
  RunLoop(Simulation& simulation, const RunEnd& end, bool profile = false, haptics::RunGuide* guide = nullptr)
      : simulation_(simulation), end_(end), profile_(profile), guide_(guide) {}
  /// Steps still to do at the present size of the step.
  [[nodiscard]] std::int64_t remaining() const;
  [[nodiscard]] const RunEnd& end() const { return end_; }
  /// Runs to the end. Writes outputs at the start and whenever their grid requires, and calls `after_batch` with the progress
  /// after every batch. A state is written once it is settled, so batches that are rolled back are never output. After a
  /// divergence the simulation holds the last good state.
  RunResult run(std::vector<DueOutput>& due, const std::function<void(const RunResult&)>& after_batch);

 private:
  /// A state that waits for output, with the indices of its outputs.
  struct Held {
    Moment moment;
    std::vector<std::size_t> outputs;
  };
  bool ask_guide(RunResult& result, std::int64_t first, std::vector<DueOutput>& due);
  bool batch(const std::vector<DueOutput>& due, std::int32_t& steps);
  void put_out(std::vector<DueOutput>& due, const std::vector<std::size_t>& outputs);
  void put_out_due(std::vector<DueOutput>& due);
  void release(std::vector<DueOutput>& due);
  void look(RunResult& result, std::int64_t first, bool stayed, std::vector<DueOutput>& due);
  bool ends_here(RunResult& result, std::int64_t first, std::vector<DueOutput>& due);

  Simulation& simulation_;
  RunEnd end_;
  bool profile_;
  haptics::RunGuide* guide_;
  std::vector<Held> held_;
};

}  // namespace pliant::cli
