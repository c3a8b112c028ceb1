#include "cli/run_loop.h"

#include <algorithm>
#include <cmath>

#include "cli/cli.h"
#include "cli/frame_grid.h"
#include "geometry/stopwatch.h"

namespace pliant::cli {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

std::int64_t steps_until(const Simulation& simulation, double time) {
  const double steps = std::ceil((time - simulation.time()) / simulation.dt() - kStepSlack);
  return static_cast<std::int64_t>(std::clamp(steps, 0.0, static_cast<double>(kMostSteps)));
}

std::int64_t RunLoop::remaining() const {
  std::int64_t steps = kMostSteps;
  if (end_.step) steps = std::min(steps, *end_.step - simulation_.step());
  if (end_.time) steps = std::min(steps, steps_until(simulation_, *end_.time));
  return std::max<std::int64_t>(0, steps);
}

/// One batch that goes beyond neither the next output nor the end. Returns its steps.
std::int32_t RunLoop::batch(const std::vector<DueOutput>& due) {
  const auto wanted = [&] {
    std::int64_t steps = remaining();
    for (const DueOutput& d : due) steps = std::min(steps, d.grid.steps_left(simulation_));
    return std::max<std::int64_t>(1, steps);
  };
  std::int32_t n = simulation_.next_batch(wanted());
  simulation_.begin_batch(n);
  // Only now the length of its steps is known: they may have grown, and fewer lead to the same time.
  n = static_cast<std::int32_t>(std::min<std::int64_t>(n, wanted()));
  simulation_.backend().run(simulation_.program().step, 0, n, simulation_.step());
  simulation_.end_batch(n);
  return n;
}

RunResult RunLoop::run(std::vector<DueOutput>& due, const std::function<void(const RunResult&)>& after_batch) {
  RunResult result;
  std::vector<double> batch_ms;
  const std::int64_t first = simulation_.step();
  for (DueOutput& d : due) d.grid.start(simulation_);
  while (!simulation_.at_equilibrium() && !result.interrupted && remaining() > 0) {
    const Stopwatch clock;
    const std::int32_t n = batch(due);
    const double seconds = clock.seconds();
    result.seconds += seconds;
    batch_ms.push_back(1e3 * seconds / n);
    result.steps = std::max<std::int64_t>(0, simulation_.step() - first);  // a batch that is made again takes steps back
    if (const auto& divergence = simulation_.divergence()) {
      result.diverged = divergence->message();
      result.diverged_step = divergence->step;
      break;
    }
    const double dt = simulation_.dt();
    result.shortest_dt = batch_ms.size() == 1 ? dt : std::min(dt, result.shortest_dt);
    result.longest_dt = std::max(dt, result.longest_dt);
    result.interrupted = interrupted();
    after_batch(result);
    for (DueOutput& d : due) {
      if (d.grid.take(simulation_)) d.write();
    }
  }
  result.ms_per_step = median(std::move(batch_ms));
  return result;
}

}  // namespace pliant::cli
