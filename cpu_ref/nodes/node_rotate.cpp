// Twin of kernels/nodes/node_rotate.cl.
#include <cmath>

#include "cpu_ref/nodes/integrator.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Number>
void node_rotate(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* rotated_node,
                 const std::int32_t* rotated_axes, const std::int32_t* rotated_curve, const Scalar* rotated_cosine,
                 const Scalar* rotated_sine, const Scalar* curve_value, std::int32_t curves, std::int32_t step) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar* u = node_u + std::int64_t{4} * rotated_node[i];
    Scalar* w = node_w + std::int64_t{4} * rotated_node[i];
    for (int c = 0; c < 3; ++c) {
      if ((rotated_axes[i] >> c & 1) == 0) continue;
      const Scalar p = rotated_cosine[4 * i + c], q = rotated_sine[4 * i + c];
      const Scalar* now = curve_value + std::int64_t{step} * curves + rotated_curve[3 * i + c];
      const Scalar* next = now + curves;
      u[c] = std::fma(p, next[0], q * next[1]);
      const auto kept = [](Scalar from, Scalar to) { return StepForm<Number>::w_of(from, to); };
      w[c] = std::fma(p, kept(now[0], next[0]), q * kept(now[1], next[1]));
    }
  }
}

void register_node_rotate(Registry& registry) {
  registry.add_specialised<integrator_count>(
      "node_rotate", {"INTEGRATOR"}, [](auto scalar, auto integrator) { return node_rotate<decltype(scalar), integrator()>; });
}

}  // namespace pliant::ref
