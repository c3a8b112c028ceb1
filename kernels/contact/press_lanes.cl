// Forces of a tool on LANES contact points (contact_press, contact_settle): meetings with points and patches, what held nodes and edits leave of a
// depth, friction, grips, and the reaction on the tool.

// The meetings of LANES points with a tool. Where a tool has edges, those of the patches around the points (contact_edge.cl), with all their numbers
// in patches[LANES].
typedef struct {
  meetings m;
  vec3 at;           // where the force acts
  real share, ease;  // fraction of the point's area, and of the force that would remove the depth
  integer edged;     // whether the force acts at `at` instead of the contact point
} tool_meetings;

#define MEET_ARGUMENTS                                                                                                                            \
  __global const float *node_u, __global const float *node_w, __global const float *contact_rest, __global const int *contact_node,                \
      __global const float *contact_weight, __global const int *tool_kind, __global const float *tool_data, __global const float *tool_grid,       \
      __global const float *tool_edge, __global const float *tool_pose, __global const float *touch_surface, __global const float *contact_patch, \
      int tools, int step
#define MEET_VALUES                                                                                                                             \
  node_u, node_w, contact_rest, contact_node, contact_weight, tool_kind, tool_data, tool_grid, tool_edge, tool_pose, touch_surface, contact_patch, \
      tools, step

INLINE float4 lane3(vec3 v, int l) { return (float4)(LANE(v.x, l), LANE(v.y, l), LANE(v.z, l), 0.0f); }
INLINE void set_lane3(vec3* v, int l, float4 x) {
  SET_LANE(v->x, l, x.x);
  SET_LANE(v->y, l, x.y);
  SET_LANE(v->z, l, x.z);
}

// `wanted`: the lanes that have a point.
INLINE tool_meetings meet_tool(MEET_ARGUMENTS, int t, int first, integer wanted, point_lanes p, patch_meeting* patches) {
  const real one = 1.0f;
  const int of_patches = has_edges(tool_kind, t) || is_face(tool_kind, t);
  const integer zero = 0, alone = of_patches ? zero : wanted;
  tool_meetings out = {meet_lanes(tool_kind, tool_data, tool_grid, tool_pose, tools, step, t, alone, p), p.now, one, one, zero};
#if EDGES
  for (int l = 0; l < LANES; ++l) {
    patches[l].share = patches[l].spread_share = 1.0f, patches[l].edged = 0;
    if (!of_patches || !LANE_INT(wanted, l)) continue;
    const contact_place place = {lane3(p.now, l), lane3(p.moved, l)};
    patches[l] = meet_patch(MEET_VALUES, t, first + l, place);
    SET_LANE(out.m.distance, l, patches[l].m.distance);
    SET_LANE(out.m.opening, l, patches[l].m.opening);
    set_lane3(&out.m.normal, l, patches[l].m.normal);
    set_lane3(&out.at, l, patches[l].at);
    SET_LANE(out.share, l, patches[l].share);
    SET_LANE(out.ease, l, patches[l].ease);
    SET_LANE_INT(out.edged, l, patches[l].edged ? -1 : 0);
  }
#endif
  return out;
}

// Lanes that may touch in the next step.
INLINE integer may_touch_next(meetings m, float margin, real share) {
  const real none = 0.0f;
  return m.distance < fma(share, SAME(margin), m.opening < 0.0f ? -m.opening : none);
}

// The depth that points have through their held nodes, where they are inside the tool (a tool pressed over the edge of what is held). They do not give
// way: forces that took it back from the other nodes would never end and, being those of a step, grow as steps get shorter, until the elements between
// are lost. contact_held: [tiles][4][16] the held nodes' undeformed positions times their weights (3) [m], and the sum of these weights.
INLINE real held_depth(__global const float* node_u, __global const int* contact_node, __global const float* contact_weight,
                       __global const float* contact_share, __global const float* contact_held, int first, tool_meetings met) {
  __global const float* held = contact_held + POINT_BASE(first, 4);
  const real part = LOAD(held, 3 * PLIANT_TILE), none = 0.0f;
  if (!ANY(part > 0.0f)) return none;
  vec3 u = {none, none, none};
  for (int a = 0; a < 8; ++a) {
    const int plane = POINT_BASE(first, 8) + a * PLIANT_TILE;
    u = where(LOAD(contact_share, plane) > 0.0f, u, times_add(LOAD(contact_weight, plane), xyz(texels_gather(node_u, contact_node + plane)), u));
  }
  const vec3 rest = load3(held), place = {rest.x + u.x, rest.y + u.y, rest.z + u.z};
  const real distance = fma(part, met.m.distance, dot_lanes(met.m.normal, times_add(-part, met.at, place)));
  return part > 0.0f && distance < 0.0f ? -distance : none;
}

