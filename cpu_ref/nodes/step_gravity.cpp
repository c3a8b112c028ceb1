// Twin of kernels/nodes/step_gravity.cl.
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void step_gravity(Range range, Scalar* step_now, const Scalar* step_params, const Scalar* curve_value, std::int32_t curves,
                  std::int32_t curve, std::int32_t step) {
  const Scalar factor = curve_value[std::int64_t{step} * curves + curve];
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const bool gravity = i >= 1 && i <= 3;
    step_now[i] = gravity ? step_params[i] * factor : step_params[i];
  }
}

void register_step_gravity(Registry& registry) { registry.add("step_gravity", step_gravity<float>, step_gravity<double>); }

}  // namespace pliant::ref
