// Contact of tissue with tissue: contact points (contact_point.cl) of both sides represent surface patches and form pairs. Both points of a pair
// compute its force in the same order of operations (`lower`: the point with the lower index). So action equals reaction to the last bit, and each
// point writes only its own data.
//   A pair is pushed along normal = unit(n_upper - n_lower); its gap is g = (x_lower - x_upper) . normal. For two touching surfaces with curvatures k
//   and tangential positions s this is the gap between them at the mean position up to O(s^3), so the polygonal surface is not felt.
//   Normals follow the deformed surface: n ~ F t1 x F t2 with the undeformed tangents t1 and t2.
// touch_surface: [tiles][24][16] weights of F t1 (8) and F t2 (8) [1/m], t1 (3), t2 (3), spacing of the points around, extent of the patch [m].
// touch_rest: [tiles][4][16] undeformed position shifted by RunState::offset (3) [m], body.
//   The gap also depends on the rotation of the normals: a pair pushes its points apart and rotates their tangents so that the push has no moment
//   (touch_moment). The push is then the gradient of an energy; without this, frictionless contact would add energy indefinitely.
//   Normals, tangents and arms are those of the start of the step (see contact_point.cl).
// touch_place: [points][20] (position [m], W [m/(N/m^2)] of contact_press), (increment [m], 1 / |F t1|), (normal, skew of F t2), (F t1 / |F t1|,
// 1 / height of F t2), (change of the normal in the step, 1 / spacing): one row per point, because partners read it in random order.
// touch_partner: [tiles][16 slots][16] other point + 1, 0: none; touch_pair: [tiles][16 slots][6][16] (kernels/layout.h).
#define TOUCH_SLOTS PLIANT_TOUCH_SLOTS
#define TOUCH_RADIUS 1.2f  // search radius of a pair, in spacings; on a grid, the next point is at most 0.71 away

static inline float4 three(__global const float* at) { return (float4)(at[0], at[PLIANT_TILE], at[2 * PLIANT_TILE], 0.0f); }

static inline float4 cross3(float4 a, float4 b) {
  return (float4)(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x)), 0.0f);
}
static inline float4 unit(float4 v) { return normalised(v.x, v.y, v.z, sqrt(dot_xyz(v, v))); }

static inline int pair_base(int i, int slot) {
  return POINT_BASE(i, TOUCH_SLOTS * PLIANT_TOUCH_PAIR) + slot * PLIANT_TOUCH_PAIR * PLIANT_TILE;
}
static inline int pair_force_base(int i, int slot) {
  return POINT_BASE(i, TOUCH_SLOTS * PLIANT_TOUCH_FORCE) + slot * PLIANT_TOUCH_FORCE * PLIANT_TILE;
}
