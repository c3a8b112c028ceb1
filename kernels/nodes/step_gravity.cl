// What the updates of this step take from step_params, with gravity times its curve at the step's beginning. Only scenes whose
// gravity has a curve run it; the updates of others read step_params itself.
// step_now, step_params: [8] time step [s], gravity [m/s^2], and what the host keeps behind it; curve_value: [steps +
// 1][curves], the row of the present time is `step`; curve: which of the curves.
#include "arith.cl"

__kernel void step_gravity(__global float* step_now, __global const float* step_params, __global const float* curve_value,
                           int curves, int curve, int step) {
  const int i = (int)get_global_id(0);
  const float value = step_params[i];
  step_now[i] = i >= 1 && i <= 3 ? value * curve_value[step * curves + curve] : value;
}
