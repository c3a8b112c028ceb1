#include "bench/survival/live_tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/common/dice.h"
#include "geometry/vec.h"
#include "haptics/instrument.h"
#include "scene/blade_face.h"

namespace pliant::bench {
namespace {

using namespace pliant::haptics;

constexpr double kTick = 1e-3;                      // [s]
constexpr DeviceLimits kLimits{7.9, 0.3};           ///< of a device of the middle class
constexpr double kAcceleration = 50, kArm = 0.045;  // as in a HapticLoop (pliant/haptics.h)

CoreOptions core_options() {
  CoreOptions o;
  o.tick = kTick;
  o.coupling.rigid = true;
  o.translation.damping = HandOptions().translation.device_damping;
  o.translation.acceleration = 2 * kAcceleration;
  o.rotation.damping = HandOptions().rotation.device_damping;
  o.rotation.acceleration = 2 * kAcceleration / kArm;
  o.guard = {0.25, 0.1, 0.1};
  o.limits = kLimits;
  return o;
}

vec::Box box_of(const Model& model) {
  vec::Box box;
  for (const ModelBody& body : model.bodies) {
    for (const Vec3d& x : body.rest) box.extend(x);
  }
  return box;
}

/// A stroke from the tool's start: to places about the body and in it, with pauses, at the speeds of a hand.
std::vector<std::array<double, 8>> stroke(Dice& dice, const Pose& start, const vec::Box& box, double seconds) {
  const Vec3d middle = vec::mul(vec::add(box.lower, box.upper), 0.5);
  const double extent = vec::norm(vec::sub(box.upper, box.lower));
  std::vector<std::array<double, 8>> path;
  std::array<double, 4> turn = start.turn;
  const auto add = [&](double t, const Vec3d& x) { path.push_back({t, x[0], x[1], x[2], turn[0], turn[1], turn[2], turn[3]}); };
  add(0, start.position);
  double time = dice.uniform(0, 0.3);
  add(time, start.position);
  Vec3d at = start.position;
  while (time < seconds) {
    const Vec3d inwards = vec::add(start.position, vec::mul(vec::sub(middle, start.position), dice.uniform(0, 0.8)));
    const Vec3d next = vec::add(inwards, vec::mul(dice.direction(), dice.uniform(0, 0.15) * extent));
    const double speed = dice.logarithmic(0.02, 0.8);  // [m/s]
    time += std::max(0.05, vec::norm(vec::sub(next, at)) / speed);
    if (dice.chance(0.5)) {
      turn = turned({{}, turn}, vec::mul(dice.direction(), dice.uniform(0, 0.4))).turn;
    }
    add(time, next);
    if (dice.chance(0.3)) {
      time += dice.uniform(0.05, 0.3);
      add(time, next);
    }
    at = next;
  }
  return path;
}

}  // namespace

std::string LiveFindings::fault() const {
  if (not_finite > 0) return fmt::format("the force on a hand was no finite number in {} ticks", not_finite);
  if (above_limit > 0) return fmt::format("the force on a hand was above the limits of its device in {} ticks", above_limit);
  if (least_energy < 0) return fmt::format("a device was given {:.3g} J more than its allowance", -least_energy);
  return {};
}

LiveTools::LiveTools(std::int64_t number, const Simulation& simulation, double seconds) {
  std::vector<ContactTool> tools = simulation.contact().tools();  // faces of blades come last
  std::erase_if(tools, is_face);
  Dice dice(number ^ 0x7f4a7c159e37);  // of its own: the rest of a scene stays what it was
  if (tools.empty() || !dice.chance(0.5)) return;
  const std::size_t most = std::min<std::size_t>(tools.size(), 1 + dice.below(2)), first = dice.below(tools.size());
  const vec::Box box = box_of(simulation.model());
  for (std::size_t i = 0; i < most; ++i) {
    const std::size_t tool = (first + i) % tools.size();
    const Pose start = simulation.contact().pose(tool, simulation.time());
    HandOptions options;
    options.path = stroke(dice, start, box, seconds);
    options.limits = kLimits;
    Hand hand;
    hand.instrument = std::make_unique<Instrument>(tools[tool].name, static_cast<std::int32_t>(1 + dice.below(3)), 1);
    hand.device = std::make_unique<SimulatedHand>(options);
    hand.core = std::make_unique<HapticCore>(core_options(), start);
    feel(hand, kTick, true);
    hands_.push_back(std::move(hand));
  }
}

/// Its ticks between two frames.
void LiveTools::feel(Hand& hand, double seconds, bool first) {
  double age = 0;
  for (double t = seconds; t >= kTick * (1 - 1e-9); t -= kTick) {
    const CoreTick& tick = hand.core->tick(hand.device->read(), first ? 1e9 : age, kTick);
    hand.device->write(tick.exerted);
    hand.device->advance(kTick);
    hand.instrument->hand.publish(hand.core->pose());
    age += kTick;
    ++findings_.ticks;
    const double force = vec::norm(tick.exerted.force), torque = vec::norm(tick.exerted.torque);
    if (!std::isfinite(force) || !std::isfinite(torque)) {
      ++findings_.not_finite;
    } else if (force > kLimits.force * (1 + 1e-12) || torque > kLimits.torque * (1 + 1e-12)) {
      ++findings_.above_limit;
    }
    findings_.largest_force = std::max(findings_.largest_force, force);
  }
  const PassivityGate& gate = hand.core->gate();
  findings_.least_energy =
      std::min({findings_.least_energy, gate.translation().observer().least(), gate.rotation().observer().least()});
}

void LiveTools::frame(Simulation& simulation, double seconds) {
  for (Hand& hand : hands_) {
    if (hand.instrument->before(simulation, seconds)) ++findings_.poses_refused;
  }
  const double end = simulation.time() + seconds;
  while (!simulation.divergence()) {
    const auto left = static_cast<std::int64_t>(std::floor((end - simulation.time()) / simulation.dt() + 1e-6));
    if (left < 1) break;
    simulation.advance(simulation.next_batch(std::min<std::int64_t>(left, 64)));
    if (!simulation.divergence()) simulation.watch_energy();
  }
  if (simulation.divergence()) return;
  owed_ += seconds;
  const double now = kTick * std::floor(owed_ / kTick * (1 + 1e-12));
  owed_ -= now;
  for (Hand& hand : hands_) {
    hand.instrument->after(simulation);
    if (hand.instrument->tissue.take()) {
      const BufferMessage& message = hand.instrument->tissue.newest();
      hand.core->receive(message, seconds);
      hand.instrument->in_use.store(hand.core->buffer().in_use());
      findings_.buffers = std::max(findings_.buffers, static_cast<std::int64_t>(message.generation));
    }
    feel(hand, now, false);
  }
}

}  // namespace pliant::bench
