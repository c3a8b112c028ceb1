// A device and the hand that holds it, simulated: for tests, demonstrations and measurements without a device.
#pragma once
#include <array>
#include <chrono>
#include <vector>

#include "pliant/haptic_device.h"
#include "scene/contact_tool.h"

namespace pliant::haptics {

/// A mass with a damper to the ground and a spring and damper to where the hand wants it.
struct Grip {
  double mass = 0;            ///< of device and hand [kg; kg m^2]
  double device_damping = 0;  ///< [N s/m; N m s/rad]
  double stiffness = 0;       ///< of the hand [N/m; N m/rad]
  double damping = 0;         ///< of the hand [N s/m; N m s/rad]
};

/// The device's apparent mass is that of the PHANToM, below 0.1 kg (Massie and Salisbury 1994). A hand on a stylus is of the
/// order of 0.1 kg, some N s/m and some hundred N/m (Israr, Choi and Tan 2006); damper and spring grow with the grip (Hasser
/// and Cutkosky 2002).
struct HandOptions {
  Grip translation{0.07 + 0.15, 0.2, 300, 4};
  Grip rotation{1e-4 + 2e-4, 1e-3, 0.5, 5e-3};
  /// Where the hand wants the tip: (time [s], position [m], turn x, y, z, w); times ascending, interpolated linearly, constant
  /// outside; empty: at the origin.
  std::vector<std::array<double, 8>> path;
  DeviceLimits limits;     ///< larger forces are exerted at the limit, non-finite ones not at all
  bool wall_time = false;  ///< read() advances to the time of the clock; otherwise only advance() does
};

/// Between two ticks the wrench is constant and the intended path is taken as straight: with y = x - path, M y'' + (b + B) y' +
/// k y = F - b path' has constant coefficients, and its solution over the tick is the exponential of a 3 x 3 matrix, exact for
/// any tick. Rotations use the rotation vector from the intended turn, which is exact while that is small. Starts at rest where
/// the hand wants it.
class SimulatedHand : public HapticDevice {
 public:
  /// Throws Error for a mass that is not positive and for negative or non-finite numbers.
  explicit SimulatedHand(const HandOptions& options);
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override;
  [[nodiscard]] DeviceLimits limits() const noexcept override { return options_.limits; }
  /// Advances by `dt` [s]; allocates nothing. In between the device exerts the wrench of the last write().
  void advance(double dt) noexcept;

  [[nodiscard]] double time() const noexcept { return time_; }         ///< [s]
  [[nodiscard]] const Pose& pose() const noexcept { return pose_; }    ///< of the tip
  [[nodiscard]] Vec3d velocity() const noexcept { return velocity_; }  ///< [m/s]
  [[nodiscard]] Vec3d spin() const noexcept { return spin_; }          ///< [rad/s]
  [[nodiscard]] Pose intended(double time) const noexcept { return path_.at(time); }
  /// Work that the wrenches have done on device and hand [J].
  [[nodiscard]] double work() const noexcept { return work_; }
  /// Puts the device there, for the start of an experiment.
  void place(const Pose& pose, const Vec3d& velocity = {}, const Vec3d& spin = {}) noexcept;

 private:
  /// Of (y, y', constant input): the first two rows of the exponential.
  using Rows = std::array<std::array<double, 3>, 2>;
  static Rows over(const Grip& grip, double dt) noexcept;
  HandOptions options_;
  ContactTool path_;  ///< only its path
  double time_ = 0, dt_ = 0, work_ = 0;
  Rows translation_{}, rotation_{};  ///< over dt_
  Pose pose_;
  Vec3d velocity_{}, spin_{};
  DeviceWrench held_;
  std::uint64_t samples_ = 0;
  std::chrono::steady_clock::time_point last_read_{};
};

}  // namespace pliant::haptics
