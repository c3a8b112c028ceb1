#include "haptics/passivity.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace pliant::haptics {

void PassivityObserver::moved(const Vec3d& step, double dt) noexcept {
  if (dt <= 0) return;
  energy_ += options_.damping * vec::dot(step, step) / dt - vec::dot(held_, step);
  least_ = std::min(least_, energy_);
}

double PassivityController::most_taken(const Vec3d& velocity, const Vec3d& force, double dt) const noexcept {
  const double size = vec::norm(force), uncertain = options_.acceleration * dt * dt / 2;
  const double least_step = std::max(vec::norm(velocity) * dt - uncertain, 0.0);
  double taken = vec::dot(force, velocity) * dt + size * uncertain;
  if (options_.damping > 0) {
    taken -= options_.damping * least_step * least_step / dt;
    taken = std::min(taken, size * size * dt / (4 * options_.damping));
  }
  return taken;
}

Vec3d PassivityController::tick(const Vec3d& step, const Vec3d& velocity, const Vec3d& force, double dt) noexcept {
  if (!(dt > 0)) return force;
  observer_.moved(step, dt);
  const double energy = observer_.energy(), speed = vec::norm(velocity);
  Vec3d out = force;
  double taken = most_taken(velocity, out, dt);
  const double uncertain = options_.acceleration * dt / 2;  // of the mean velocity in the tick
  if (taken > energy && speed > uncertain) {
    const double along = std::max(vec::dot(force, velocity) / speed, 0.0);
    double less = std::min((taken - std::max(energy, 0.0)) / (speed * dt), along);
    if (energy < 0) less += std::min(-energy / ((speed - uncertain) * dt), options_.limit);
    out = vec::sub(out, vec::mul(velocity, less / speed));
    taken = most_taken(velocity, out, dt);
  }
  if (taken > std::max(energy, 0.0)) out = vec::mul(out, std::max(energy, 0.0) / taken);
  if (out != force) ++corrections_;
  observer_.exert(vec::finite(out) ? out : Vec3d{});
  return out;
}

Wrench PassivityGate::tick(const Pose& device, const Vec3d& velocity, const Vec3d& spin, const Wrench& wrench,
                           double dt) noexcept {
  if (!good_pose(device) || !vec::finite(velocity) || !vec::finite(spin)) {
    exerted({});
    return {};
  }
  const Vec3d step = started_ ? vec::sub(device.position, before_.position) : Vec3d{};
  const Vec3d turn = started_ ? turn_between(before_, device) : Vec3d{};
  before_ = device;
  started_ = true;
  return {translation_.tick(step, velocity, wrench.force, dt), rotation_.tick(turn, spin, wrench.torque, dt)};
}

void PassivityGate::exerted(const Wrench& wrench) noexcept {
  translation_.exerted(wrench.force);
  rotation_.exerted(wrench.torque);
}

}  // namespace pliant::haptics
