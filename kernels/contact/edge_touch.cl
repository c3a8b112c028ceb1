// Points of the edges of a tool and the patch around a contact point (contact_edge.cl).
// An edge point and a patch; `distance` is EDGE_FAR if the point is not over the patch.
typedef struct {
  float distance, opening, share;
  float4 normal;
  patch_place at;
} edge_touch;

#define PATCH_ARGUMENTS                                                                                                                 \
  __global const float *node_u, __global const float *node_w, __global const float *contact_rest, __global const int *contact_node,      \
      __global const float *contact_weight, __global const float *touch_surface, __global const float *contact_patch
#define PATCH_VALUES node_u, node_w, contact_rest, contact_node, contact_weight, touch_surface, contact_patch

// `base`: the tangent plane at the contact point.
static inline edge_touch touch_edge(PATCH_ARGUMENTS, __global const float* now, __global const float* next, int i, patch_plane base, float spacing,
                                    float4 point) {
  __global const float* region = contact_patch + POINT_BASE(i, PLIANT_PATCH);
  const float deepest = EDGE_INSIDE * spacing;
  const float4 center = (float4)(point.xyz, 0.0f);
  edge_touch out;
  out.distance = EDGE_FAR, out.opening = 0.0f, out.share = 0.0f, out.normal = 0.0f;
  patch_plane plane = base;
  float a = 0.0f, b = 0.0f, beyond = 0.0f;
  for (int round = 0; round < 2; ++round) {
    const float4 start = center - plane.y;
    const float gap = dot_xyz(plane.normal, start) - point.w;
    if (!plane.flat || !(gap > -deepest) || !(gap < deepest)) return out;
    a = a + dot_xyz(plane.dual_first, start);
    b = b + dot_xyz(plane.dual_second, start);
    beyond = beyond_region(region, a, b);
    if (!(beyond < (round == 0 ? EDGE_LOOSE : 1.0f))) return out;
    out.at = place_on(PATCH_VALUES, i, a, b);
    plane = plane_of(out.at, now);
  }
  const float4 toward = (float4)(0.0f) - plane.normal;
  const float depth = dot_xyz(toward, center - plane.y) + point.w;
  out.opening = dot_xyz(toward, turned_back(next, out.at.now - origin_of(next)) - plane.y);
  out.distance = out.opening - depth;
  out.normal = turned(next, toward);
  out.share = beyond > 0.0f ? 1.0f - beyond : 1.0f;
  return out;
}

typedef struct {
  meeting m;        // slip and inside are those of the contact point, the rest belongs to the place of contact
  float4 at;          // where the force acts
  float weight[8];    // weights of the nodes there
  float spread[8];    // for W: of all edge points that touch or soon may
  float share, ease;  // sum over edge points of their fractions of the point's area; fraction of the force that would remove the depth
  float spread_share;
  int edged;          // whether the force acts at `at` instead of the contact point
} patch_meeting;

static inline void take_touch(float distance, float opening, float share, float4 normal, float4 at, const float* weight, patch_meeting* out) {
  out->m.distance = distance;
  out->m.opening = opening;
  out->m.normal = normal;
  out->at = at;
  for (int c = 0; c < 8; ++c) out->weight[c] = weight[c];
  out->share = share;
  out->ease = EDGE_EASE, out->edged = 1;
}

// All edge points that push on a patch as one: at their mean place, weighted by their pushes. Returns 0 if no edge point lies over the patch.
static inline int meet_edge(PATCH_ARGUMENTS, __global const float* now, __global const float* next, int i, patch_plane base, float spacing,
                            __global const float* edge, int count, patch_meeting* out) {
  const float soon = EDGE_SOON * spacing;
  edge_touch nearest;
  nearest.distance = EDGE_FAR, nearest.share = 0.0f;
  float opening = 0.0f, pushes = 0.0f, share = 0.0f, spread_share = 0.0f, weight[8], spread[8];
  float4 normal = 0.0f, at = 0.0f;
  for (int c = 0; c < 8; ++c) weight[c] = spread[c] = 0.0f;
  for (int e = 0; e < count; ++e) {
    const edge_touch one = touch_edge(PATCH_VALUES, now, next, i, base, spacing, vload4(e, edge));
    if (one.distance < nearest.distance) nearest = one;
    if (one.distance < soon) {
      spread_share = spread_share + one.share;
      for (int c = 0; c < 8; ++c) spread[c] = fma(one.share, one.at.weight[c], spread[c]);
    }
    if (!(one.distance < 0.0f)) continue;
    const float push = one.share * -one.distance;
    share = share + one.share;
    pushes = pushes + push;
    opening = fma(push, one.opening, opening);
    normal = fma((float4)(push), one.normal, normal);
    at = fma((float4)(push), one.at.now, at);
    for (int c = 0; c < 8; ++c) weight[c] = fma(push, one.at.weight[c], weight[c]);
  }
  if (!(nearest.distance < EDGE_FAR)) return 0;
  if (pushes > 0.0f) {
    const float inverse = 1.0f / pushes;
    for (int c = 0; c < 8; ++c) weight[c] = weight[c] * inverse;
    take_touch(-(pushes / share), opening * inverse, share, normalised(normal.x, normal.y, normal.z, sqrt(dot_xyz(normal, normal))), at * inverse, weight, out);
  } else {
    take_touch(nearest.distance, nearest.opening, nearest.share, nearest.normal, nearest.at.now, nearest.at.weight, out);
  }
  out->spread_share = spread_share > 0.0f ? spread_share : nearest.share;
  for (int c = 0; c < 8; ++c) out->spread[c] = spread_share > 0.0f ? spread[c] / spread_share : nearest.at.weight[c];
  return 1;
}
