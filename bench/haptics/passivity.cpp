// A simulated hand and device around the whole tick: energy, the stiffest wall, a simulation that stalls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/contact/scenes.h"
#include "bench/haptics/parts.h"
#include "geometry/vec.h"
#include "haptics/hand.h"
#include "haptics/haptic_core.h"

namespace pliant::bench::haptics {
namespace {

using pliant::haptics::BufferMessage;
using pliant::haptics::BufferSource;
using pliant::haptics::CoreOptions;
using pliant::haptics::CoreTick;
using pliant::haptics::HandOptions;
using pliant::haptics::HapticCore;
using pliant::haptics::SimulatedHand;

constexpr double kTop = 0.04, kRadius = 0.01;

Scene block(double young, double damping) {
  Scene scene;
  scene.bodies = {contact::body_of("block", contact::cells_surface({10, 8, 10}, 0.005, {-0.025, 0, -0.025}), 0.005,
                                   ElementKind::hex8, contact::tissue(young, 0.45, damping))};
  scene.bodies[0].fixed = {{contact::face(1, 0)}};
  ContactTool ball;
  ball.name = "ball";
  ball.radius = kRadius;
  ball.path = {{0, 0, kTop + kRadius + 0.004, 0, 0, 0, 0, 1}};
  scene.tools = {ball};
  return scene;
}

/// The hand means to press, tremble and draw aside.
HandOptions hand(double device_damping, double seconds) {
  HandOptions o;
  o.translation.device_damping = device_damping;
  for (double t = 0; t <= seconds; t += 0.005) {
    const double press = 0.008 * std::min(1.0, t / 0.3), tremble = 5e-4 * std::sin(2 * std::numbers::pi * 9 * t);
    const double draw = 0.006 * std::sin(2 * std::numbers::pi * 0.7 * std::max(0.0, t - 0.4));
    o.path.push_back({t, draw, kTop + kRadius + 0.004 - press + tremble, 0, 0, 0, 0, 1});
  }
  return o;
}

struct Loop {
  double rate = 1000, frames = 60, delay = 1, device_damping = 0.2, young = 5000, damping = 20, seconds = 1;
  bool passive = true, held = false;
  double stalled_from = 0, stalled_until = 0;  ///< [s]
};

struct Outcome {
  std::int64_t ticks = 0, not_finite = 0, corrections = 0, stale = 0;
  double least = 1e30;  ///< energy of the observer [J]
  double largest = 0;   ///< force [N]
  double in_stall = 0;  ///< force at the end of a stall [N]
  double after = 0;     ///< force at the end [N]
  double work = 0;      ///< on hand and device [J]
};

CoreOptions core_of(const Loop& loop) {
  CoreOptions core;
  core.model = loop.held ? pliant::haptics::ModelKind::held : pliant::haptics::ModelKind::buffer;
  core.tick = 1 / loop.rate;
  core.coupling.rigid = true;
  core.passive = loop.passive;
  core.translation.damping = loop.device_damping;
  core.translation.acceleration = 100;
  core.align = false;
  core.guard.stale_after = 0.25;
  return core;
}

SessionOptions session_of(const Loop& loop) {
  SessionOptions options;
  options.frame_rate = loop.frames;
  options.haptic_rate = loop.rate;
  options.seconds = loop.seconds;
  options.delay = loop.delay;
  options.predict = 0;  // the hand's own prediction is in the stroke
  options.stalled_from = loop.stalled_from;
  options.stalled_until = loop.stalled_until;
  return options;
}

/// One closed loop in virtual time.
Outcome run_loop(const Loop& loop) {
  Scene scene = block(loop.young, loop.damping);
  SimulatedHand hand_held(hand(loop.device_damping, loop.seconds));
  const CoreOptions core = core_of(loop);
  const Pose start = scene.tools[0].at(0);
  HapticCore felt(core, start);
  BufferSource source("ball", 2);
  Pose tool = start;
  Vec3d velocity{};
  std::vector<std::unique_ptr<BufferMessage>> messages(8);
  for (auto& m : messages) m = std::make_unique<BufferMessage>();
  Outcome out;
  const SessionOptions options = session_of(loop);
  double now = 0, received = 0;
  SessionParts parts;
  parts.made = [&](Simulation& s, std::size_t slot) { source.fill(s, felt.buffer().in_use(), *messages[slot]); };
  parts.arrived = [&](std::size_t slot) {
    felt.receive(*messages[slot], 1 / loop.frames);
    received = now;
  };
  parts.tick = [&](const Pose&, double dt) {
    now += dt;
    hand_held.advance(dt);
    const CoreTick& tick = felt.tick(hand_held.read(), now - received, dt);
    hand_held.write(tick.exerted);
    tool = felt.pose().pose;
    velocity = felt.pose().motion.velocity;
    const double force = vec::norm(tick.hand.force);
    out.least = std::min(out.least, felt.gate().translation().observer().energy());
    out.largest = std::max(out.largest, force);
    if (now < loop.stalled_until) out.in_stall = force;
    out.after = force;
    ++out.ticks;
    return tick.tissue;
  };
  const Stroke stroke = [&](double) {
    Pose ahead = tool;
    ahead.position = vec::add(ahead.position, vec::mul(velocity, 1 / loop.frames));
    return ahead;
  };
  run_session(std::move(scene), "ball", stroke, options, parts);
  out.not_finite = static_cast<std::int64_t>(felt.guard().counts().not_finite);
  out.stale = static_cast<std::int64_t>(felt.guard().counts().stale);
  out.corrections = static_cast<std::int64_t>(felt.gate().translation().corrections());
  out.work = hand_held.work();
  return out;
}

void grid(PartRun& run) {
  const bool quick = run.options.quick;
  const std::vector<double> rates = quick ? std::vector{300.0, 1000.0} : std::vector{300.0, 1000.0, 3000.0, 10000.0};
  const std::vector<double> delays = quick ? std::vector{1.0} : std::vector{1.0, 3.0};
  const std::vector<double> stiffnesses = quick ? std::vector{5000.0} : std::vector{1000.0, 5000.0, 30000.0};
  const std::vector<double> dampings = quick ? std::vector{0.05} : std::vector{0.05, 0.5};
  const double wanted = quick ? 4000 : 1e6,
               loops = static_cast<double>(rates.size() * delays.size() * stiffnesses.size() * dampings.size());
  double all_rates = 0, done = 0;
  for (const double rate : rates) all_rates += rate / static_cast<double>(rates.size());
  const double seconds = std::max(0.8, wanted / (loops * all_rates));
  std::int64_t ticks = 0, lost = 0, negative_without = 0;
  double least = 1e30, least_without = 1e30;
  for (const double rate : rates) {
    for (const double delay : delays) {
      for (const double young : stiffnesses) {
        for (const double b : dampings) {
          run.show(done++ / loops, fmt::format("{} Hz, {} Pa", rate, young));
          Loop loop;
          loop.rate = rate;
          loop.delay = delay;
          loop.young = young;
          loop.device_damping = b;
          loop.seconds = seconds;
          const Outcome with = run_loop(loop);
          loop.passive = false;
          loop.held = true;  // what a device gets without buffer and controller
          const Outcome without = run_loop(loop);
          ticks += with.ticks;
          lost += with.not_finite;
          least = std::min(least, with.least);
          if (without.work > 1e-3) ++negative_without;
          least_without = std::min(least_without, -without.work);
        }
      }
    }
  }
  run.told("ticks", "buffer and controller", static_cast<double>(ticks));
  run.at_least("least energy of the observer, with its allowance of 1e-3 J [J]", "buffer and controller", least + 1, 1 - 1e-9,
               0);
  run.at_most("ticks without a finite force", "buffer and controller", static_cast<double>(lost), 0);
  run.told("loops of the grid", "", loops);
  run.told("loops that gave the hand more than 1e-3 J", "held force without controller", static_cast<double>(negative_without));
}

/// The stiffest wall that a device stands alone (Colgate and Schenkel 1997): K = 2 b / T. Just above it, motion grows slowly:
/// by a share of b / m T in a tick.
double stiffest_wall(double rate, double b) {
  constexpr double kMass = 0.08;  // [kg]
  const auto stable = [&](double k) {
    HandOptions o;
    o.translation = {kMass, b, 0, 0};
    o.rotation = {1e-4, 1e-3, 0, 0};
    SimulatedHand device(o);
    device.place(Pose{{0, -1e-3, 0}, {0, 0, 0, 1}});
    const auto ticks = static_cast<int>(80 * kMass / b * rate);  // 80 times the time in which the damper stops the mass
    double early = 0, late = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      const double depth = device.pose().position[1];
      if (std::abs(depth) > 0.1) return false;
      if (tick > ticks / 4 && tick < ticks / 2) early = std::max(early, std::abs(depth));
      if (tick > 3 * ticks / 4) late = std::max(late, std::abs(depth));
      DeviceWrench w;
      w.force = {0, -k * depth, 0};
      device.write(w);
      device.advance(1 / rate);
    }
    return late < early;
  };
  double low = 0.2 * b * rate, high = 8 * b * rate;
  for (int i = 0; i < 16; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

void stall(PartRun& run) {
  for (const double rate : {1000.0, 10000.0}) {
    Loop loop;
    loop.rate = rate;
    loop.seconds = 3;
    loop.stalled_from = 0.9;
    loop.stalled_until = 1.9;
    const Outcome out = run_loop(loop);
    const std::string name = fmt::format("{} Hz", rate);
    run.at_most("force after a stall of 1 s [N]", name, out.in_stall, 0);
    run.at_least("force once it goes on [N]", name, out.after, 0.05, 0);
    run.at_most("energy taken beyond the allowance over a stall [J]", name, std::max(0.0, -out.least), 1e-9);
    run.told("ticks with an old frame", name, static_cast<double>(out.stale));
  }
}

}  // namespace

void measure_passivity(PartRun& run) {
  for (const double rate : {300.0, 1000.0, 3000.0, 10000.0}) {
    for (const double b : {0.1, 0.5}) {
      run.close_to("stiffest stable wall [N/m], against 2 b / T", fmt::format("{} Hz, b = {} N s/m", rate, b),
                   stiffest_wall(rate, b), 2 * b * rate, 0.05);
    }
  }
  grid(run);
  stall(run);
}

}  // namespace pliant::bench::haptics
