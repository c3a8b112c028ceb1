#include "haptics/coupling.h"

#include <fmt/format.h>

#include <cmath>

#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant::haptics {
namespace {

/// New velocity of a mass m under an explicit force and an implicit spring and damper whose other end is `stretch` away [m;
/// rad] and moves at `pull`. `on_hand`: what both exert on that end.
Vec3d pulled(double mass, double stiffness, double damping, const Vec3d& velocity, const Vec3d& force, const Vec3d& stretch,
             const Vec3d& pull, double dt, Vec3d& on_hand) {
  const double whole = mass + dt * damping + dt * dt * stiffness;
  Vec3d next{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double impulse = dt * (force[c] + stiffness * stretch[c] + damping * pull[c]);
    next[c] = whole > 0 ? (mass * velocity[c] + impulse) / whole : pull[c];
    on_hand[c] = -stiffness * (stretch[c] - dt * next[c]) - damping * (pull[c] - next[c]);
  }
  return next;
}

void require_not_negative(bool good, const char* what, double value) {
  if (!good) throw Error(ErrorCode::bad_input, fmt::format("coupling: {} is {}, allowed are 0 and more", what, value));
}

}  // namespace

std::array<double, 4> turn_by(const Vec3d& rotation) noexcept {
  const double angle = vec::norm(rotation), half = angle / 2;
  const double share = angle > 1e-9 ? std::sin(half) / angle : 0.5;
  return {share * rotation[0], share * rotation[1], share * rotation[2], std::cos(half)};
}

Pose turned(const Pose& pose, const Vec3d& rotation) noexcept {
  std::array<double, 4> q = compose({{}, turn_by(rotation)}, {{}, pose.turn}).turn;
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& c : q) c /= size;
  return {pose.position, q};
}

CouplingOptions passive_coupling(double damping, double turn_damping, double tick) {
  CouplingOptions options;
  options.stiffness = 0.9 * damping / tick;
  options.damping = 0.45 * damping;
  options.turn_stiffness = 0.9 * turn_damping / tick;
  options.turn_damping = 0.45 * turn_damping;
  return options;
}

VirtualCoupling::VirtualCoupling(const CouplingOptions& options, double tick) : options_(options) {
  const auto check = [](const char* what, double value) {
    require_not_negative(value >= 0 && std::isfinite(value), what, value);
  };
  check("tick", tick);
  check("stiffness", options.stiffness);
  check("damping", options.damping);
  check("turn_stiffness", options.turn_stiffness);
  check("turn_damping", options.turn_damping);
  check("mass", options.mass);
  check("inertia", options.inertia);
  if (options_.mass == 0) options_.mass = options_.stiffness * tick * tick;
  if (options_.inertia == 0) options_.inertia = options_.turn_stiffness * tick * tick;
}

void VirtualCoupling::place(const Pose& instrument) noexcept {
  pose_ = instrument;
  velocity_ = spin_ = {};
}

double VirtualCoupling::stable_contact(double dt) const noexcept {
  return 4 * options_.mass / (dt * dt) + 2 * options_.damping / dt + options_.stiffness;
}

Coupled VirtualCoupling::step(const Pose& device, const Vec3d& velocity, const Vec3d& spin, const Wrench& contact,
                              double dt) noexcept {
  if (options_.rigid) {
    pose_ = device;
    on_hand_ = contact;
  }
  if (options_.rigid || !(dt > 0)) return {pose_, on_hand_};
  const CouplingOptions& o = options_;
  velocity_ = pulled(o.mass, o.stiffness, o.damping, velocity_, contact.force, vec::sub(device.position, pose_.position),
                     velocity, dt, on_hand_.force);
  spin_ = pulled(o.inertia, o.turn_stiffness, o.turn_damping, spin_, contact.torque, turn_between(pose_, device), spin, dt,
                 on_hand_.torque);
  pose_.position = vec::add(pose_.position, vec::mul(velocity_, dt));
  pose_ = turned(pose_, vec::mul(spin_, dt));
  if (!vec::finite(velocity_) || !vec::finite(spin_) || !good_pose(pose_)) place(device);
  return {pose_, on_hand_};
}

}  // namespace pliant::haptics
