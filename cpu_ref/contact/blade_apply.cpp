// Twin of kernels/contact/blade_apply.cl.
#include <cmath>

#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void blade_apply(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* blade_slot, const std::int32_t* blade_free,
                 const std::int32_t* blade_first, const std::int32_t* blade_entry, const Scalar* blade_weight,
                 const Scalar* blade_force, const Scalar* step_params, std::int32_t samples, std::int32_t step) {
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h;
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int32_t slot = blade_slot[i], free = blade_free[i];
    if (slot < 0 || free == 0) continue;
    Scalar f[3] = {0, 0, 0};
    for (std::int32_t k = blade_first[i]; k < blade_first[i + 1]; ++k) {
      const std::int32_t entry = blade_entry[k];
      const Scalar* force = blade_force + 4 * (std::int64_t{step} * samples + entry / 8);
      for (int c = 0; c < 3; ++c) f[c] = std::fma(blade_weight[entry], force[c], f[c]);
    }
    Scalar* u = node_u + std::int64_t{4} * slot;
    Scalar* w = node_w + std::int64_t{4} * slot;
    const Scalar bm = std::fma(half_hh, w[3], half_hh) * u[3];
    for (int c = 0; c < 3; ++c) {
      if ((free >> c & 1) == 0) continue;
      u[c] = std::fma(bm, f[c], u[c]);
      w[c] = std::fma(bm, f[c], w[c]);
    }
  }
}

void register_blade_apply(Registry& registry) { registry.add("blade_apply", blade_apply<float>, blade_apply<double>); }

}  // namespace pliant::ref
