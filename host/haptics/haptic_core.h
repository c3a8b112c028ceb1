// One tick, without thread or clock: from the device's sample to the wrench on the hand.
#pragma once
#include <cstdint>

#include "haptics/buffer_force.h"
#include "haptics/coupling.h"
#include "haptics/grip_button.h"
#include "haptics/held.h"
#include "haptics/instrument.h"
#include "haptics/passivity.h"
#include "haptics/safety.h"

namespace pliant::haptics {

/// Where the tool is when the device is at `device`: at `tool_start` when it was at `device_start`, from there by as far times
/// `scale`, and turned as much.
Pose aligned(const Pose& device, const Pose& device_start, const Pose& tool_start, double scale) noexcept;

enum class ModelKind { buffer, held, extrapolated };

struct CoreOptions {
  ModelKind model = ModelKind::buffer;
  double lead = 1, settle = 2;  ///< BufferForce
  double tick = 1e-3;           ///< [s]
  CouplingOptions coupling;
  bool passive = true;
  EnergyOptions translation, rotation;
  GuardOptions guard;
  DeviceLimits limits;
  bool align = true;        ///< the first sample is where the tool is
  double motion_scale = 1;  ///< way of the tool per way of the device
  double force_scale = 1;   ///< force on the hand per force on the tool
  int grip_button = 0;      ///< GripButton
};

/// Wrenches and poses of a tick, in scene coordinates.
struct CoreTick {
  Pose device, tool;
  Wrench tissue;         ///< on the tool
  Wrench hand;           ///< on the hand
  DeviceWrench exerted;  ///< the same in the device's coordinates
};

class HapticCore {
 public:
  /// `tool`: where the tool is before the first tick. Throws Error for options that VirtualCoupling refuses.
  HapticCore(const CoreOptions& options, const Pose& tool);
  /// A message of the simulation has come, `interval` [s] after the one before.
  void receive(const BufferMessage& message, double interval) noexcept;
  /// `age`: of the newest message [s]. Advances by `dt` [s]; `since`: the real time since the tick before, in which the device
  /// gave and took energy.
  const CoreTick& tick(const DeviceSample& sample, double age, double dt, double since) noexcept;
  const CoreTick& tick(const DeviceSample& sample, double age, double dt) noexcept { return tick(sample, age, dt, dt); }

  [[nodiscard]] const InstrumentPose& pose() const { return pose_; }  ///< for the simulation
  [[nodiscard]] const BufferForce& buffer() const { return buffer_; }
  [[nodiscard]] const ForceGuard& guard() const { return guard_; }
  [[nodiscard]] const PassivityGate& gate() const { return gate_; }
  [[nodiscard]] ModelKind in_use() const { return in_use_; }

 private:
  [[nodiscard]] Pose in_scene(const DeviceSample& sample) const noexcept;
  [[nodiscard]] Wrench felt(const Pose& tool, double dt) noexcept;

  CoreOptions options_;
  BufferForce buffer_;
  HeldForce held_{Sampled::last};
  ExtrapolatedForce extrapolated_{0.1, Sampled::last};
  VirtualCoupling coupling_;
  GripButton grip_button_;
  PassivityGate gate_;
  ForceGuard guard_;
  /// Of the device: for the account of its energy, for the coupling, and for the simulation's tool.
  MotionEstimate plain_{0}, motion_{2e-3}, smooth_{8e-3};
  ModelKind in_use_;
  std::uint64_t resets_ = 0;  ///< of the buffer, at the last tick
  bool covered_ = true, aligned_ = false;
  Pose start_;         ///< of the tool
  Pose device_start_;  ///< of the device's first sample
  InstrumentPose pose_;
  Wrench last_;  ///< on the tool
  CoreTick out_;
};

}  // namespace pliant::haptics