// The depth in tool t that a point had when an edit of its body left it there (it hung on held nodes, or is new): taken back in a step, it would be
// energy from nowhere. It never grows. `start`: depth [m], or -1 of a point that an edit has left, and tool + 1; `before`: depth at the start of the
// step [m]; `given`: by how much it gets less in a step (given_back). A force that the elements balance stands by a depth in proportion to the square
// of the step. Where that has become shorter by a factor r (follow_step), s = 1 - r^2 of this depth becomes part of the depth that is left: `start` is
// then -s, or tool + 1 + s where some depth was left before.
INLINE real start_depth(__global const float* start, int t, real before, float given) {
  const real had = LOAD(start, 0), of = LOAD(start, PLIANT_TILE), whole = floor(of), tool = (float)(t + 1), none = 0.0f;
  const real rest = fma(of - whole, before - had, had - SAME(given));
  const real own = had < 0.0f ? -had * before : (whole == tool ? rest : none), depth = before < own ? before : own;
  return depth > 0.0f ? depth : none;
}
// Faces of blades stand in the middle of what their edge opens; they spread it as pairs of tissue part, by contact_params[8] distances between points
// (twice the margin) per search.
INLINE float given_back(__global const int* tool_kind, __global const float* contact_params, int t) {
  return is_face(tool_kind, t) ? ((2.0f * contact_params[8]) * contact_params[5]) / contact_params[6] : 0.0f;
}

// W of points whose neighbours that touch are not known yet: as if all points around pushed.
INLINE real yield_of_all(__global const float* node_u, __global const float* node_w, __global const int* contact_node,
                         __global const float* contact_share, int first, float half_hh) {
  const real half_of = half_hh;
  real w = 0.0f;
  for (int a = 0; a < 8; ++a) {
    __global const int* node = contact_node + POINT_BASE(first, 8) + a * PLIANT_TILE;
    const real b = fma(half_of, texels_w(texels_gather(node_w, node)), half_of);
    w = fma(LOAD(contact_share, POINT_BASE(first, 8) + a * PLIANT_TILE), b * texels_w(texels_gather(node_u, node)), w);
  }
  return w;
}

// The force of the soft shell (contact_press).
INLINE real shell_push(__global const float* data, real area, real stiffness, real before, real opening, float h) {
  const real none = 0.0f, one = 1.0f, half_of = 0.5f;
  if (!(data[12] > 0.0f)) return none;
  const real spring = (area * data[12]) * (data[16] > 0.0f ? before * sqrt(before) : before);
  const real damped = spring * fma(SAME(data[13]), -opening / h, one), most = half_of * (stiffness * before);
  return before > 0.0f && damped > 0.0f ? (damped < most ? damped : most) : none;
}

// The slip of points from where they stuck, given in the tool's frame, without its part along the normal (`along`).
typedef struct {
  vec3 side;
  real along;
} tool_slip;
INLINE tool_slip slip_on_tool(__global const float* next, __global const float* anchor, meetings m) {
  const vec3 slip = turned_lanes(next, sub(m.inside, load3(anchor)));
  const real along = dot_lanes(slip, m.normal);
  const tool_slip out = {times_add(-along, m.normal, slip), along};
  return out;
}

// Adds the reaction to the tool: minus `force` in the lanes `hit`, at `at`.
INLINE void add_to_tool(integer hit, __global int* on_tool, __global const float* next_pose, __global const float* contact_params, vec3 at,
                        quanta3 force) {
  const vec3 arm = less_origin(at, next_pose);
  const float scale = contact_params[0] * contact_params[3];
  const vec3 f = {TO_REAL(-force.x) * scale, TO_REAL(-force.y) * scale, TO_REAL(-force.z) * scale};
  put(hit, LOAD(on_tool, 0) - force.x, on_tool, 0);
  put(hit, LOAD(on_tool, PLIANT_TILE) - force.y, on_tool, 1);
  put(hit, LOAD(on_tool, 2 * PLIANT_TILE) - force.z, on_tool, 2);
  put(hit, LOAD(on_tool, 3 * PLIANT_TILE) + quanta_of(fma(arm.y, f.z, -(arm.z * f.y))), on_tool, 3);
  put(hit, LOAD(on_tool, 4 * PLIANT_TILE) + quanta_of(fma(arm.z, f.x, -(arm.x * f.z))), on_tool, 4);
  put(hit, LOAD(on_tool, 5 * PLIANT_TILE) + quanta_of(fma(arm.x, f.y, -(arm.y * f.x))), on_tool, 5);
}

// Notes the work by which a face spreads points that still lie deeper in it by `lag` (contact_sum.cl), with both parts of its force.
INLINE void spread_by_face(integer hit, __global int* on_tool, __global const float* contact_params, real lag, vec3 normal, float given) {
  const real none = 0.0f;
  const vec3 f = {TO_REAL(-LOAD(on_tool, 0)), TO_REAL(-LOAD(on_tool, PLIANT_TILE)), TO_REAL(-LOAD(on_tool, 2 * PLIANT_TILE))};
  const real push = dot_lanes(f, normal) * SAME((given * SPREAD_PARTS) / contact_params[5]);
  put(hit, 2 * quanta_of(lag > none && push > none ? push : none) + 1, on_tool, 7);
}
