#include "haptics/haptic_core.h"

#include <utility>

#include "geometry/vec.h"
#include "geometry/wrench.h"

namespace pliant::haptics {
namespace {

std::array<double, 4> conjugate(const std::array<double, 4>& q) { return {-q[0], -q[1], -q[2], q[3]}; }

/// The rotation `turn` alone.
Pose rotation(const std::array<double, 4>& turn) { return {{}, turn}; }

}  // namespace

HapticCore::HapticCore(const CoreOptions& options, const Pose& tool)
    : options_(options),
      buffer_(options.lead, options.settle),
      coupling_(options.coupling, options.tick),
      grip_button_(options.grip_button),
      gate_(options.translation, options.rotation),
      guard_(options.guard, options.limits),
      in_use_(options.model),
      start_(tool) {
  out_.tool = out_.device = tool;
}

void HapticCore::receive(const BufferMessage& message, double interval) noexcept {
  covered_ = message.covered;
  buffer_.receive(message, interval);
  held_.receive(message.report);
  extrapolated_.receive(message.report);
}

/// Positions are scaled about where the device began, turns are not.
Pose aligned(const Pose& device, const Pose& device_start, const Pose& tool_start, double scale) noexcept {
  const Vec3d way = vec::mul(vec::sub(device.position, device_start.position), scale);
  const Pose turn = compose(compose(rotation(device.turn), rotation(conjugate(device_start.turn))), rotation(tool_start.turn));
  return {vec::add(tool_start.position, way), turn.turn};
}

Pose HapticCore::in_scene(const DeviceSample& sample) const noexcept {
  const Pose device{sample.position, sample.turn};
  if (options_.align) return aligned(device, device_start_, start_, options_.motion_scale);
  return {vec::mul(device.position, options_.motion_scale), device.turn};
}

/// Where the tool touches what no finite element moves, the reports are all that is known.
Wrench HapticCore::felt(const Pose& tool, double dt) noexcept {
  const Wrench buffer = options_.model == ModelKind::buffer ? buffer_.tick(tool, dt) : Wrench{};
  const Wrench held = held_.tick(tool, dt), line = extrapolated_.tick(tool, dt);
  in_use_ = options_.model == ModelKind::buffer && !covered_ ? ModelKind::extrapolated : options_.model;
  if (std::exchange(resets_, buffer_.resets()) != buffer_.resets()) guard_.restart();
  return in_use_ == ModelKind::buffer ? buffer : in_use_ == ModelKind::held ? held : line;
}

const CoreTick& HapticCore::tick(const DeviceSample& sample, double age, double dt, double since) noexcept {
  if (sample.number == 0) {  // the device has said nothing yet
    out_.hand = {};
    out_.exerted = {};
    return out_;
  }
  if (!aligned_) {
    aligned_ = true;
    device_start_ = {sample.position, sample.turn};
    coupling_.place(in_scene(sample));
  }
  out_.device = in_scene(sample);
  DeviceSample scene = sample;
  scene.position = out_.device.position;
  scene.turn = out_.device.turn;
  const Motion plain = plain_.update(sample, dt), now = motion_.update(scene, dt), smooth = smooth_.update(scene, dt);
  const Coupled coupled = coupling_.step(out_.device, now.velocity, now.spin, last_, dt);
  out_.tool = coupled.instrument;
  pose_.grip = grip_button_.read(sample.buttons);
  buffer_.grip(pose_.grip);
  out_.tissue = last_ = felt(out_.tool, dt);
  Wrench hand = scaled(options_.coupling.rigid ? last_ : coupled.on_hand, options_.force_scale);
  const Wrench allowed =
      options_.passive ? gate_.tick({sample.position, sample.turn}, plain.velocity, plain.spin, hand, since) : hand;
  out_.hand = guard_.tick(allowed, age, dt);
  if (options_.passive) gate_.exerted(out_.hand);
  out_.exerted = {out_.hand.force, out_.hand.torque, sample.time, sample.number};
  pose_.pose = out_.tool;
  pose_.motion = smooth;
  pose_.given = true;
  return out_;
}

}  // namespace pliant::haptics
