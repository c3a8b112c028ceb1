#include "cli/frame_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/run_loop.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

constexpr double kLeastSeconds = 1e-9;

[[noreturn]] void refuse(const std::string& every) {
  throw Error(ErrorCode::bad_input, fmt::format("--every is {}; expected 1 or more steps (100), or a simulated time of at "
                                                "least {} s with its unit s, ms or us (0.016s, 16ms)",
                                                every, kLeastSeconds));
}

}  // namespace

FrameGrid FrameGrid::of_seconds(double seconds) {
  FrameGrid grid;
  grid.seconds_ = seconds;
  return grid;
}

FrameGrid FrameGrid::of_steps(std::int64_t steps) {
  FrameGrid grid;
  grid.steps_ = steps;
  return grid;
}

FrameGrid FrameGrid::parse(const std::string& every) {
  FrameGrid grid;
  const char *first = every.data(), *last = first + every.size();
  const auto whole = std::from_chars(first, last, grid.steps_);
  if (whole.ec == std::errc() && whole.ptr == last) {
    if (grid.steps_ < 1) refuse(every);
    return grid;
  }
  double value = 0;
  const auto number = std::from_chars(first, last, value);
  const std::string unit(number.ptr, last);
  const double scale = unit == "s" ? 1 : unit == "ms" ? 1e3 : unit == "us" ? 1e6 : 0;
  const double seconds = scale > 0 ? value / scale : 0;
  if (number.ec != std::errc() || !(seconds >= kLeastSeconds) || !std::isfinite(seconds)) refuse(every);
  return of_seconds(seconds);
}

void FrameGrid::start(const Simulation& simulation) {
  if (steps_ > 0) next_step_ = (simulation.step() / steps_ + 1) * steps_;
  if (seconds_ > 0) next_ = std::floor((simulation.time() + kStepSlack * simulation.dt()) / seconds_) + 1;
}

std::int64_t FrameGrid::steps_left(const Simulation& simulation) const {
  if (steps_ > 0) return std::max<std::int64_t>(1, next_step_ - simulation.step());
  return std::max<std::int64_t>(1, seconds_ > 0 ? steps_until(simulation, next_ * seconds_) : kMostSteps);
}

bool FrameGrid::take(const Simulation& simulation) {
  const bool due =
      (steps_ > 0 && simulation.step() >= next_step_) || (seconds_ > 0 && steps_until(simulation, next_ * seconds_) == 0);
  if (due) start(simulation);
  return due;
}

}  // namespace pliant::cli
