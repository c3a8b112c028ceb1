// Grips. A tool that grips holds every contact point that comes within reach of its surface: the point keeps its place in the tool's frame, pulled
// back by the force that brings it there in one step, whatever its direction, until the tool lets go or the force that would take it off the tool,
// across or away from the surface, exceeds the grip's strength times the point's area: then it has slipped out, and is not gripped again before it has
// left the reach. Points with held nodes, and those that meet an edge of the tool, are not gripped. contact_anchor: the place of a gripped point in
// the tool's frame (3) [m], and -(tool + 1); of one that has slipped out -(tool + 65).
#define GRIP_REACH 0.08f  // of the margin, as far as a point may touch in the next step
#define GRIP_LIMIT 4.0f   // in margins: a point that is further from its place has been lost
#define GRIPPED_BY(t) (-(float)((t) + 1))
#define SLIPPED_FROM(t) (-(float)((t) + 65))

// Strength of the grip in this step [Pa]; 0: it does not grip.
static inline float grip_of(__global const float* tool_pose, int tools, int step, int t) {
  return tool_pose[POSE_NUMBERS * ((step + 1) * tools + t) + 14];
}

// From the point to where the tool holds it, turned to the world [m].
static inline float4 grip_slip(__global const float* next, __global const float* anchor, meeting m) {
  return turned(next, m.inside - (float4)(anchor[0], anchor[PLIANT_TILE], anchor[2 * PLIANT_TILE], 0.0f));
}

// Whether a tool holds point i in this step, which met it at a place that is no edge.
static inline int grips(__global const float* contact_held, __global const float* anchor, __global const float* tool_pose, int tools, int step, int t,
                        int i, meeting m, float margin) {
  if (!(grip_of(tool_pose, tools, step, t) > 0.0f) || contact_held[POINT_BASE(i, 4) + 3 * PLIANT_TILE] > 0.0f) return 0;
  const float by = anchor[3 * PLIANT_TILE];
  if (by < 0.0f && by != GRIPPED_BY(t)) return 0;
  if (by < 0.0f) {
    const float4 slip = grip_slip(tool_pose + POSE_NUMBERS * ((step + 1) * tools + t), anchor, m);
    return dot_xyz(slip, slip) <= (GRIP_LIMIT * margin) * (GRIP_LIMIT * margin);
  }
  return m.distance < GRIP_REACH * margin;
}

// Whether point i has slipped out of a tool that still grips, and is still within its reach.
static inline int slipped(__global const float* anchor, __global const float* tool_pose, int tools, int step, int t, meeting m, float margin) {
  return anchor[3 * PLIANT_TILE] == SLIPPED_FROM(t) && grip_of(tool_pose, tools, step, t) > 0.0f && m.distance < GRIP_REACH * margin;
}

// Whether a force tears a point off the tool: what of it does not press the point against the tool.
static inline int tears_off(float4 f, float4 normal, float most) {
  const float along = dot_xyz(f, normal), push = along > 0.0f ? along : 0.0f;
  const float4 off = fma((float4)(-push), normal, f);
  return dot_xyz(off, off) > most * most;
}
