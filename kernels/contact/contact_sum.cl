// Forces of each contact point on each tool, in quanta. contact_tool_force: [tools][tiles][8][16] force on the tool (3), torque about its origin (3),
// depth at the start of the step [m] as bits, 1 if it touches. Written for the tools that are near the point's tile (contact_near); contact_tool_sum
// adds them. They are integers, so the order does not matter.
#define TOOL_FORCE_NUMBERS 8

static inline __global int* tool_force_of(__global int* contact_tool_force, int point_count, int t, int i) {
  return contact_tool_force + TOOL_FORCE_NUMBERS * point_count * t + POINT_BASE(i, TOOL_FORCE_NUMBERS);
}

// Adds the reaction to the tool: minus `force`, in units of `quantum` [N], at the place p.
static inline void add_to_tool(__global int* on_tool, __global const float* next_pose, __global const float* contact_params, float4 p,
                               int4 force) {
  const float4 arm = p - origin_of(next_pose);
  const float scale = contact_params[0] * contact_params[3];
  const float fx = (float)(-force.x) * scale, fy = (float)(-force.y) * scale, fz = (float)(-force.z) * scale;
  on_tool[0] -= force.x;
  on_tool[PLIANT_TILE] -= force.y;
  on_tool[2 * PLIANT_TILE] -= force.z;
  on_tool[3 * PLIANT_TILE] += quanta(fma(arm.y, fz, -(arm.z * fy)));
  on_tool[4 * PLIANT_TILE] += quanta(fma(arm.z, fx, -(arm.x * fz)));
  on_tool[5 * PLIANT_TILE] += quanta(fma(arm.x, fy, -(arm.y * fx)));
}
