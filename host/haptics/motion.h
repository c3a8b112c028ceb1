// Velocity of a device from its samples.
#pragma once
#include "geometry/vec3.h"
#include "pliant/haptic_device.h"

namespace pliant::haptics {

struct Motion {
  Vec3d velocity{};  ///< [m/s]
  Vec3d spin{};      ///< [rad/s]
};

/// Differences of samples through a first-order low-pass, v' = v + (1 - e^(-dt/tau)) (dx/dt - v). A sample that comes again
/// changes nothing, nor does one that is no pose. The time between two is that of the device's own clock, or of the ticks where
/// the device has none.
class MotionEstimate {
 public:
  /// `smoothing`: tau [s]; 0: plain differences.
  explicit MotionEstimate(double smoothing = 2e-3) : smoothing_(smoothing) {}
  /// `dt`: since the last call [s].
  Motion update(const DeviceSample& sample, double dt) noexcept;

 private:
  double smoothing_, since_ = 0;
  DeviceSample last_;
  Motion motion_;
};

}  // namespace pliant::haptics
