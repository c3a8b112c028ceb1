// Twin of kernels/contact/blade_press.cl, which describes the computation.
#include <cmath>

#include "cpu_ref/contact/contact_shape.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

namespace {

constexpr std::int64_t kBladeData = 12, kBladePose = 6;

template <class Scalar>
contact::Vec<Scalar> edge_at(const Scalar* pose, Scalar place) {
  contact::Vec<Scalar> x;
  for (std::size_t c = 0; c < 3; ++c) x[c] = std::fma(place, pose[3 + c], pose[c]);
  return x;
}

/// Where the front point of a sample is, how far its nodes moved in the step, and its compliance.
template <class Scalar>
struct FrontPoint {
  contact::Vec<Scalar> x{}, moved{};
  Scalar w = 0;

  FrontPoint(const Scalar* node_u, const Scalar* node_w, const std::int32_t* node, const Scalar* weight, const Scalar* share,
             const Scalar* data, Scalar half_hh)
      : x{data[0], data[1], data[2]} {
    for (std::size_t a = 0; a < 8; ++a) {
      const Scalar* u = node_u + std::int64_t{4} * node[a];
      const Scalar* v = node_w + std::int64_t{4} * node[a];
      for (std::size_t c = 0; c < 3; ++c) {
        x[c] = std::fma(weight[a], u[c], x[c]);
        moved[c] = std::fma(weight[a], v[c], moved[c]);
      }
      w = std::fma(share[a], std::fma(half_hh, v[3], half_hh) * u[3], w);
    }
  }
};

}  // namespace

template <class Scalar>
void blade_press(Range range, const Scalar* node_u, const Scalar* node_w, const std::int32_t* blade_node,
                 const Scalar* blade_weight, const Scalar* blade_share, const Scalar* blade_data, const Scalar* blade_pose,
                 Scalar* blade_front, Scalar* blade_force, const Scalar* step_params, std::int32_t samples, std::int32_t blades,
                 std::int32_t step) {
  using namespace contact;
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h;
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const Scalar* data = blade_data + kBladeData * i;
    Scalar* out = blade_force + 4 * (std::int64_t{step} * samples + i);
    const Scalar most = data[6];
    Vec<Scalar> f{};
    Scalar push = 0;
    if (most >= Scalar(0)) {
      const FrontPoint<Scalar> p(node_u, node_w, blade_node + 8 * i, blade_weight + 8 * i, blade_share + 8 * i, data, half_hh);
      const Scalar* pose = blade_pose + kBladePose * (std::int64_t{step} * blades + static_cast<std::int64_t>(data[9]));
      const Vec<Scalar> before = edge_at(pose, data[8]), now = edge_at(pose + kBladePose * blades, data[8]);
      const Vec<Scalar> n{data[3], data[4], data[5]};
      const Scalar gap = dot(Vec<Scalar>{now[0] - p.x[0], now[1] - p.x[1], now[2] - p.x[2]}, n) - blade_front[2 * i];
      if (gap > Scalar(0) && p.w > Scalar(0)) {
        push = gap / p.w;
        if (push > most) {
          push = most;
          blade_front[2 * i] += gap - std::fma(most, p.w, Scalar(0));  // the rounded product, as in the kernel
        }
        blade_front[2 * i + 1] += Scalar(1);
        Vec<Scalar> slip, side;
        for (std::size_t c = 0; c < 3; ++c) {
          f[c] = n[c] * push;
          slip[c] = p.moved[c] - (now[c] - before[c]);
        }
        const Scalar along = dot(slip, n);
        for (std::size_t c = 0; c < 3; ++c) side[c] = std::fma(-along, n[c], slip[c]);
        const Scalar length = std::sqrt(dot(side, side)), hold = data[7] * push;
        if (hold > Scalar(0) && length > Scalar(0)) {
          const Scalar pull = length / p.w, factor = (pull < hold ? pull : hold) / length;
          for (std::size_t c = 0; c < 3; ++c) f[c] = std::fma(-factor, side[c], f[c]);
        }
      }
    }
    for (std::size_t c = 0; c < 3; ++c) out[c] = f[c];
    out[3] = push;
  }
}

void register_blade_press(Registry& registry) { registry.add("blade_press", blade_press<float>, blade_press<double>); }

}  // namespace pliant::ref
