#include "cli/run_loop.h"

#include <algorithm>
#include <cmath>

#include "cli/cli.h"
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

std::int64_t RunLoop::remaining() const {
  double steps = 1e15;
  if (end_.step) steps = std::min(steps, static_cast<double>(*end_.step - simulation_.step()));
  // A millionth of a step covers the rounding of time / dt where the end is a multiple of the step.
  if (end_.time) steps = std::min(steps, std::ceil((*end_.time - simulation_.time()) / simulation_.dt() - 1e-6));
  return static_cast<std::int64_t>(std::max(0.0, steps));
}

RunResult RunLoop::run(std::int64_t every, const std::function<void()>& frame,
                       const std::function<void(std::int64_t)>& after_batch) {
  RunResult result;
  std::vector<double> batch_ms;
  while (!simulation_.at_equilibrium() && !result.interrupted) {
    std::int64_t wanted = remaining();
    if (wanted == 0) break;
    if (every > 0) wanted = std::min(wanted, every - simulation_.step() % every);
    const std::int32_t n = simulation_.next_batch(wanted);
    const Stopwatch clock;
    simulation_.advance(n);
    const double seconds = clock.seconds();
    result.seconds += seconds;
    batch_ms.push_back(1e3 * seconds / n);
    if (const auto& divergence = simulation_.divergence()) {
      result.diverged = divergence->message();
      result.diverged_step = divergence->step;
      break;
    }
    const bool is_frame = every > 0 && simulation_.step() % every == 0;
    result.interrupted = interrupted();
    result.steps += n;
    after_batch(result.steps);
    if (is_frame) frame();
  }
  result.ms_per_step = median(std::move(batch_ms));
  return result;
}

}  // namespace pliant::cli
