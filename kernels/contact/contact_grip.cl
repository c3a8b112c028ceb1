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

// From the points to where the tool holds them, turned to the world [m].
INLINE vec3 grip_slip(__global const float* next, __global const float* anchor, meetings m) { return turned_lanes(next, sub(m.inside, load3(anchor))); }

// The lanes of points that a tool holds in this step and met at a place that is no edge.
INLINE integer grips(__global const float* contact_held, __global const float* anchor, __global const float* tool_pose, int tools, int step, int t,
                     int first, tool_meetings met, float margin) {
  const integer none = 0;
  if (!(grip_of(tool_pose, tools, step, t) > 0.0f)) return none;
  const real by = LOAD(anchor, 3 * PLIANT_TILE);
  const integer free = !(LOAD(contact_held, POINT_BASE(first, 4) + 3 * PLIANT_TILE) > 0.0f) && !met.edged;
  const vec3 slip = grip_slip(tool_pose + POSE_NUMBERS * ((step + 1) * tools + t), anchor, met.m);
  const integer still = by == GRIPPED_BY(t) && dot_lanes(slip, slip) <= (GRIP_LIMIT * margin) * (GRIP_LIMIT * margin);
  return (free && by < 0.0f && still) || (free && !(by < 0.0f) && met.m.distance < GRIP_REACH * margin);
}

// The lanes of points that have slipped out of a tool that still grips, and are still within its reach.
INLINE integer slipped(__global const float* anchor, __global const float* tool_pose, int tools, int step, int t, meetings m, float margin) {
  const integer none = 0;
  if (!(grip_of(tool_pose, tools, step, t) > 0.0f)) return none;
  return LOAD(anchor, 3 * PLIANT_TILE) == SLIPPED_FROM(t) && m.distance < GRIP_REACH * margin;
}

// Whether forces tear points off the tool: what of them does not press the points against the tool.
INLINE integer tears_off(vec3 f, vec3 normal, real most) {
  const real along = dot_lanes(f, normal), none = 0.0f;
  const vec3 off = times_add(-(along > 0.0f ? along : none), normal, f);
  return dot_lanes(off, off) > most * most;
}

// Lets go of the points that are neither gripped (bits of the tools that hold them) nor `out` (bits of those that they have slipped out of).
INLINE void let_go(__global float* anchor, integer gripped, integer out) {
  const real by = LOAD(anchor, 3 * PLIANT_TILE), none = 0.0f;
  const integer holder = TO_INTEGER(-by - 1.0f), bits = holder < 64 ? gripped >> holder : out >> (holder - 64);
  put_real(by < 0.0f && (bits & 1) == 0, none, anchor, 3);
}
