// Copies step_params for the updates of this step, with gravity times its curve at the start of the step. Runs only in scenes whose gravity has a
// curve; in others the updates read step_params directly. step_now, step_params: [8] time step [s], gravity [m/s^2], and further parameters of the
// host; curve_value: [steps + 1][curves], row `step` is the current time; curve: index of gravity's curve.
#include "arith.cl"

__kernel void step_gravity(__global float* step_now, __global const float* step_params, __global const float* curve_value,
                           int curves, int curve, int step) {
  const int i = (int)get_global_id(0);
  const float value = step_params[i];
  step_now[i] = i >= 1 && i <= 3 ? value * curve_value[step * curves + curve] : value;
}
