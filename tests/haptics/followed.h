// A hand that follows a stroke with a buffer, beside a simulation whose tool or blade does so in every step.
#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <string>

#include "geometry/vec.h"
#include "haptics/buffer_force.h"
#include "pressed_block.h"

namespace pliant::haptics_test {

using Stroke = std::function<Pose(double)>;

/// The buffer has `rings` and gets the simulation's state every `every` steps, at once, but none after `stall` of all `steps`.
struct Following {
  std::int32_t rings = 3;
  std::int64_t every = 20, steps = 400, stall = std::numeric_limits<std::int64_t>::max();
  bool rebuild = false;   ///< with every state
  std::int64_t from = 0;  ///< step from which differences count
  int ahead = 0;          ///< steps by which the simulation's part is ahead of the hand
};

struct Felt {
  double most = 0, largest = 0, felt = 0;  ///< difference and force of the whole model; the largest that the buffer felt [N]
  Vec3d last{}, last_full{};               ///< force on the hand, and of the whole model, at the end [N]
  std::uint64_t built = 0, resets = 0;
  std::int64_t cuts = 0;
  bool covered = true;
};

inline Felt follow(const Scene& scene, const std::string& name, const Stroke& stroke, const Following& how) {
  using namespace haptics;
  const double dt = 0.8 * simulate(scene)->stable_dt();
  const auto s = simulate(scene, dt);
  BufferSource source(name, how.rings);
  BufferForce force(1);
  std::array<BufferMessage, 2> messages;
  Felt felt;
  source.fill(*s, force.in_use(), messages[1]);
  force.receive(messages[1], dt);
  force.tick(stroke(0), dt);
  s->advance(1);
  for (std::int64_t k = 1; k <= how.steps; ++k) {
    const double t = static_cast<double>(k) * dt;
    const Wrench ticked = force.tick(stroke(t), dt);
    const DrivenPart part = DrivenPart::find(*s, name).value();
    part.drive(*s, stroke(t + how.ahead * dt), dt);
    s->advance(1);
    const Wrench full = part.last(*s).value();
    if (k >= how.from && k <= how.stall) felt.most = std::max(felt.most, vec::norm(vec::sub(ticked.force, full.force)));
    felt.largest = std::max(felt.largest, vec::norm(full.force));
    felt.felt = std::max(felt.felt, vec::norm(ticked.force));
    felt.last = ticked.force;
    felt.last_full = full.force;
    if (k % how.every != 0 || k > how.stall) continue;
    BufferMessage& message = messages[static_cast<std::size_t>(k / how.every) % 2];
    if (how.rebuild) source.set_rings(how.rings + static_cast<std::int32_t>(k / how.every % 2));
    source.fill(*s, force.in_use(), message);
    felt.covered = felt.covered && message.covered;
    force.receive(message, static_cast<double>(how.every) * dt);
    felt.built = message.generation;
  }
  felt.resets = force.resets();
  felt.cuts = s->topology_version();
  return felt;
}

}  // namespace pliant::haptics_test
