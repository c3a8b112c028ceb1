// Tool forces on contact points, second part: repeats contact_press at the node positions after contact_apply, with the compliance W of the points
// that actually touch (contact_node_sum). So the penetration that the first part left is removed, whether one point touches or all. The friction
// limit applies to the sum of both parts; where a point slips, its anchor follows. contact_change: the added force [quanta].
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

// W of points, as the points that touch push equally; held nodes count as free (contact_press). weight: 8 planes.
INLINE real yield_of_touching(__global const float* node_u, __global const float* node_w, __global const int* contact_node, __global const float* weight,
                              __global const float* contact_share, __global const float* contact_node_sum, int first, float half_hh) {
  const real half_of = half_hh, none = 0.0f;
  real w = none, all = none, moving = none;
  for (int a = 0; a < 8; ++a) {
    const int plane = POINT_BASE(first, 8) + a * PLIANT_TILE;
    __global const int* node = contact_node + plane;
    const real b = fma(half_of, texels_w(texels_gather(node_w, node)), half_of), c = LOAD(weight, a * PLIANT_TILE);
    const real own = c > 0.0f ? c * texels_w(texels_gather(contact_node_sum, node)) : none;
    const real free = LOAD(contact_share, plane) > 0.0f ? own : none;
    w = fma(free, b * texels_w(texels_gather(node_u, node)), w);
    all += own;
    moving += free;
  }
  return moving > 0.0f ? w * (all / moving) : none;
}

// Limits the friction of the whole forces f of the points that stick to this tool; anchors follow points that slip.
INLINE vec3 settle_friction(integer sticks, __global const float* next, __global float* anchor, meetings m, real stiffness, float friction, vec3 f) {
  const real none = 0.0f, one = 1.0f, across = dot_lanes(f, m.normal);
  const tool_slip slip = slip_on_tool(next, anchor, m);
  const vec3 pull = times_add(-stiffness, slip.side, times_add(-across, m.normal, f));
  const real length = sqrt(dot_lanes(pull, pull)), most = across > 0.0f ? friction * across : none;
  const integer slips = sticks && length > most;
  if (ANY(slips)) {  // to the distance that the friction limit can hold
    const real size = sqrt(dot_lanes(slip.side, slip.side)), hold = stiffness > 0.0f ? most / stiffness : none;
    const real kept = size > hold ? hold / size : one;
    const vec3 back = turned_back_lanes(next, times_add(-kept, slip.side, times(-slip.along, m.normal)));
    const vec3 follows = {m.inside.x + back.x, m.inside.y + back.y, m.inside.z + back.z};
    put3(slips, follows, anchor);
  }
  return where(sticks, times_add(length > most ? most / length : one, pull, times(across, m.normal)), f);
}

