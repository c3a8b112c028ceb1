#include "cli/run_loop.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// Until steps are to follow. Returns false if the run ends here.
bool RunLoop::ask_guide(RunResult& result, std::int64_t first, std::vector<DueOutput>& due) {
  while (guide_ != nullptr && guide_->steps_left(simulation_) == 0) {
    const std::int64_t step = simulation_.step();
    const bool goes_on = guide_->next(simulation_);
    result.interrupted = interrupted();
    if (simulation_.step() < step || simulation_.divergence()) look(result, first, false, due);
    if (!goes_on || result.interrupted || !result.diverged.empty()) return false;
  }
  return true;
}

/// Runs one batch, up to the next output or the end at most. Returns false if the run was rolled back to an earlier state.
bool RunLoop::batch(const std::vector<DueOutput>& due, std::int32_t& steps) {
  const auto wanted = [&] {
    std::int64_t left = remaining();
    if (guide_ != nullptr) left = std::min(left, guide_->steps_left(simulation_));
    for (const DueOutput& d : due) left = std::min(left, d.grid.steps_left(simulation_));
    return std::max<std::int64_t>(1, left);
  };
  steps = simulation_.next_batch(wanted());
  simulation_.begin_batch(steps);
  // Only now the length of its steps is known: they may have grown, and fewer lead to the same time.
  steps = static_cast<std::int32_t>(std::min<std::int64_t>(steps, wanted()));
  const std::int64_t end = simulation_.step() + steps;
  simulation_.run_steps(0, steps);
  simulation_.end_batch(steps);
  return simulation_.step() == end;
}

void RunLoop::put_out(std::vector<DueOutput>& due, const std::vector<std::size_t>& outputs) {
  if (simulation_.settled()) {
    release(due);
    for (const std::size_t d : outputs) due[d].write();
  } else if (!outputs.empty()) {
    held_.push_back({simulation_.moment(), outputs});
  }
}

/// Writes the delayed outputs in order.
void RunLoop::release(std::vector<DueOutput>& due) {
  for (const Held& held : held_) {
    simulation_.look_at(held.moment, [&] {
      for (const std::size_t d : held.outputs) due[d].write();
    });
  }
  held_.clear();
}

void RunLoop::put_out_due(std::vector<DueOutput>& due) {
  std::vector<std::size_t> now;
  for (std::size_t d = 0; d < due.size(); ++d) {
    if (due[d].grid.take(simulation_)) now.push_back(d);
  }
  put_out(due, now);
}

/// Processes the result of a batch. `stayed`: it was not rolled back.
void RunLoop::look(RunResult& result, std::int64_t first, bool stayed, std::vector<DueOutput>& due) {
  result.steps = std::max<std::int64_t>(0, simulation_.step() - first);
  if (!stayed) {
    held_.clear();
    for (DueOutput& d : due) d.grid.start(simulation_);
  }
  if (const auto& divergence = simulation_.divergence()) {
    result.diverged = divergence->message();
    result.diverged_step = divergence->step;
  }
}

/// Returns whether the last state is final: later steps may cause a rollback behind it.
bool RunLoop::ends_here(RunResult& result, std::int64_t first, std::vector<DueOutput>& due) {
  if (profile_) simulation_.backend().profile(false);
  const bool stays = simulation_.confirm();
  if (profile_) simulation_.backend().profile(true);
  look(result, first, stays, due);
  return stays;
}

RunResult RunLoop::run(std::vector<DueOutput>& due, const std::function<void(const RunResult&)>& after_batch) {
  RunResult result;
  std::vector<double> batch_ms;
  const std::int64_t first = simulation_.step();
  std::vector<std::size_t> now(due.size());
  std::iota(now.begin(), now.end(), std::size_t{0});
  for (DueOutput& d : due) d.grid.start(simulation_);
  put_out(due, now);
  do {
    while (!simulation_.at_equilibrium() && !result.interrupted && result.diverged.empty() && remaining() > 0 &&
           ask_guide(result, first, due)) {
      const Stopwatch clock;
      std::int32_t n = 0;
      const bool stayed = batch(due, n);
      const double seconds = clock.seconds();
      result.seconds += seconds;
      batch_ms.push_back(1e3 * seconds / n);
      look(result, first, stayed, due);
      if (!result.diverged.empty()) break;
      const double dt = simulation_.dt();
      result.shortest_dt = batch_ms.size() == 1 ? dt : std::min(dt, result.shortest_dt);
      result.longest_dt = std::max(dt, result.longest_dt);
      result.interrupted = interrupted();
      after_batch(result);
      if (stayed) put_out_due(due);
    }
  } while (result.diverged.empty() && !result.interrupted && !ends_here(result, first, due));
  if (result.diverged.empty()) release(due);  // no later step can cause a rollback
  result.ms_per_step = median(std::move(batch_ms));
  return result;
}

}  // namespace pliant::cli
