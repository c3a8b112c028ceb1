// Twin of kernels/nodes/node_prescribe.cl.
#include "cpu_ref/nodes/integrator.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Number>
void node_prescribe(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* prescribed_node,
                    const std::int32_t* prescribed_axes, const std::int32_t* prescribed_curve, const Scalar* prescribed_target,
                    const Scalar* curve_value, std::int32_t curves, std::int32_t step) {
  const Scalar* now = curve_value + std::int64_t{step} * curves;
  const Scalar* next = now + curves;
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar* u = node_u + std::int64_t{4} * prescribed_node[i];
    Scalar* w = node_w + std::int64_t{4} * prescribed_node[i];
    for (int c = 0; c < 3; ++c) {
      if ((prescribed_axes[i] >> c & 1) == 0) continue;
      const Scalar target = prescribed_target[4 * i + c];
      const std::int32_t curve = prescribed_curve[3 * i + c];
      u[c] = target * next[curve];
      w[c] = target * StepForm<Number>::w_of(now[curve], next[curve]);
    }
  }
}

void register_node_prescribe(Registry& registry) {
  registry.add_specialised<integrator_count>("node_prescribe", {"INTEGRATOR"}, [](auto scalar, auto integrator) {
    return node_prescribe<decltype(scalar), integrator()>;
  });
}

}  // namespace pliant::ref
