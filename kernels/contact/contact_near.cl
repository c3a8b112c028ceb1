// Broad phase: which tools a tile of contact points may touch before the next search. contact_near: [tiles] one bit per tool. A point is near a tool
// if their distance is less than a margin plus twice its relative motion until the next search at the present speed. contact_gap: [tiles][tools] the
// least of these distances, reduced by that motion [m]. Tiles that are no longer near a tool lose their friction anchors and compliances.
// contact_params: 0 unit of force, of which every force is a whole multiple [N]; 1 its inverse; 2 unit of force over the unit of weights; 3 inverse
// of the unit of torque [1/(N m)]; 4 inverse of the unit of area [1/m^2]; 5 margin [m]; 6 steps between two searches; 7 friction of tissue on tissue;
// 8 how far the first depth of a pair goes back per search, in spacings.
#include "arith.cl"
#include "texels.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "contact_patch.cl"
#include "contact_edge.cl"
#include "tool_lanes.cl"

__kernel void contact_near(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                           __global const int* contact_node, __global const float* contact_weight, __global int* contact_near,
                           __global float* contact_gap, __global float* contact_yield,
                           __global float* contact_anchor, __global const int* tool_kind, __global const float* tool_data,
                           __global const float* tool_grid, __global const float* tool_pose, __global const float* touch_surface,
                           __global const float* contact_params, int tools, int step) {
  const int tile = (int)get_global_id(0);
  const float margin = contact_params[5], ahead = 2.0f * contact_params[6];
  int near = 0;
  __global float* least = contact_gap + tile * tools;
  for (int t = 0; t < tools; ++t) least[t] = 1e30f;
  for (int first = tile * PLIANT_TILE; first < (tile + 1) * PLIANT_TILE; first += LANES) {
    const integer all = -1;
    const point_lanes p = places_of_points(node_u, node_w, contact_rest, contact_node, contact_weight, first);
    for (int t = 0; t < tools; ++t) {
      const meetings m = meet_lanes(tool_kind, tool_data, tool_grid, tool_pose, tools, step, t, all, p);
      const real none = 0.0f, stretch = EDGE_STRETCH;
      const real reach = has_edges(tool_kind, t) ? stretch * LOAD(touch_surface, POINT_BASE(first, PLIANT_TOUCH_SURFACE) + 23 * PLIANT_TILE) : none;
      const real gap = fma(SAME(-ahead), sqrt(dot_lanes(m.slip, m.slip)), m.distance) - reach;
      for (int l = 0; l < LANES; ++l) least[t] = LANE(gap, l) < least[t] ? LANE(gap, l) : least[t];
    }
  }
  for (int t = 0; t < tools; ++t) near |= least[t] < margin ? 1 << t : 0;
  for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {  // what a tool grips is near it
    const float by = contact_anchor[POINT_BASE(i, 4) + 3 * PLIANT_TILE];
    if (by < 0.0f && by > -64.0f) near |= 1 << (int)(-by - 1.0f);
  }
  const int before = contact_near[tile];
  if (near == 0 && (before & ~PLIANT_TOUCH_BIT) != 0) {
    const int base = tile * 4 * PLIANT_TILE;
    for (int k = base; k < base + 4 * PLIANT_TILE; ++k) contact_anchor[k] = 0.0f;
    for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE && (before & PLIANT_TOUCH_BIT) == 0; ++i) contact_yield[i] = 0.0f;
  }
  contact_near[tile] = near | (before & PLIANT_TOUCH_BIT);
}
