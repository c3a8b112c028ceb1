// Tool forces on contact points, second part: repeats contact_press at the node positions after contact_apply, with the compliance W of the points
// that actually touch (contact_node_sum). So the penetration that the first part left is removed, whether one point touches or all. The friction
// limit applies to the sum of both parts; where a point slips, its anchor follows. contact_change: the added force [quanta].
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "contact_sum.cl"
#include "touch_point.cl"
#include "contact_patch.cl"
#include "contact_edge.cl"
#include "contact_grip.cl"

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
  if (contact_near[first / PLIANT_TILE] == 0) return;
  const float h = step_params[0], half_hh = (0.5f * h) * h;
  for (int i = first; i < first + LANES; ++i) {
    __global float* anchor = contact_anchor + POINT_BASE(i, 4);
    __global int* force = contact_force + POINT_BASE(i, 4);
    __global int* change = contact_change + POINT_BASE(i, 4);
    const int touching = force[3 * PLIANT_TILE];
    __global const float* start = contact_start + POINT_BASE(i, 2);
    int4 sum = 0;
    if (EDGES) clear_corners(contact_corner_force, i);
    if (touching != 0) {
      const contact_place p = place_of_point(node_u, node_w, contact_rest, contact_node, contact_weight, i);
      __global const int* node = contact_node + POINT_BASE(i, 8);
      __global const float* weight = contact_weight + POINT_BASE(i, 8);
      __global const float* share = contact_share + POINT_BASE(i, 8);
      const int by_tools = (contact_near[first / PLIANT_TILE] & ~PLIANT_TOUCH_BIT) != 0;
      float w = 0.0f, all = 0.0f, moving = 0.0f;
      for (int a = 0; a < 8; ++a) {
        const int n = node[a * PLIANT_TILE];
        const float b = fma(half_hh, node_w[4 * n + 3], half_hh);
        const float c = EDGES && by_tools ? contact_corner_weight[POINT_BASE(i, 9) + a * PLIANT_TILE] : weight[a * PLIANT_TILE];
        const float own = c > 0.0f ? c * contact_node_sum[4 * n + 3] : 0.0f;
        const float free = share[a * PLIANT_TILE] > 0.0f ? own : 0.0f;
        w = fma(free, b * node_u[4 * n + 3], w);
        all += own;
        moving += free;
      }
      const float known = contact_yield[i];
      contact_yield[i] = moving > 0.0f ? w * (all / moving) : 0.0f;  // held nodes count as free (contact_press)
      int count = 0;
      for (int t = 0; t < tools; ++t) count += touching >> t & 1;
      const float area = contact_rest[POINT_BASE(i, 4) + 3 * PLIANT_TILE];
      const float whole = known > 0.0f ? area / (known * (float)count) : 0.0f;
      for (int t = 0; t < tools; ++t) {
        if (!(touching >> t & 1)) continue;
        const patch_meeting met = meet_patch(node_u, node_w, contact_rest, contact_node, contact_weight, tool_kind, tool_data, tool_grid,
                                           tool_edge, tool_pose, touch_surface, contact_patch, tools, step, t, i, p);
        const meeting m = met.m;
        const float stiffness = (whole * met.share) * met.ease;
        __global int* on_tool = tool_force_of(contact_tool_force, point_count, t, i);
        __global const float* data = tool_data + TOOL_NUMBERS * t;
        const float held = held_depth(node_u, contact_node, contact_weight, contact_share, contact_held, i, met.at.now, m);
        const float lag = start[PLIANT_TILE] == (float)(t + 1) ? start[0] : 0.0f;
        const float rest = ((-m.distance - held) - lag) - data[15];
        const int held_fast = GRIPS && anchor[3 * PLIANT_TILE] == GRIPPED_BY(t);
        const float push = rest > 0.0f && !held_fast ? stiffness * rest : 0.0f;
        const float inverse = contact_params[1], quantum = contact_params[0];
        float4 f = m.normal * push;
        int4 before = 0;
        const int4 pressed = (int4)(-on_tool[0], -on_tool[PLIANT_TILE], -on_tool[2 * PLIANT_TILE], 0);
        const float4 first_part = (float4)((float)pressed.x * quantum, (float)pressed.y * quantum, (float)pressed.z * quantum, 0.0f);
        if (count == 1) {
          before = pressed;
          f += first_part;
        }
        if (held_fast) {
          f = fma((float4)(-stiffness), grip_slip(tool_pose + POSE_NUMBERS * ((step + 1) * tools + t), anchor, m), f);
          const float4 all_of_it = count == 1 ? f : f + first_part;
          if (tears_off(all_of_it, m.normal, area * grip_of(tool_pose, tools, step, t))) anchor[3 * PLIANT_TILE] = SLIPPED_FROM(t);
        }
        if (count == 1 && anchor[3 * PLIANT_TILE] == (float)(t + 1)) {
          const float4 stuck = (float4)(anchor[0], anchor[PLIANT_TILE], anchor[2 * PLIANT_TILE], 0.0f);
          __global const float* next = tool_pose + POSE_NUMBERS * ((step + 1) * tools + t);
          const float4 slip = turned(next, m.inside - stuck);
          const float along = dot_xyz(slip, m.normal);
          const float4 side = fma((float4)(-along), m.normal, slip);
          const float across = dot_xyz(f, m.normal);
          const float4 pull = fma((float4)(-stiffness), side, fma((float4)(-across), m.normal, f));
          const float length = sqrt(dot_xyz(pull, pull)), most = across > 0.0f ? data[14] * across : 0.0f;
          const float share_of = length > most ? most / length : 1.0f;
          f = fma((float4)(share_of), pull, m.normal * across);
          if (length > most) {
            // Slip: the anchor moves to the distance that the friction limit can hold.
            const float size = sqrt(dot_xyz(side, side)), hold = stiffness > 0.0f ? most / stiffness : 0.0f;
            const float kept = size > hold ? hold / size : 1.0f;
            const float4 back = turned_back(next, fma((float4)(-kept), side, (float4)(-along) * m.normal));
            anchor[0] = m.inside.x + back.x;
            anchor[PLIANT_TILE] = m.inside.y + back.y;
            anchor[2 * PLIANT_TILE] = m.inside.z + back.z;
          }
        }
        const int4 q = (int4)(quanta(f.x * inverse), quanta(f.y * inverse), quanta(f.z * inverse), 0) - before;
        add_to_tool(on_tool, tool_pose + POSE_NUMBERS * ((step + 1) * tools + t), contact_params, met.at.now, q);
        if (EDGES && met.edged) {
          add_to_corners(contact_corner_force, i, met, q);
        } else {
          sum += q;
        }
      }
      force[0] += sum.x;
      force[PLIANT_TILE] += sum.y;
      force[2 * PLIANT_TILE] += sum.z;
    } else {
      contact_yield[i] = 0.0f;
    }
    change[0] = sum.x;
    change[PLIANT_TILE] = sum.y;
    change[2 * PLIANT_TILE] = sum.z;
    change[3 * PLIANT_TILE] = touching;
  }
}
