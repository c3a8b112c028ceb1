// Forces of tools on LANES contact points, and of their edges (contact_edge.cl) on the nodes of these.
// contact_corner_weight: [tiles][9][16] mean weights of a point's nodes where edge points of all tools touch its patch or soon may, or at the point
// itself, and the sum of their fractions of its area. contact_corner_force: [tiles][8][3][16] forces of edges on these nodes [quanta].

// Of the points that are `wanted`: those of the first tool, or of all that meet them `soon`, together; tools without edges count once, as one.
// counted: 1: a tool that meets the point soon is in; 2: one without edges is.
INLINE void write_weights(__global float* contact_corner_weight, __global const float* contact_weight, int first, integer wanted, integer soon, int weighed,
                          int* counted, const patch_meeting* patches) {
  for (int l = 0; l < LANES; ++l) {
    const patch_meeting* met = patches + l;
    const int meets = LANE_INT(soon, l) != 0;
    if (!LANE_INT(wanted, l) || (!meets && weighed) || (!met->edged && (counted[l] & 2))) continue;
    __global float* out = contact_corner_weight + POINT_BASE(first + l, 9);
    const float before = counted[l] ? out[8 * PLIANT_TILE] : 0.0f, share = met->edged ? met->spread_share : 1.0f, all = before + share;
    for (int k = 0; k < 8; ++k) {
      const float own = met->edged ? met->spread[k] : contact_weight[POINT_BASE(first + l, 8) + k * PLIANT_TILE];
      out[k * PLIANT_TILE] = before > 0.0f ? fma(share, own, before * out[k * PLIANT_TILE]) / all : own;
    }
    out[8 * PLIANT_TILE] = all;
    if (meets) counted[l] |= met->edged ? 1 : 3;
  }
}

INLINE void clear_corners(__global int* contact_corner_force, int first) {
  const integer zero = 0;
  for (int k = 0; k < 24; ++k) STORE(zero, contact_corner_force, POINT_BASE(first, 24) + k * PLIANT_TILE);
}

// Distributes the forces of the points that are `hit` and meet an edge over their nodes; the rounding remainder goes to the node with the largest weight.
INLINE void add_to_corners(__global int* contact_corner_force, int first, integer hit, const patch_meeting* patches, quanta3 force) {
  for (int l = 0; l < LANES; ++l) {
    if (!LANE_INT(hit, l) || !patches[l].edged) continue;
    __global int* out = contact_corner_force + POINT_BASE(first + l, 24);
    const int4 whole = (int4)(LANE_INT(force.x, l), LANE_INT(force.y, l), LANE_INT(force.z, l), 0);
    int4 left = whole;
    int largest = 0;
    for (int k = 0; k < 8; ++k) {
      const float w = patches[l].weight[k];
      const int4 part = (int4)(quanta(w * (float)whole.x), quanta(w * (float)whole.y), quanta(w * (float)whole.z), 0);
      out[3 * k * PLIANT_TILE] += part.x;
      out[(3 * k + 1) * PLIANT_TILE] += part.y;
      out[(3 * k + 2) * PLIANT_TILE] += part.z;
      left -= part;
      largest = w > patches[l].weight[largest] ? k : largest;
    }
    out[3 * largest * PLIANT_TILE] += left.x;
    out[(3 * largest + 1) * PLIANT_TILE] += left.y;
    out[(3 * largest + 2) * PLIANT_TILE] += left.z;
  }
}

// Adds the forces f of a tool on LANES points to them, or where an edge touches a patch, the normal part at its place and friction at the point. `had`:
// what was added in this step; `before`: the same in quanta.
INLINE void add_tool_force(integer hit, __global int* on_tool, __global const float* next, __global const float* contact_params, tool_meetings met, vec3 place,
                           vec3 f, vec3 had, quanta3 before, __global int* contact_corner_force, int first, const patch_meeting* patches, quanta3* sum) {
  const float inverse = contact_params[1];
  const integer zero = 0;
  quanta3 q = less(quanta3_of(f, inverse), before), at_point = q;
#if EDGES
  const vec3 along = times(dot_lanes(f, met.m.normal), met.m.normal);
  const quanta3 pressed = quanta3_of(times(dot_lanes(had, met.m.normal), met.m.normal), inverse);
  const quanta3 push = less(quanta3_of(along, inverse), pressed), pull = less(quanta3_of(sub(f, along), inverse), less(before, pressed));
  q.x = pick(met.edged, push.x, q.x), q.y = pick(met.edged, push.y, q.y), q.z = pick(met.edged, push.z, q.z);
  at_point.x = pick(met.edged, pull.x, q.x), at_point.y = pick(met.edged, pull.y, q.y), at_point.z = pick(met.edged, pull.z, q.z);
  add_to_corners(contact_corner_force, first, hit, patches, q);
#endif
  add_to_tool(hit, on_tool, next, contact_params, met.at, q);
#if EDGES
  const integer edged = hit && met.edged;
  if (ANY(edged)) add_to_tool(edged, on_tool, next, contact_params, place, at_point);
#endif
  sum->x += pick(hit, at_point.x, zero);
  sum->y += pick(hit, at_point.y, zero);
  sum->z += pick(hit, at_point.z, zero);
}
