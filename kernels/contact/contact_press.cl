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
#include "contact_shape.cl"
#include "contact_point.cl"
#include "contact_sum.cl"
#include "touch_point.cl"
#include "contact_patch.cl"
#include "contact_edge.cl"
#include "contact_grip.cl"

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
  const float h = step_params[0], half_hh = (0.5f * h) * h;
  for (int i = first; i < first + LANES; ++i) {
    const contact_place p = place_of_point(node_u, node_w, contact_rest, contact_node, contact_weight, i);
    const float area = contact_rest[POINT_BASE(i, 4) + 3 * PLIANT_TILE];  // 0 for padding
    int touching = 0, gripped = 0, out = 0, count = 0, ready = 0, weighed = 0;
    const float within = ready_share(contact_yield[i]);
    for (int t = 0; t < tools; ++t) {
      if (!(near >> t & 1) || !(area > 0.0f)) continue;
      const patch_meeting met = meet_patch(node_u, node_w, contact_rest, contact_node, contact_weight, tool_kind, tool_data, tool_grid,
                                           tool_edge, tool_pose, touch_surface, contact_patch, tools, step, t, i, p);
      const meeting m = met.m;
      const int soon = may_touch_next(m, contact_params[5], within);
      if (soon) ready = PLIANT_READY_BIT;
      if (EDGES && (!weighed || (met.edged && soon))) write_weights(contact_corner_weight, contact_weight, i, met);
      weighed = 1;
      const int held_fast = GRIPS && !met.edged && grips(contact_held, contact_anchor + POINT_BASE(i, 4), tool_pose, tools, step, t, i, m, contact_params[5]);
      if (GRIPS) out |= slipped(contact_anchor + POINT_BASE(i, 4), tool_pose, tools, step, t, m, contact_params[5]) << t;
      if (m.distance < 0.0f || held_fast) {
        gripped |= held_fast << t;
        touching |= 1 << t;
        ++count;
      }
    }
    __global float* anchor = contact_anchor + POINT_BASE(i, 4);
    __global int* force = contact_force + POINT_BASE(i, 4);
    const int stuck_to = (int)anchor[3 * PLIANT_TILE] - 1;
    if (stuck_to >= 0 && !(touching >> stuck_to & 1)) anchor[3 * PLIANT_TILE] = 0.0f;
    if (GRIPS && anchor[3 * PLIANT_TILE] < 0.0f) {
      const int by = (int)(-anchor[3 * PLIANT_TILE] - 1.0f);
      if (!((by < 64 ? gripped >> by : out >> (by - 64)) & 1)) anchor[3 * PLIANT_TILE] = 0.0f;
    }
    __global float* start = contact_start + POINT_BASE(i, 2);
    float lag = 0.0f, lag_in = 0.0f;
    int4 sum = 0;
    float w = contact_yield[i];
    if (touching != 0 && !(w > 0.0f)) {  // compliance from touching points is not known yet
      __global const int* node = contact_node + POINT_BASE(i, 8);
      __global const float* share = contact_share + POINT_BASE(i, 8);
      w = 0.0f;
      for (int a = 0; a < 8; ++a) {
        const float b = fma(half_hh, node_w[4 * node[a * PLIANT_TILE] + 3], half_hh);
        w = fma(share[a * PLIANT_TILE], b * node_u[4 * node[a * PLIANT_TILE] + 3], w);
      }
      contact_yield[i] = w;
    }
    const float whole = w > 0.0f ? area / (w * (float)count) : 0.0f;
    if (EDGES) clear_corners(contact_corner_force, i);
    for (int t = 0; t < tools; ++t) {
      if (!(near >> t & 1)) continue;
      __global int* on_tool = tool_force_of(contact_tool_force, point_count, t, i);
      on_tool[7 * PLIANT_TILE] = touching >> t & 1;
      if (!(touching >> t & 1)) continue;
      const patch_meeting met = meet_patch(node_u, node_w, contact_rest, contact_node, contact_weight, tool_kind, tool_data, tool_grid,
                                           tool_edge, tool_pose, touch_surface, contact_patch, tools, step, t, i, p);
      const meeting m = met.m;
      const float stiffness = (whole * met.share) * met.ease;
      __global const float* data = tool_data + TOOL_NUMBERS * t;
      const float held = held_depth(node_u, contact_node, contact_weight, contact_share, contact_held, i, met.at.now, m);
      const float opening = m.opening, beyond = -m.distance - held, own = start_depth(start, t, beyond + opening);
      if (own > lag) lag = own, lag_in = (float)(t + 1);
      const float depth = beyond - own, before = depth + opening;
      float push = 0.0f;
      if (data[12] > 0.0f && before > 0.0f) {
        const float spring = (area * data[12]) * (data[16] > 0.0f ? before * sqrt(before) : before);
        const float damped = spring * fma(data[13], -opening / h, 1.0f);
        const float most = 0.5f * (stiffness * before);
        push = damped > 0.0f ? (damped < most ? damped : most) : 0.0f;
      }
      const float rest = stiffness > 0.0f ? depth - push / stiffness - data[15] : 0.0f;
      push = rest > 0.0f ? fma(stiffness, rest, push) : push;
      float4 f = m.normal * push;
      __global const float* now = tool_pose + POSE_NUMBERS * (step * tools + t);
      if (GRIPS && (gripped >> t & 1) && anchor[3 * PLIANT_TILE] >= 0.0f) {  // the first tool that reaches it holds it
        const float4 place = turned_back(now, (p.now - p.moved) - origin_of(now));
        anchor[0] = place.x;
        anchor[PLIANT_TILE] = place.y;
        anchor[2 * PLIANT_TILE] = place.z;
        anchor[3 * PLIANT_TILE] = GRIPPED_BY(t);
      }
      if (GRIPS && anchor[3 * PLIANT_TILE] == GRIPPED_BY(t)) {
        f = grip_slip(now + POSE_NUMBERS * tools, anchor, m) * -stiffness;
      } else if (data[14] > 0.0f) {
        if (anchor[3 * PLIANT_TILE] == 0.0f) {
          const float4 stuck = turned_back(now, (p.now - p.moved) - origin_of(now));
          anchor[0] = stuck.x;
          anchor[PLIANT_TILE] = stuck.y;
          anchor[2 * PLIANT_TILE] = stuck.z;
          anchor[3 * PLIANT_TILE] = (float)(t + 1);
        }
        if (anchor[3 * PLIANT_TILE] == (float)(t + 1)) {
          const float4 stuck = (float4)(anchor[0], anchor[PLIANT_TILE], anchor[2 * PLIANT_TILE], 0.0f);
          const float4 slip = turned(now + POSE_NUMBERS * tools, m.inside - stuck);
          const float along = dot_xyz(slip, m.normal);
          const float4 side = fma((float4)(-along), m.normal, slip);
          const float length = sqrt(dot_xyz(side, side)), most = data[14] * push, pull = stiffness * length;
          const float factor = pull > most ? most / length : stiffness;
          f = fma((float4)(-factor), side, f);
        }
      }
      const float inverse = contact_params[1];
      const int4 q = (int4)(quanta(f.x * inverse), quanta(f.y * inverse), quanta(f.z * inverse), 0);
      for (int c = 0; c < 6; ++c) on_tool[c * PLIANT_TILE] = 0;
      add_to_tool(on_tool, tool_pose + POSE_NUMBERS * ((step + 1) * tools + t), contact_params, met.at.now, q);
      const float whole_before = opening - m.distance;
      on_tool[6 * PLIANT_TILE] = as_int(whole_before > 0.0f ? whole_before : 0.0f);
      if (EDGES && met.edged) {
        add_to_corners(contact_corner_force, i, met, q);
      } else {
        sum += q;
      }
    }
    start[0] = lag, start[PLIANT_TILE] = lag_in;
    force[0] = sum.x;
    force[PLIANT_TILE] = sum.y;
    force[2 * PLIANT_TILE] = sum.z;
    force[3 * PLIANT_TILE] = touching | ready;
  }
}
