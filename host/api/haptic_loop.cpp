// HapticLoop: the thread of a device, and its tool's place in a World.
#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "api/haptic_thread.h"
#include "api/world_call.h"
#include "devices/device_log.h"
#include "pliant/haptics.h"

namespace pliant {
namespace {

void check_range(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw Error(ErrorCode::usage, fmt::format("haptics: {} is {}, expected {} to {}", name, value, least, most));
}

void check_options(const HapticOptions& o) {
  check_range("rate", o.rate, 300, 10000);
  check_range("rings", o.rings, 1, 100);
  check_range("share", o.share, 0.01, 0.9);
  check_range("predict", o.predict, 0, 2);
  check_range("lead", o.lead, 0, 2);
  check_range("stiffness", o.stiffness, 0, 1e6);
  check_range("damping", o.damping, 0, 1e4);
  check_range("turn_stiffness", o.turn_stiffness, 0, 1e4);
  check_range("turn_damping", o.turn_damping, 0, 1e2);
  check_range("device_damping", o.device_damping, 0, 1e3);
  check_range("stale_after", o.stale_after, 0.001, 60);
  check_range("ramp", o.ramp, 0.001, 60);
  check_range("greatest_force", o.greatest_force, 0, 1e6);
  check_range("greatest_torque", o.greatest_torque, 0, 1e6);
  check_range("motion_scale", o.motion_scale, 1e-3, 1e3);
  check_range("force_scale", o.force_scale, 0, 1e3);
  check_range("log_samples", static_cast<double>(o.log_samples), 0, 1e8);
  const std::string models[] = {"auto", "buffer", "whole", "held", "extrapolated"};
  if (std::find(std::begin(models), std::end(models), o.model) != std::end(models)) return;
  throw Error(ErrorCode::usage,
              fmt::format("haptics: model is \"{}\", expected auto, buffer, whole, held or extrapolated", o.model));
}

/// Greatest acceleration of a hand [m/s^2], and the arm at which it holds a stylus [m].
constexpr double kHandAcceleration = 50, kArm = 0.045;

haptics::CoreOptions core_options(const HapticOptions& o, const DeviceLimits& limits) {
  haptics::CoreOptions c;
  c.model = o.model == "held"           ? haptics::ModelKind::held
            : o.model == "extrapolated" ? haptics::ModelKind::extrapolated
                                        : haptics::ModelKind::buffer;
  c.lead = o.lead;
  c.tick = 1 / o.rate;
  c.coupling.rigid = o.stiffness == 0;
  if (o.stiffness > 0) {
    constexpr double kArm2 = kArm * kArm;
    c.coupling.stiffness = o.stiffness;
    c.coupling.damping = o.damping;
    c.coupling.turn_stiffness = o.turn_stiffness > 0 ? o.turn_stiffness : kArm2 * o.stiffness;
    c.coupling.turn_damping = o.turn_damping > 0 ? o.turn_damping : kArm2 * o.damping;
  }
  c.passive = o.passive;
  c.translation.damping = o.device_damping;
  c.translation.acceleration = 2 * kHandAcceleration;  // velocities are differences of samples
  c.rotation.acceleration = 2 * kHandAcceleration / kArm;
  c.guard = {o.stale_after, o.ramp, o.ramp};
  c.limits = limits;
  if (o.greatest_force > 0) c.limits.force = std::min(c.limits.force, o.greatest_force);
  if (o.greatest_torque > 0) c.limits.torque = std::min(c.limits.torque, o.greatest_torque);
  c.align = o.align;
  c.motion_scale = o.motion_scale;
  c.force_scale = o.force_scale;
  return c;
}

}  // namespace

struct HapticLoop::Impl {
  std::unique_ptr<api::HapticThread> thread;
  mutable std::mutex mutex;  ///< of the callers of state(), samples() and stop()
  std::shared_ptr<devices::DeviceLog> log;
};

HapticLoop::HapticLoop(World& world, const std::string& tool, std::shared_ptr<HapticDevice> device,
                       const HapticOptions& options)
    : impl_(std::make_unique<Impl>()) {
  check_options(options);
  if (device == nullptr) throw Error(ErrorCode::usage, "haptics: the device is null");
  if (options.log_samples > 0) {
    impl_->log = std::make_shared<devices::DeviceLog>(options.log_samples);
    device = std::make_shared<devices::RecordedDevice>(std::move(device), impl_->log);
  }
  const std::int32_t rings = options.model == "whole" ? -1 : options.rings;
  auto instrument = std::make_shared<haptics::Instrument>(tool, rings, options.predict);
  const Pose start = WorldAccess::attach(world, instrument);
  const haptics::CoreOptions core = core_options(options, device->limits());
  impl_->thread = std::make_unique<api::HapticThread>(std::move(instrument), std::move(device), options, core, start);
}

HapticLoop::~HapticLoop() = default;

void HapticLoop::stop() noexcept {
  const std::lock_guard lock(impl_->mutex);
  impl_->thread->stop();
}

HapticState HapticLoop::state() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->thread->state();
}

std::vector<HapticSample> HapticLoop::samples() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->thread->samples();
}

void HapticLoop::write_log(const std::string& file) const {
  if (impl_->log == nullptr)
    throw Error(ErrorCode::state,
                "write_log: this loop keeps no log; HapticOptions::log_samples says how many samples to keep");
  impl_->log->write_csv(file);
}

}  // namespace pliant
