// Sums of a step over all points of a tool, in quanta, so that no order can matter: tool_sum: [steps][tools][16] force and torque
// about the tool's origin (each component as two numbers, multiples of 2^15 and the rest), area (two), largest depth at the start of the
// step [m] as bits, points.
#define SUM_NUMBERS 16

static inline void add_quanta(__global int* sum, int value) {
  atomic_add(sum, value >> 15);
  atomic_add(sum + 1, value & 32767);
}

// The tool gets what the point does not: minus `force`, `quantum` [N] each, at the place p.
static inline void add_to_tool(__global int* tool_sum, __global const float* tool_pose, __global const float* contact_params, int tools,
                               int step, int t, float4 p, int4 force) {
  __global int* sum = tool_sum + SUM_NUMBERS * (step * tools + t);
  const float4 arm = p - origin_of(tool_pose + POSE_NUMBERS * ((step + 1) * tools + t));
  const float scale = contact_params[0] * contact_params[3];
  const float fx = (float)(-force.x) * scale, fy = (float)(-force.y) * scale, fz = (float)(-force.z) * scale;
  add_quanta(sum, -force.x);
  add_quanta(sum + 2, -force.y);
  add_quanta(sum + 4, -force.z);
  add_quanta(sum + 6, quanta(fma(arm.y, fz, -(arm.z * fy))));
  add_quanta(sum + 8, quanta(fma(arm.z, fx, -(arm.x * fz))));
  add_quanta(sum + 10, quanta(fma(arm.x, fy, -(arm.y * fx))));
}

static inline void add_touch(__global int* tool_sum, __global const float* contact_params, int tools, int step, int t, float area,
                             float depth) {
  __global int* sum = tool_sum + SUM_NUMBERS * (step * tools + t);
  add_quanta(sum + 12, quanta(area * contact_params[4]));
  atomic_max(sum + 14, as_int(depth > 0.0f ? depth : 0.0f));
  atomic_add(sum + 15, 1);
}