__kernel void contact_settle(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                             __global const int* contact_node, __global const float* contact_weight,
                             __global const float* contact_share, __global const float* contact_held, __global const int* contact_list,
                             __global const int* contact_near, __global float* contact_yield,
                             __global float* contact_anchor, __global const float* contact_start, __global int* contact_force, __global int* contact_change, __global const float* contact_node_sum,
                             __global int* contact_tool_force, __global const int* tool_kind, __global const float* tool_data,
                             __global const float* tool_grid, __global const float* tool_edge, __global const float* tool_pose,
                             __global const float* touch_surface, __global const float* contact_patch,
                             __global const float* contact_corner_weight, __global int* contact_corner_force, __global const float* contact_params,
                             __global const float* step_params, int point_count, int tools, int step) {
  const int first = FIRST_LISTED(contact_list);
  if (first < 0) return;
  const int near = contact_near[first / PLIANT_TILE];
  if (near == 0) return;
  const float h = step_params[0], half_hh = (0.5f * h) * h, quantum = contact_params[0];
  const real none = 0.0f, one = 1.0f;
  const integer zero = 0;
  __global float* anchor = contact_anchor + POINT_BASE(first, 4);
  __global int* force = contact_force + POINT_BASE(first, 4);
  __global int* change = contact_change + POINT_BASE(first, 4);
  const integer touching = LOAD(force, 3 * PLIANT_TILE), active = touching != 0;
  quanta3 sum = {zero, zero, zero};
  if (EDGES) clear_corners(contact_corner_force, first);
  const real known = LOAD(contact_yield, first);
  if (!ANY(active)) STORE(none, contact_yield, first);
  if (ANY(active)) {
    const int by_tools = (near & ~PLIANT_TOUCH_BIT) != 0;
    __global const float* weight = EDGES && by_tools ? contact_corner_weight + POINT_BASE(first, 9) : contact_weight + POINT_BASE(first, 8);
    const real yield = yield_of_touching(node_u, node_w, contact_node, weight, contact_share, contact_node_sum, first, half_hh);
    STORE(active ? yield : none, contact_yield, first);
  }
  const integer by_tool = touching & ((1 << tools) - 1);
  if (ANY(by_tool != 0)) {
    const point_lanes p = places_of_points(node_u, node_w, contact_rest, contact_node, contact_weight, first);
    patch_meeting patches[EDGES ? LANES : 1];
    real count = none;
    for (int t = 0; t < tools; ++t) count = (by_tool >> t & 1) != 0 ? count + one : count;
    const integer single = count == one;
    const real area = LOAD(contact_rest, POINT_BASE(first, 4) + 3 * PLIANT_TILE), whole = known > 0.0f ? area / (known * count) : none;
    for (int t = 0; t < tools; ++t) {
      const integer hit = (by_tool >> t & 1) != 0;
      if (!ANY(hit)) continue;
      const tool_meetings met = meet_tool(MEET_VALUES, t, first, hit, p, patches);
      const real stiffness = (whole * met.share) * met.ease, tool_number = (float)(t + 1), holds = GRIPPED_BY(t), slipped_out = SLIPPED_FROM(t);
      __global int* on_tool = tool_force_of(contact_tool_force, point_count, t, first);
      __global const float* data = tool_data + TOOL_NUMBERS * t;
      __global const float* next = tool_pose + POSE_NUMBERS * ((step + 1) * tools + t);
      __global const float* start = contact_start + POINT_BASE(first, 2);
      const real held = held_depth(node_u, contact_node, contact_weight, contact_share, contact_held, first, met);
      const real lag = LOAD(start, PLIANT_TILE) == tool_number ? LOAD(start, 0) : none;
      const real rest = ((-met.m.distance - held) - lag) - data[15];
      const integer held_fast = GRIPS && hit && LOAD(anchor, 3 * PLIANT_TILE) == holds;
      const real push = rest > 0.0f && !held_fast ? stiffness * rest : none, force_unit = quantum;
      vec3 f = times(push, met.m.normal);
      const quanta3 pressed = {-LOAD(on_tool, 0), -LOAD(on_tool, PLIANT_TILE), -LOAD(on_tool, 2 * PLIANT_TILE)};
      const vec3 first_part = {TO_REAL(pressed.x) * force_unit, TO_REAL(pressed.y) * force_unit, TO_REAL(pressed.z) * force_unit};
      const vec3 both = {f.x + first_part.x, f.y + first_part.y, f.z + first_part.z};
      f = where(single, both, f);
      if (GRIPS) {
        f = where(held_fast, times_add(-stiffness, grip_slip(next, anchor, met.m), f), f);
        const vec3 sum_of = {f.x + first_part.x, f.y + first_part.y, f.z + first_part.z};
        const integer torn = tears_off(where(single, f, sum_of), met.m.normal, area * grip_of(tool_pose, tools, step, t));
        put_real(held_fast && torn, slipped_out, anchor, 3);
      }
      const integer sticks = hit && single && LOAD(anchor, 3 * PLIANT_TILE) == tool_number;
      if (ANY(sticks)) f = settle_friction(sticks, next, anchor, met.m, stiffness, data[14], f);
      const quanta3 before = {pick(single, pressed.x, zero), pick(single, pressed.y, zero), pick(single, pressed.z, zero)};
      const vec3 no_vec = {none, none, none};
      add_tool_force(hit, on_tool, next, contact_params, met, p.now, f, where(single, first_part, no_vec), before, contact_corner_force, first, patches,
                     &sum);
      if (is_face(tool_kind, t)) spread_by_face(hit, on_tool, contact_params, lag, met.m.normal, given_back(tool_kind, contact_params, t));
    }
    STORE(LOAD(force, 0) + sum.x, force, 0);
    STORE(LOAD(force, PLIANT_TILE) + sum.y, force, PLIANT_TILE);
    STORE(LOAD(force, 2 * PLIANT_TILE) + sum.z, force, 2 * PLIANT_TILE);
  }
  STORE(sum.x, change, 0);
  STORE(sum.y, change, PLIANT_TILE);
  STORE(sum.z, change, 2 * PLIANT_TILE);
  STORE(touching, change, 3 * PLIANT_TILE);
}
