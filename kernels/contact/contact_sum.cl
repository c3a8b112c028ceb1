// Forces of each contact point on each tool, in quanta. contact_tool_force: [tools][tiles][8][16] force on the tool (3), torque about its origin (3),
// depth at the start of the step [m] as bits, 1 if it touches (plus twice the work by which a face of a blade spreads what its edge has opened, in
// quanta of force times 1 / SPREAD_PARTS of the margin). Written for the tools that are near the point's tile (contact_near); contact_tool_sum
// adds them. They are integers, so the order does not matter.
#define TOOL_FORCE_NUMBERS 8
#define SPREAD_PARTS 64.0f

static inline __global int* tool_force_of(__global int* contact_tool_force, int point_count, int t, int i) {
  return contact_tool_force + TOOL_FORCE_NUMBERS * point_count * t + POINT_BASE(i, TOOL_FORCE_NUMBERS);
}
