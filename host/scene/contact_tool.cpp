#include "scene/contact_tool.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace pliant {

std::array<Vec3d, 3> rotation_matrix(const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
          Vec3d{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
          Vec3d{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
}

Vec3d place(const Pose& pose, const Vec3d& y) {
  const std::array<Vec3d, 3> r = rotation_matrix(pose.turn);
  return {vec::dot(r[0], y) + pose.position[0], vec::dot(r[1], y) + pose.position[1], vec::dot(r[2], y) + pose.position[2]};
}

Vec3d place_back(const Pose& pose, const Vec3d& x) {
  const std::array<Vec3d, 3> r = rotation_matrix(pose.turn);
  const Vec3d d = vec::sub(x, pose.position);
  return vec::add(vec::add(vec::mul(r[0], d[0]), vec::mul(r[1], d[1])), vec::mul(r[2], d[2]));
}

Pose compose(const Pose& outer, const Pose& inner) {
  const auto& [ax, ay, az, aw] = outer.turn;
  const auto& [bx, by, bz, bw] = inner.turn;
  return {place(outer, inner.position),
          {aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
           aw * bw - ax * bx - ay * by - az * bz}};
}

namespace {

using Quaternion = std::array<double, 4>;

Quaternion turned_between(const Quaternion& a, Quaternion b, double s) {
  double cosine = 0, norm = 0;
  for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
  if (cosine < 0) {
    for (double& c : b) c = -c;
    cosine = -cosine;
  }
  const double angle = std::acos(std::min(cosine, 1.0)), sine = std::sin(angle);
  const double of_a = sine > 1e-9 ? std::sin((1 - s) * angle) / sine : 1 - s;
  const double of_b = sine > 1e-9 ? std::sin(s * angle) / sine : s;
  Quaternion q{};
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = of_a * a[i] + of_b * b[i];
    norm += q[i] * q[i];
  }
  for (double& c : q) c /= std::sqrt(norm);
  return q;
}

Pose pose_of(const std::array<double, 8>& row) { return {{row[1], row[2], row[3]}, {row[4], row[5], row[6], row[7]}}; }

}  // namespace

bool good_pose(const Pose& pose) {
  double norm = 0;
  for (const double c : pose.turn) norm += c * c;
  return vec::finite(pose.position) && std::abs(std::sqrt(norm) - 1) <= 1e-3;
}

Pose between(const Pose& from, const Pose& to, double s) {
  return {vec::add(vec::mul(from.position, 1 - s), vec::mul(to.position, s)), turned_between(from.turn, to.turn, s)};
}

Vec3d turn_between(const Pose& from, const Pose& to) {
  const auto& [x, y, z, w] = from.turn;
  const Quaternion q = compose({{}, to.turn}, {{}, {-x, -y, -z, w}}).turn;
  const Vec3d axis{q[0], q[1], q[2]};
  const double sine = vec::norm(axis), angle = 2 * std::atan2(sine, std::abs(q[3]));
  return sine > 0 ? vec::mul(axis, std::copysign(angle, q[3]) / sine) : Vec3d{};
}

Pose ContactTool::at(double time) const {
  if (path.empty()) return {};
  const auto after = std::upper_bound(path.begin(), path.end(), time, [](double t, const auto& row) { return t < row[0]; });
  if (after == path.begin()) return pose_of(path.front());
  const Pose left = pose_of(*(after - 1));
  if (after == path.end()) return left;
  const Pose right = pose_of(*after);
  const double s = (time - (*(after - 1))[0]) / ((*after)[0] - (*(after - 1))[0]);
  return between(left, right, s);
}

}  // namespace pliant
