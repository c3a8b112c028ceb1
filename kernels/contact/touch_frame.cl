// Contact of tissue with tissue: the surface frame of a point at the start of the step, and its rotation in the step (touch_point.cl).
// The moment of a push turns the tangents by forces that grow as they get shorter. Of a face that is crushed to less than half of its length they
// would throw its nodes off: there 1 / |F t1| and 1 / height go back to 0.
#define TOUCH_CRUSHED 0.5f
#define TOUCH_SLOPE 4.0f  // 1 / TOUCH_CRUSHED^2: without a jump
static inline void write_state(__global float* touch_place, int i, touch_state s) {
  __global float* at = touch_place + PLIANT_TOUCH_PLACE * i;
  vstore4((float4)(s.x.xyz, s.yielding), 0, at);
  vstore4((float4)(s.moved.xyz, s.short_first), 1, at);
  vstore4((float4)(s.normal.xyz, s.skew), 2, at);
  vstore4((float4)(s.tangent.xyz, s.short_height), 3, at);
  vstore4((float4)(s.tilt.xyz, s.density), 4, at);
}

// F t1 and F t2 for a field of increments or displacements.
static inline void along_tangents(__global const float* values, __global const int* contact_node, __global const float* touch_surface, int i,
                                  float4* first, float4* second) {
  __global const float* own = touch_surface + POINT_BASE(i, PLIANT_TOUCH_SURFACE);
  __global const int* node = contact_node + POINT_BASE(i, 8);
  *first = *second = 0.0f;
  for (int a = 0; a < 8; ++a) {
    const float4 v = vload4(node[a * PLIANT_TILE], values);
    *first = fma((float4)(own[a * PLIANT_TILE]), v, *first);
    *second = fma((float4)(own[(8 + a) * PLIANT_TILE]), v, *second);
  }
  first->w = second->w = 0.0f;
}

// The frame of a point at the start of the step.
static inline void set_frame(__global const float* node_u, __global const float* node_w, __global const int* contact_node,
                             __global const float* touch_surface, int i, touch_state* s) {
  __global const float* own = touch_surface + POINT_BASE(i, PLIANT_TOUCH_SURFACE);
  float4 now_first, now_second, moved_first, moved_second;
  along_tangents(node_u, contact_node, touch_surface, i, &now_first, &now_second);
  along_tangents(node_w, contact_node, touch_surface, i, &moved_first, &moved_second);
  const float4 first = (three(own + 16 * PLIANT_TILE) + now_first) - moved_first;
  const float4 second = (three(own + 19 * PLIANT_TILE) + now_second) - moved_second;
  s->normal = unit(cross3(first, second));
  const float length = sqrt(dot_xyz(first, first));
  s->tangent = normalised(first.x, first.y, first.z, length);
  const float height = dot_xyz(second, cross3(s->normal, s->tangent));
  s->short_first = length > TOUCH_CRUSHED ? 1.0f / length : TOUCH_SLOPE * length;
  s->short_height = height > TOUCH_CRUSHED ? 1.0f / height : TOUCH_SLOPE * height;
  s->skew = dot_xyz(second, s->tangent) * s->short_height;
  const float spacing = own[22 * PLIANT_TILE];
  s->density = spacing > 0.0f ? 1.0f / spacing : 0.0f;
}

// The normal changes by -(n . F' t_k) a^k, with the dual vectors a^k of the tangents.
static inline float4 tilt_of(__global const float* node_w, __global const int* contact_node, __global const float* touch_surface, int i,
                             touch_state s) {
  float4 first, second;
  along_tangents(node_w, contact_node, touch_surface, i, &first, &second);
  const float one = dot_xyz(s.normal, first) * s.short_first, two = dot_xyz(s.normal, second);
  const float across = fma(two, s.short_height, -(one * s.skew));
  return (float4)(0.0f) - fma((float4)(one), s.tangent, cross3(s.normal, s.tangent) * across);  // avoids a negative zero
}
