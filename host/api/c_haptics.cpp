// Haptic loops of the C API.
#include <algorithm>

#include "api/c_call.h"

namespace {

using namespace pliant::api;

pliant::HapticOptions haptic_options_of(const pliant_haptic_options* pointer) {
  pliant_haptic_options given = PLIANT_HAPTIC_OPTIONS_INIT;
  if (pointer != nullptr) given = take_struct<pliant_haptic_options>(*pointer, given);
  pliant::HapticOptions o;
  o.rate = given.rate;
  if (given.model != nullptr) o.model = given.model;
  o.rings = given.rings;
  o.share = given.share;
  o.predict = given.predict;
  o.lead = given.lead;
  o.stiffness = given.stiffness;
  o.damping = given.damping;
  o.turn_stiffness = given.turn_stiffness;
  o.turn_damping = given.turn_damping;
  o.passive = given.passive != 0;
  o.device_damping = given.device_damping;
  o.stale_after = given.stale_after;
  o.ramp = given.ramp;
  o.greatest_force = given.greatest_force;
  o.greatest_torque = given.greatest_torque;
  o.align = given.align != 0;
  o.motion_scale = given.motion_scale;
  o.force_scale = given.force_scale;
  o.realtime = given.realtime != 0;
  o.grip_button = given.grip_button;
  o.log_samples = given.log_samples;
  return o;
}

pliant_haptic_sample c_sample(const pliant::HapticSample& given) {
  pliant_haptic_sample sample{};
  sample.tick = given.tick;
  sample.time = given.time;
  std::copy(given.device.begin(), given.device.end(), sample.device);
  std::copy(given.position.begin(), given.position.end(), sample.position);
  std::copy(given.tissue.begin(), given.tissue.end(), sample.tissue);
  std::copy(given.force.begin(), given.force.end(), sample.force);
  return sample;
}

/// Without the model's name.
pliant_haptic_state c_state(const pliant::HapticState& given) {
  pliant_haptic_state s{};
  s.running = given.running ? 1 : 0;
  s.realtime = given.realtime ? 1 : 0;
  s.ticks = given.ticks;
  s.late = given.late;
  s.work_mean = given.work_mean;
  s.work_most = given.work_most;
  s.work_p999 = given.work_p999;
  s.delay_p999 = given.delay_p999;
  s.delay_most = given.delay_most;
  s.frames = given.frames;
  s.age = given.age;
  s.rings = given.rings;
  s.elements = given.elements;
  s.substeps = given.substeps;
  s.buffers = given.buffers;
  s.resets = given.resets;
  s.contacts = given.contacts;
  s.stale = given.stale;
  s.limited = given.limited;
  s.not_finite = given.not_finite;
  s.corrections = given.corrections;
  s.energy = given.energy;
  s.least_energy = given.least_energy;
  s.refused = given.refused;
  return s;
}

template <class Call>
pliant_status on_loop(pliant_haptic_loop loop, Call&& call) noexcept {
  return guarded([&] {
    const auto held = Handles::loops().find(loop.id);
    call(*held);
  });
}

}  // namespace

pliant_status pliant_haptic_loop_create(pliant_world world, const char* tool, pliant_haptic_device device,
                                        const pliant_haptic_options* options, pliant_haptic_loop* out) {
  if (out != nullptr) out->id = 0;
  return on(world, [&](CWorld& w) {
    need(tool, "tool");
    need(out, "out");
    const auto d = Handles::devices().find(device.id);
    out->id = Handles::loops().add(std::make_shared<CLoop>(w.world, tool, d->device, haptic_options_of(options)));
  });
}

pliant_status pliant_haptic_loop_stop(pliant_haptic_loop loop) {
  return on_loop(loop, [](CLoop& l) { l.loop.stop(); });
}

pliant_status pliant_haptic_loop_destroy(pliant_haptic_loop loop) {
  return guarded([&] { Handles::loops().remove(loop.id); });
}

pliant_status pliant_haptic_loop_state(pliant_haptic_loop loop, pliant_haptic_state* out, pliant_haptic_sample* last) {
  return on_loop(loop, [&](CLoop& l) {
    check_struct(out);
    check_struct(last);
    const pliant::HapticState now = l.loop.state();
    pliant_haptic_state state = c_state(now);
    {
      const std::lock_guard lock(l.mutex);
      state.model = l.models.insert(now.model).first->c_str();
    }
    give_struct(state, out);
    give_struct(c_sample(now.last), last);
  });
}

pliant_status pliant_haptic_loop_samples(pliant_haptic_loop loop, pliant_haptic_sample* out, size_t count, size_t* given) {
  return on_loop(loop, [&](CLoop& l) {
    need(given, "given");
    check_array(out, count, "pliant_haptic_sample");
    const std::lock_guard lock(l.mutex);
    if (l.waiting.size() < count) {
      for (const pliant::HapticSample& fresh : l.loop.samples()) l.waiting.push_back(fresh);
    }
    *given = std::min(count, l.waiting.size());
    for (std::size_t i = 0; i < *given; ++i) {
      give_struct(c_sample(l.waiting.front()), element(out, i));
      l.waiting.pop_front();
    }
  });
}

pliant_status pliant_haptic_loop_write_log(pliant_haptic_loop loop, const char* file) {
  return on_loop(loop, [&](CLoop& l) {
    need(file, "file");
    l.loop.write_log(file);
  });
}
