// Twin of kernels/nodes/pressure_force.cl.
#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void pressure_force(Range range, const Scalar* surface_x, const std::int32_t* pressure_triangle, const Scalar* pressure_value,
                    const std::int32_t* pressure_curve, Scalar* pressure_force, const Scalar* curve_value, std::int32_t curves,
                    std::int32_t step) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const Scalar* a = surface_x + std::int64_t{4} * pressure_triangle[3 * i];
    const Scalar* b = surface_x + std::int64_t{4} * pressure_triangle[3 * i + 1];
    const Scalar* c = surface_x + std::int64_t{4} * pressure_triangle[3 * i + 2];
    const Scalar ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2];
    const Scalar gx = c[0] - a[0], gy = c[1] - a[1], gz = c[2] - a[2];
    const Scalar s = Scalar(-0.5) * (pressure_value[i] * curve_value[std::int64_t{step} * curves + pressure_curve[i]]);
    Scalar* out = pressure_force + 4 * i;
    out[0] = s * minor2(ey, gz, ez, gy);
    out[1] = s * minor2(ez, gx, ex, gz);
    out[2] = s * minor2(ex, gy, ey, gx);
    out[3] = Scalar(0);
  }
}

void register_pressure_force(Registry& registry) {
  registry.add("pressure_force", pressure_force<float>, pressure_force<double>);
}

}  // namespace pliant::ref
