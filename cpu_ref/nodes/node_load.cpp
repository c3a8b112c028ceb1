// Twin of kernels/nodes/node_load.cl.
#include <cmath>

#include "cpu_ref/registry.h"
#include "layout.h"

namespace pliant::ref {

template <class Scalar>
void node_load(Range range, Scalar* node_load, const std::int32_t* load_node, const std::int32_t* load_offset,
               const Scalar* load_force, const std::int32_t* load_curve, const std::int32_t* load_triangle,
               const Scalar* load_weight, const std::int32_t* load_corner, const Scalar* pressure_force,
               const Scalar* corner_force, const Scalar* curve_value, std::int32_t curves, std::int32_t step) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int32_t* first = load_offset + 3 * i;
    const std::int32_t* end = first + 3;
    Scalar f[3] = {0, 0, 0};
    for (std::int64_t k = first[0]; k < end[0]; ++k) {
      const Scalar factor = curve_value[std::int64_t{step} * curves + load_curve[k]];
      for (int c = 0; c < 3; ++c) f[c] = std::fma(factor, load_force[4 * k + c], f[c]);
    }
    for (std::int64_t k = first[1]; k < end[1]; ++k) {
      const Scalar* triangle = pressure_force + std::int64_t{4} * load_triangle[k];
      for (int c = 0; c < 3; ++c) f[c] = std::fma(load_weight[k], triangle[c], f[c]);
    }
    for (std::int64_t k = first[2]; k < end[2]; ++k) {
      for (int c = 0; c < 3; ++c) f[c] -= corner_force[load_corner[k] + c * PLIANT_TILE];
    }
    for (int c = 0; c < 3; ++c) node_load[std::int64_t{4} * load_node[i] + c] = f[c];
  }
}

void register_node_load(Registry& registry) { registry.add("node_load", node_load<float>, node_load<double>); }

}  // namespace pliant::ref
