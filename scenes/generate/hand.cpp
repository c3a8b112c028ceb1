#include "scenes/generate/hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/generate/surface_nets.h"

namespace pliant {
namespace {

constexpr double kStep = 0.007;  ///< of the surface nets: more than two of them across a finger [m]

/// A cone with round ends.
struct Bone {
  Vec3d from{}, to{};
  double start = 0, end = 0;  ///< radii [m]
};

double distance_to(const Bone& bone, const Vec3d& p) {
  const Vec3d axis = vec::sub(bone.to, bone.from), d = vec::sub(p, bone.from);
  const double t = std::clamp(vec::dot(d, axis) / vec::dot(axis, axis), 0.0, 1.0);
  return vec::norm(vec::sub(d, vec::mul(axis, t))) - (bone.start + t * (bone.end - bone.start));
}

/// Three phalanges, each bent by `bend` [radian] against the one before, in the plane of `along` and -y.
void add_finger(std::vector<Bone>& bones, Vec3d at, const Vec3d& along, double length, double bend) {
  const double share[3] = {0.45, 0.31, 0.24}, radius[4] = {0.0095, 0.009, 0.0085, 0.0078};
  double angle = 0.5 * bend;
  for (std::size_t k = 0; k < 3; ++k, angle += bend) {
    const Vec3d way = vec::add(vec::mul(along, std::cos(angle)), Vec3d{0, -std::sin(angle), 0});
    const Vec3d to = vec::add(at, vec::mul(way, length * share[k]));
    bones.push_back({at, to, radius[k], radius[k + 1]});
    at = to;
  }
}

}  // namespace

TriangleMesh make_hand(int frame) {
  const double s = static_cast<double>(frame) / (hand_frames - 1), bend = (6 + 40 * s) * std::numbers::pi / 180;
  std::vector<Bone> bones;
  const double spread[4] = {0.031, 0.0105, -0.0105, -0.03}, length[4] = {0.074, 0.082, 0.077, 0.06};
  for (std::size_t k = 0; k < 4; ++k) {
    const double aside = 2.5 * spread[k] * (1 - 0.7 * s), forth = std::sqrt(1 - aside * aside);
    bones.push_back({{-0.035, 0.001, 0.6 * spread[k]}, {0.042, 0, spread[k]}, 0.0135, 0.0105});  // of the palm
    add_finger(bones, {0.042, 0, spread[k]}, {forth, 0, aside}, length[k], bend);
  }
  bones.push_back({{-0.03, -0.002, 0.018}, {0.005, -0.008, 0.045}, 0.014, 0.011});
  add_finger(bones, {0.005, -0.008, 0.045}, {0.8, 0, 0.6}, 0.06, 0.6 * bend);
  bones.push_back({{-0.085, 0.002, 0}, {-0.03, 0.001, 0}, 0.02, 0.018});
  const Implicit hand = [bones](const Vec3d& p) {
    double sum = 0;  // of bones that are near, so that skin spans the seams
    for (const Bone& bone : bones) sum += std::exp(-distance_to(bone, p) / 0.0022);
    return -0.0022 * std::log(std::max(sum, 1e-300));
  };
  return surface_nets(hand, {{-0.12, -0.11, -0.07}, {0.15, 0.04, 0.11}}, kStep);
}

}  // namespace pliant
