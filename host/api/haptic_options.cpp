#include "api/haptic_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "pliant/error.h"

namespace pliant::api {
namespace {

void check_range(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw Error(ErrorCode::usage, fmt::format("haptics: {} is {}, expected {} to {}", name, value, least, most));
}

/// Greatest acceleration of a hand [m/s^2], and the arm at which it holds a stylus [m].
constexpr double kHandAcceleration = 50, kArm = 0.045;

}  // namespace

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
  check_range("grip_button", o.grip_button, -1, 31);
  check_range("log_samples", static_cast<double>(o.log_samples), 0, 1e8);
  const std::string models[] = {"auto", "buffer", "whole", "held", "extrapolated"};
  if (std::find(std::begin(models), std::end(models), o.model) != std::end(models)) return;
  throw Error(ErrorCode::usage,
              fmt::format("haptics: model is \"{}\", expected auto, buffer, whole, held or extrapolated", o.model));
}

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
  c.grip_button = o.grip_button;
  return c;
}

}  // namespace pliant::api
