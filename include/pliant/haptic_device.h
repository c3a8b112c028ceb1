// Devices that a hand holds: where they are, and the force that they exert on the hand.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "pliant/export.h"
#include "pliant/frame.h"
#include "pliant/wrench.h"

namespace pliant {

/// Pose of a device when it was sampled.
struct DeviceSample {
  Vec3d position{};                        ///< of the tip [m]
  std::array<double, 4> turn{0, 0, 0, 1};  ///< orientation, unit quaternion x, y, z, w
  double time = 0;                         ///< when it was sampled, on the device's own clock [s]
  std::uint32_t buttons = 0;               ///< a bit per button
  std::uint64_t number = 0;                ///< number of samples so far; 0: none has come yet
  bool dated = true;                       ///< false: the device said no time, and `time` is when the sample came
};

/// Force on the hand that holds the device, and torque about the device's tip.
struct DeviceWrench : Wrench {
  DeviceWrench() = default;
  /// A force [N] and a torque [N m] that answer sample `sample`, taken at `at` [s].
  DeviceWrench(const Vec3d& f, const Vec3d& t, double at = 0, std::uint64_t sample = 0)
      : Wrench{f, t}, time(at), number(sample) {}

  double time = 0;           ///< DeviceSample::time of the sample that it answers [s]
  std::uint64_t number = 0;  ///< DeviceSample::number of this sample
};

/// Greatest force and torque of a device.
struct DeviceLimits {
  double force = std::numeric_limits<double>::infinity();   ///< greatest force [N]
  double torque = std::numeric_limits<double>::infinity();  ///< greatest torque [N m]; 0: it exerts none
};

/// Counts of the samples of a device.
struct DeviceCounts {
  std::uint64_t received = 0;  ///< samples
  std::uint64_t refused = 0;   ///< messages that gave none: malformed, not finite, too long, out of order
  std::string last_refusal;    ///< why the last one of them was refused; empty: none was
};

/// A device. HapticLoop calls read() and then write() once per tick, from its own thread: they must return at once, without
/// waiting for a lock, another thread or the network.
class PLIANT_API HapticDevice {
 public:
  HapticDevice() = default;
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;
  virtual ~HapticDevice();
  /// Returns the newest sample, the same one again if there is no newer one.
  virtual DeviceSample read() noexcept = 0;
  /// Exerts a wrench until the next call.
  virtual void write(const DeviceWrench& wrench) noexcept = 0;
  /// Its greatest force and torque, unlimited by default; a loop calls this once, at its start.
  [[nodiscard]] virtual DeviceLimits limits() const noexcept { return {}; }
  /// May be called from any thread.
  [[nodiscard]] virtual DeviceCounts counts() const { return {}; }
  /// The port of UDP or TCP that it listens on, for a text with port 0; 0: it listens on none.
  [[nodiscard]] virtual int port() const noexcept { return 0; }
};

/// A device without hardware: a program sets its pose (a mouse, an animation, a test) and reads the wrench on its hand.
/// These calls come from any thread, and none makes the loop wait.
class PLIANT_API ManualDevice final : public HapticDevice {
 public:
  /// Throws Error (usage) for limits that are negative or no number.
  explicit ManualDevice(const DeviceLimits& limits = {});
  ~ManualDevice() override;
  /// Moves the device; before the first call it is nowhere, and its tool stays. Throws Error (usage) for a position that is not
  /// finite or beyond 1000 m, and for a turn that has not unit length within 0.001; it then stays where it was.
  void set_pose(const Vec3d& position, const std::array<double, 4>& turn = {0, 0, 0, 1}, std::uint32_t buttons = 0);
  /// Force and torque on the hand now. The time and the number are those of the pose that it answers; 0: it answers none.
  [[nodiscard]] DeviceWrench wrench() const;
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override;
  /// Those that it was made with.
  [[nodiscard]] DeviceLimits limits() const noexcept override;
  [[nodiscard]] DeviceCounts counts() const override;

  struct PLIANT_HIDDEN Impl;  ///< implementation

 private:
  std::unique_ptr<Impl> impl_;
};

/// Opens a device by a text (docs/haptic_devices.md): "file:STROKE.csv", "udp:PORT", "shm:NAME", "websocket:PORT", "igtl:PORT",
/// "osc:PORT" or "spacenav". Whoever is at the other end may come and go later. Throws Error: `usage` for a text that names no
/// device, `bad_input` for one that cannot be opened, among others because this build lacks its library, `io` for a file.
PLIANT_API std::shared_ptr<HapticDevice> open_haptic_device(const std::string& text);

}  // namespace pliant
