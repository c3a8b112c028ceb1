#include "api/pace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pliant/error.h"

namespace pliant::api {
namespace {

constexpr double kUse = 0.8;        ///< share of a period that half of the frames may take, so that most are ready in time
constexpr double kUseAhead = 0.95;  ///< the same of frames that are made ahead
constexpr double kLess = 0.8;       ///< changes of the simulated time that a frame may cover
constexpr double kMore = 1.2;
constexpr double kFaster = 1.25;  ///< largest simulated time of a frame, in periods
constexpr double kOwed = 0.25;    ///< wall time that can be caught up with [s]
constexpr double kOften = 0.8;    ///< a caller who looks again so soon does not wait for a display [periods]
constexpr double kShift = 0.2;    ///< largest change of the moment at which frames start, in periods
constexpr double kLeast = 0.05;   ///< least simulated time of a frame, in periods
constexpr double kNew = 0.25;     ///< weight of a new value in an average
constexpr double kWindow = 1;     ///< wall time that LiveState::real_time looks back [s]

}  // namespace

double wall_time() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::chrono::steady_clock::time_point moment_of(double wall_time) {
  using Clock = std::chrono::steady_clock;
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wall_time)));
}

void check_live(const LiveOptions& options) {
  const auto check = [](const char* name, double x, double least, double most) {
    if (x >= least && x <= most) return;
    throw Error(ErrorCode::usage, fmt::format("run_live: {} is {}, expected {} to {}", name, x, least, most));
  };
  check("rate", options.rate, 1, 1000);
  check("speed", options.speed, 0.001, 1000);
  check("ahead", options.ahead, 0, 4);
}

void Pace::start(const LiveOptions& options, double now) {
  *this = Pace();
  options_ = options;
  running_ = true;
  next_start_ = now;
}

void Pace::change(const LiveOptions& options, double now) {
  options_ = options;
  owed_ = 0;
  if (!started_) return;
  begun_ = std::min(begun_, now + options.ahead / options.rate);
  next_start_ = std::min(next_start_, begun_ + 1 / options.rate);
}

double Pace::begin(double now) {
  at_work_ = now;
  now = std::max(now, next_start_);
  const double period = 1 / options_.rate, full = options_.speed * period;
  const double elapsed = started_ ? std::max(0.0, now - begun_) : period;
  if (started_) state_.late += static_cast<std::int64_t>(std::max(0.0, std::round(elapsed / period) - 1));
  owed_ += elapsed * options_.speed;
  const double covers = std::min({owed_, kFaster * full, most_ * full});
  covers_ = covers;
  owed_ -= covers;
  const double most = kOwed * options_.speed;
  if (owed_ > most) {
    state_.lost += owed_ - most;
    owed_ = most;
  }
  started_ = true;
  begun_ = now;
  next_start_ = now + period;
  wall_of_this_ = elapsed;
  return covers;
}

/// A frame takes some time whatever it covers, and not always the same, so that only trying shows how much fits: less while
/// most frames take too long, more while they do not. A single slow frame, such as one that checks the step or moves a region,
/// is late once, and what it owes is caught up with.
void Pace::end(double now, double simulated, double edits, double read) {
  ++state_.frames;
  const double period = 1 / options_.rate, full = options_.speed * period;
  const double taken = std::max(0.0, now - at_work_ - edits), use = options_.ahead > 0 ? kUseAhead : kUse;
  taken_[static_cast<std::size_t>(state_.frames) % taken_.size()] = taken / period;
  std::array<double, 5> sorted = taken_;
  std::nth_element(sorted.begin(), sorted.begin() + 2, sorted.end());
  const double median = sorted[2];
  if (simulated > 0) cost_ += kNew * (std::max(0.0, taken - read) / simulated * options_.speed + read / period - cost_);
  if (median > use) {
    const double less = std::max(kLess, use / median);
    most_ = std::max(kLeast, std::min(most_, covers_ / full) * less);
    for (double& t : taken_) t *= less;
  } else {
    const double more = std::min({kMore, use / std::max(median, 0.01), kFaster / most_});
    most_ *= more;
    for (double& t : taken_) t *= more;
  }
  passed_.push_back({wall_of_this_, simulated});
  passed_wall_ += wall_of_this_;
  passed_simulated_ += simulated;
  while (passed_wall_ - passed_.front().wall > kWindow) {
    passed_wall_ -= passed_.front().wall;
    passed_simulated_ -= passed_.front().simulated;
    passed_.pop_front();
  }
}

/// Half a period early, so that a display that is a little early does not miss it.
double Pace::due() const { return running_ && options_.ahead > 0 ? begun_ + 0.5 / options_.rate : kLongAgo; }

/// Moves the start of the next frame towards the moment of the period at which this one was fetched. That of a caller who looks
/// more often than the rate says nothing.
bool Pace::fetched(double now) {
  const double period = 1 / options_.rate, before_this = std::exchange(looked_, now);
  if (!running_ || !started_ || now - before_this < kOften * period) return false;
  const double off = std::remainder(now - begun_, period);
  const double before = std::exchange(next_start_, begun_ + period + std::clamp(off, -kShift * period, kShift * period));
  return next_start_ < before;
}

void Pace::skip(double duration) {
  begun_ += duration;
  next_start_ += duration;
  at_work_ += duration;
}

LiveState Pace::state() const {
  LiveState state = state_;
  state.running = running_;
  state.real_time = passed_wall_ > 0 ? passed_simulated_ / (options_.speed * passed_wall_) : 0;
  state.load = cost_;
  return state;
}

}  // namespace pliant::api
