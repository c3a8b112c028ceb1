#include "haptics/hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "haptics/coupling.h"
#include "pliant/error.h"

namespace pliant::haptics {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

Matrix3 product_of(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

/// Taylor's series at a norm of at most 1/4, where 14 terms reach rounding, and squarings.
Matrix3 exponential_of(Matrix3 a) {
  double norm = 0;
  for (const auto& row : a) norm = std::max(norm, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
  int squarings = 0;
  for (; norm > 0.25 && squarings < 60; ++squarings) norm /= 2;
  const double scale = std::ldexp(1.0, -squarings);
  for (auto& row : a) {
    for (double& c : row) c *= scale;
  }
  Matrix3 sum{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Matrix3 term = sum;
  for (int n = 1; n <= 14; ++n) {
    term = product_of(term, a);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) sum[i][j] += term[i][j] /= n;
    }
  }
  for (int s = 0; s < squarings; ++s) sum = product_of(sum, sum);
  return sum;
}

void check_grip(const Grip& grip, const char* of) {
  const auto good = [](double value) { return value >= 0 && std::isfinite(value); };
  if (!good(grip.mass) || grip.mass == 0)
    throw Error(ErrorCode::bad_input, fmt::format("hand: the mass of the {} is {}, allowed is more than 0", of, grip.mass));
  for (const double value : {grip.device_damping, grip.stiffness, grip.damping}) {
    if (!good(value))
      throw Error(ErrorCode::bad_input,
                  fmt::format("hand: a stiffness or damping of the {} is {}, allowed are 0 and more", of, value));
  }
}

Vec3d within_limit(const Vec3d& v, double limit) {
  const double size = vec::norm(v);
  if (!std::isfinite(size)) return {};
  return size > limit ? vec::mul(v, limit / size) : v;
}

}  // namespace

SimulatedHand::SimulatedHand(const HandOptions& options) : options_(options) {
  check_grip(options.translation, "translation");
  check_grip(options.rotation, "rotation");
  path_.path = options.path;
  pose_ = path_.at(0);
}

SimulatedHand::Rows SimulatedHand::over(const Grip& grip, double dt) noexcept {
  // The second unknown is dt y' so that all entries have the unit of y, and the norm is that of the motion within a tick.
  const double per_mass = dt * dt / grip.mass;
  const Matrix3 e = exponential_of(
      {{{0, 1, 0}, {-per_mass * grip.stiffness, -(grip.device_damping + grip.damping) * dt / grip.mass, per_mass}, {0, 0, 0}}});
  return {{{e[0][0], e[0][1] * dt, e[0][2]}, {e[1][0] / dt, e[1][1], e[1][2] / dt}}};
}

void SimulatedHand::place(const Pose& pose, const Vec3d& velocity, const Vec3d& spin) noexcept {
  pose_ = pose;
  velocity_ = velocity;
  spin_ = spin;
}

DeviceSample SimulatedHand::read() noexcept {
  if (options_.wall_time) {
    const auto now = std::chrono::steady_clock::now();
    if (samples_ > 0) advance(std::chrono::duration<double>(now - last_read_).count());
    last_read_ = now;
  }
  return {pose_.position, pose_.turn, time_, 0, ++samples_};
}

void SimulatedHand::write(const DeviceWrench& wrench) noexcept {
  held_ = wrench;
  held_.force = within_limit(wrench.force, options_.limits.force);
  held_.torque = within_limit(wrench.torque, options_.limits.torque);
}

void SimulatedHand::advance(double dt) noexcept {
  if (!(dt > 0)) return;
  if (dt != dt_) {
    dt_ = dt;
    translation_ = over(options_.translation, dt);
    rotation_ = over(options_.rotation, dt);
  }
  const Pose from = path_.at(time_), to = path_.at(time_ + dt), before = pose_;
  const Vec3d offset = vec::sub(pose_.position, from.position), angle = turn_between(from, pose_);
  const Vec3d turn = turn_between(from, to);
  Vec3d new_angle{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double slope = (to.position[c] - from.position[c]) / dt, rate = velocity_[c] - slope;
    const double input = held_.force[c] - options_.translation.device_damping * slope;
    const Rows& t = translation_;
    pose_.position[c] = to.position[c] + t[0][0] * offset[c] + t[0][1] * rate + t[0][2] * input;
    velocity_[c] = slope + t[1][0] * offset[c] + t[1][1] * rate + t[1][2] * input;
    const double turning = turn[c] / dt, of_angle = spin_[c] - turning;
    const double twist = held_.torque[c] - options_.rotation.device_damping * turning;
    const Rows& r = rotation_;
    new_angle[c] = r[0][0] * angle[c] + r[0][1] * of_angle + r[0][2] * twist;
    spin_[c] = turning + r[1][0] * angle[c] + r[1][1] * of_angle + r[1][2] * twist;
  }
  pose_.turn = turned(to, new_angle).turn;
  work_ +=
      vec::dot(held_.force, vec::sub(pose_.position, before.position)) + vec::dot(held_.torque, turn_between(before, pose_));
  time_ += dt;
}

}  // namespace pliant::haptics
