// Tool forces on contact points, first part, after the trial step; x is the point's position after it, d its depth, s its slip.
//   Soft shell (Hunt and Crossley 1975), explicit: f = A lambda d0^n (1 + 3/2 alpha v) >= 0, with the depth d0 at the start of the step and
//   its rate v, limited to half of the force that would remove d0 in one step.
//   Core: the part of d beyond the shell is removed: f = A rest / W, W = b sum_j c_j s_j / m_j, with the sum s_j of the areas of all points
//   at node j times their weights. W bounds a row sum of the compliance matrix (Gershgorin), so that points with common nodes never
//   overshoot together.
//   Friction: towards the anchor, where the point stuck first, f = min(mu f_n, A |x - anchor| / W).
// GRIPS: contact_grip.cl; such a point is pulled to its place instead.
// contact_share: 8 planes c_j s_j [m^2]; held nodes have 0, and their part is distributed to the others, so that a point with held nodes is as stiff
// as any other; contact_anchor: (position in the tool's frame (3) [m], tool + 1); contact_force: (force (3) [quanta], one bit per touching tool).
#include "arith.cl"
#include "texels.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "contact_sum.cl"
#include "touch_point.cl"
#include "contact_patch.cl"
#include "contact_edge.cl"
#include "tool_lanes.cl"
#include "press_lanes.cl"
#include "corner_lanes.cl"
#include "contact_grip.cl"

// Adds friction towards the anchors of this tool, at most `most`; points without an anchor get one at `place`.
INLINE vec3 press_friction(integer hit, int t, __global const float* next, __global float* anchor, meetings m, vec3 place, real stiffness, real most, vec3 f) {
  const real own = (float)(t + 1), none = 0.0f;
  const integer fresh = hit && LOAD(anchor, 3 * PLIANT_TILE) == none;
  put3(fresh, place, anchor);
  put_real(fresh, own, anchor, 3);
  const integer sticks = hit && LOAD(anchor, 3 * PLIANT_TILE) == own;
  const vec3 side = slip_on_tool(next, anchor, m).side;
  const real length = sqrt(dot_lanes(side, side)), factor = stiffness * length > most ? most / length : stiffness;
  return where(sticks, times_add(-factor, side, f), f);
}

