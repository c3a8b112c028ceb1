// Elapsed time.
#pragma once
#include <chrono>

namespace pliant {

class Stopwatch {
 public:
  /// [s] since it was made.
  [[nodiscard]] double seconds() const { return since(start_); }
  /// [s] since the last lap, at first since it was made.
  double lap() {
    const double seconds = since(lap_);
    lap_ = Clock::now();
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }
  Clock::time_point start_ = Clock::now();
  Clock::time_point lap_ = start_;
};

}  // namespace pliant
