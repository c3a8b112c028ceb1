// When the frames of a freely running World start, and how much simulated time each covers. Private to host/api,
// host/cli and tests.
#pragma once
#include <array>
#include <chrono>
#include <deque>
#include <limits>

#include "pliant/live.h"

namespace pliant::api {

/// Before and after all wall times.
inline constexpr double kLongAgo = -std::numeric_limits<double>::infinity(), kAtLast = std::numeric_limits<double>::infinity();

/// A frame per period, at the moment of the period when the caller fetches frames, so that the next one has a whole period to
/// be ready. With LiveOptions::ahead frames are made up to so many periods before that moment, and due when they would have
/// been ready without. All times are seconds of one monotonic clock.
class Pace {
 public:
  void start(const LiveOptions& options, double now);
  void change(const LiveOptions& options, double now);
  void stop() { running_ = false; }
  [[nodiscard]] bool running() const { return running_; }

  /// When the next frame may start.
  [[nodiscard]] double next_start() const { return next_start_ - options_.ahead / options_.rate; }
  /// Starts a frame. Returns the simulated time that it should cover [s]: the wall time since the last one times the speed,
  /// with at most a quarter more to catch up, and no more than this machine can simulate in time.
  double begin(double now);
  /// Ends it. `simulated`: time that it covered [s]; `edits`, `read`: wall time for cuts and changes, and for reading the
  /// surface [s].
  void end(double now, double simulated, double edits, double read);
  /// When the display may show the frame at work; long ago without LiveOptions::ahead.
  [[nodiscard]] double due() const;
  /// Call when the caller fetches a frame. Returns true if the next one may start earlier than next_start() said before.
  bool fetched(double now);
  /// Call when the caller looks for a frame and there is none yet.
  void looked(double now) { looked_ = now; }
  /// Counts a frame that nobody fetched.
  void drop() { state_.dropped += running_ && state_.frames > 0 ? 1 : 0; }
  /// Leaves out time that something else than frames took [s].
  void skip(double duration);

  [[nodiscard]] LiveState state() const;

 private:
  struct Passed {
    double wall = 0, simulated = 0;
  };

  LiveOptions options_;
  bool running_ = false, started_ = false;
  double begun_ = 0;       ///< start of the last frame, as if none were ahead of the display
  double next_start_ = 0;  ///< the same of the next
  double at_work_ = 0;     ///< when the last frame was really begun
  double looked_ = kLongAgo;
  double covers_ = 0;              ///< what the frame at work should cover [s]
  double owed_ = 0;                ///< simulated time that is not covered yet [s]
  double most_ = 1;                ///< what a frame may cover, in frames of full length
  std::array<double, 5> taken_{};  ///< durations of the last frames, in periods
  double cost_ = 0;                ///< the same of a frame of full length, if its duration is proportional to what it covers
  std::deque<Passed> passed_;
  double passed_wall_ = 0, passed_simulated_ = 0;  ///< sums of passed_
  double wall_of_this_ = 0;
  LiveState state_;
};

/// Seconds of the steady clock, and the reverse.
[[nodiscard]] double wall_time();
[[nodiscard]] std::chrono::steady_clock::time_point moment_of(double wall_time);

/// Throws Error (usage).
void check_live(const LiveOptions& options);

}  // namespace pliant::api