__kernel void contact_press(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                            __global const int* contact_node, __global const float* contact_weight,
                            __global const float* contact_share, __global const float* contact_held, __global const int* contact_list,
                            __global const int* contact_near, __global float* contact_yield,
                            __global float* contact_anchor, __global float* contact_start, __global int* contact_force, __global int* contact_tool_force, __global const int* tool_kind,
                            __global const float* tool_data, __global const float* tool_grid, __global const float* tool_edge,
                            __global const float* tool_pose, __global const float* touch_surface, __global const float* contact_patch,
                            __global float* contact_corner_weight, __global int* contact_corner_force,
                            __global const float* contact_params, __global const float* step_params, int point_count, int tools, int step) {
  const int first = FIRST_LISTED(contact_list);
  if (first < 0) return;
  const int near = contact_near[first / PLIANT_TILE];
  if (near == 0) return;
  const float h = step_params[0], half_hh = (0.5f * h) * h, margin = contact_params[5];
  const point_lanes p = places_of_points(node_u, node_w, contact_rest, contact_node, contact_weight, first);
  const real area = LOAD(contact_rest, POINT_BASE(first, 4) + 3 * PLIANT_TILE), known = LOAD(contact_yield, first), none = 0.0f, one = 1.0f;
  const real again = READY_AGAIN, fresh = READY_NEW, within = known > 0.0f ? again : fresh;
  const integer zero = 0, wanted = area > 0.0f;  // 0 for padding
  __global float* anchor = contact_anchor + POINT_BASE(first, 4);
  __global float* start = contact_start + POINT_BASE(first, 2);
  patch_meeting patches[EDGES ? LANES : 1];
  int counted[LANES];
  for (int l = 0; l < LANES; ++l) counted[l] = 0;
  integer touching = zero, gripped = zero, out = zero, ready = zero;
  real count = none;
  int weighed = 0, tool = -1;  // tool: of the last meetings
  tool_meetings met;
  for (int t = 0; t < tools; ++t) {
    if (!(near >> t & 1)) continue;
    met = meet_tool(MEET_VALUES, t, first, wanted, p, patches);
    tool = t;
    const integer soon = wanted && may_touch_next(met.m, margin, within), bit = 1 << t;
    ready = pick(soon, (integer)(PLIANT_READY_BIT), ready);
    if (EDGES) write_weights(contact_corner_weight, contact_weight, first, wanted, soon, weighed, counted, patches);
    weighed = 1;
    integer hit = wanted && met.m.distance < none;
    if (GRIPS) {
      const integer held_fast = wanted && grips(contact_held, anchor, tool_pose, tools, step, t, first, met, margin);
      out |= pick(wanted && slipped(anchor, tool_pose, tools, step, t, met.m, margin), bit, zero);
      gripped |= pick(held_fast, bit, zero);
      hit = hit || held_fast;
    }
    touching |= pick(hit, bit, zero);
    count = hit ? count + one : count;
  }
  const integer stuck_to = TO_INTEGER(LOAD(anchor, 3 * PLIANT_TILE)) - 1;
  put_real(stuck_to >= 0 && (touching >> stuck_to & 1) == 0, none, anchor, 3);
  if (GRIPS) let_go(anchor, gripped, out);
  real lag = none, lag_in = none, w = known;
  const vec3 no_vec = {none, none, none};
  const quanta3 nothing = {zero, zero, zero};
  quanta3 sum = nothing;
  const integer unknown = touching != 0 && !(w > 0.0f);
  if (ANY(unknown)) {
    w = unknown ? yield_of_all(node_u, node_w, contact_node, contact_share, first, half_hh) : w;
    STORE(w, contact_yield, first);
  }
  const real whole = w > 0.0f ? area / (w * count) : none;
  if (EDGES) clear_corners(contact_corner_force, first);
  for (int t = 0; t < tools; ++t) {
    if (!(near >> t & 1)) continue;
    __global int* on_tool = tool_force_of(contact_tool_force, point_count, t, first);
    const integer hit = (touching >> t & 1) != 0;
    STORE(touching >> t & 1, on_tool, 7 * PLIANT_TILE);
    if (!ANY(hit)) continue;
    if (tool != t) met = meet_tool(MEET_VALUES, t, first, wanted, p, patches);
    tool = t;
    const real stiffness = (whole * met.share) * met.ease, opening = met.m.opening;
    __global const float* data = tool_data + TOOL_NUMBERS * t;
    const real held = held_depth(node_u, contact_node, contact_weight, contact_share, contact_held, first, met);
    const real beyond = -met.m.distance - held, own = start_depth(start, t, beyond + opening, given_back(tool_kind, contact_params, t)), tool_number = (float)(t + 1);
    const integer later = hit && own > lag;
    lag = later ? own : lag;
    lag_in = later ? tool_number : lag_in;
    const real depth = beyond - own;
    const real shell = shell_push(data, area, stiffness, depth + opening, opening, h);
    const real rest = stiffness > 0.0f ? depth - shell / stiffness - data[15] : none, push = rest > 0.0f ? fma(stiffness, rest, shell) : shell;
    vec3 f = times(push, met.m.normal);
    __global const float* now = tool_pose + POSE_NUMBERS * (step * tools + t);
    __global const float* next = now + POSE_NUMBERS * tools;
    const vec3 place = turned_back_lanes(now, less_origin(sub(p.now, p.moved), now));
    integer slides = hit;
    if (GRIPS) {
      const real holds = GRIPPED_BY(t);
      const integer takes = (gripped >> t & 1) != 0 && LOAD(anchor, 3 * PLIANT_TILE) >= 0.0f;  // the first tool that reaches it holds it
      put3(takes, place, anchor);
      put_real(takes, holds, anchor, 3);
      const integer held_fast = hit && LOAD(anchor, 3 * PLIANT_TILE) == holds;
      f = where(held_fast, times(-stiffness, grip_slip(next, anchor, met.m)), f);
      slides = hit && !held_fast;
    }
    if (data[14] > 0.0f) f = press_friction(slides, t, next, anchor, met.m, place, stiffness, data[14] * push, f);
#if EDGES
    const vec3 slid = times_add(-dot_lanes(met.m.slip, met.m.normal), met.m.normal, met.m.slip);
    f = where(met.edged && push > 0.0f, times_add(-(SAME(EDGE_DRAG) * stiffness), slid, f), f);
#endif
    for (int c = 0; c < 6; ++c) put(hit, zero, on_tool, c);
    const real depth_before = opening - met.m.distance;
    put(hit, AS_INTEGER(depth_before > 0.0f ? depth_before : none), on_tool, 6);
    add_tool_force(hit, on_tool, next, contact_params, met, p.now, f, no_vec, nothing, contact_corner_force, first, patches, &sum);
  }
  STORE(lag, start, 0);
  STORE(lag_in, start, PLIANT_TILE);
  __global int* force = contact_force + POINT_BASE(first, 4);
  STORE(sum.x, force, 0);
  STORE(sum.y, force, PLIANT_TILE);
  STORE(sum.z, force, 2 * PLIANT_TILE);
  STORE(touching | ready, force, 3 * PLIANT_TILE);
}
