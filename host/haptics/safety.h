// The last stage before a device: no force from old reports, none that is not a number, none above the device's limits,
// and none that begins at once.
#pragma once
#include "haptics/force_model.h"
#include "pliant/haptic_device.h"

namespace pliant::haptics {

struct GuardOptions {
  double stale_after = 0.1;  ///< age of the newest report beyond which the wrench fades out [s]
  double ramp = 0.05;        ///< time of fading out [s]
  double rise = 0.1;         ///< time of fading in, at the start and after a gap [s]
};

struct GuardCounts {
  std::uint64_t ticks = 0;
  std::uint64_t gaps = 0;        ///< how often reports stayed away
  std::uint64_t stale = 0;       ///< ticks with an old report
  std::uint64_t not_finite = 0;  ///< ticks whose wrench was not a finite number
  std::uint64_t limited = 0;     ///< ticks whose force or torque exceeded the limits
};

/// A wrench is weighted by s^2 (3 - 2 s), where s goes from 0 to 1 in the time of fading in and back in that of fading out: the
/// weight has no step in its slope, changes per tick by at most 1.5 dt / ramp, and a ramp that is broken off turns around where
/// it is.
class ForceGuard {
 public:
  explicit ForceGuard(const GuardOptions& options = {}, const DeviceLimits& limits = {}) : options_(options), limits_(limits) {}
  /// `age`: of the newest report, from when it was received [s]; `dt`: since the last tick [s]. A wrench that is not finite is
  /// zero for this tick. Force and torque keep their direction where they are limited.
  Wrench tick(const Wrench& wrench, double age, double dt) noexcept;
  [[nodiscard]] const GuardCounts& counts() const noexcept { return counts_; }
  /// Weight of the last tick, in [0, 1].
  [[nodiscard]] double weight() const noexcept { return level_ * level_ * (3 - 2 * level_); }
  /// Fades in again, as at the start.
  void restart() noexcept { level_ = 0; }

 private:
  GuardOptions options_;
  DeviceLimits limits_;
  GuardCounts counts_;
  double level_ = 0;
  bool stale_ = false;
};

}  // namespace pliant::haptics
