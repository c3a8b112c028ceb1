// Contact of tissue with tissue: the place of LANES points, their surface frames at the start of the step, and the rotation of these in the step
// (touch_point.cl).
// The moment of a push turns the tangents by forces that grow as they get shorter. Of a face that is crushed to less than half of its length they
// would throw its nodes off: there 1 / |F t1| and 1 / height go back to 0.
#define TOUCH_CRUSHED 0.5f
#define TOUCH_SLOPE 4.0f  // 1 / TOUCH_CRUSHED^2: without a jump

// Sums over the nodes of a point: of displacements and increments, and of both along the tangents.
typedef struct {
  vec3 u, w, first_u, second_u, first_w, second_w;
} touch_field;
INLINE touch_field no_field(void) {
  const real none = 0.0f;
  const vec3 v = {none, none, none};
  const touch_field f = {v, v, v, v, v, v};
  return f;
}
// Adds corner a. planes: those of contact_weight; surface: of touch_surface, from the points on.
INLINE void add_corner(touch_field* f, int a, texels u, texels w, __global const float* planes, __global const float* surface) {
  const real c = LOAD(planes, a * PLIANT_TILE), first = LOAD(surface, a * PLIANT_TILE), second = LOAD(surface, (8 + a) * PLIANT_TILE);
  const vec3 at = xyz(u), moved = xyz(w);
  f->u = times_add(c, at, f->u);
  f->w = times_add(c, moved, f->w);
  f->first_u = times_add(first, at, f->first_u);
  f->second_u = times_add(second, at, f->second_u);
  f->first_w = times_add(first, moved, f->first_w);
  f->second_w = times_add(second, moved, f->second_w);
}

INLINE vec3 place_of_lanes(__global const float* contact_rest, int first, touch_field f) {
  const vec3 rest = load3(contact_rest + POINT_BASE(first, 4)), r = {rest.x + f.u.x, rest.y + f.u.y, rest.z + f.u.z};
  return r;
}

INLINE void set_frames(__global const float* surface, touch_field f, touch_lanes* s) {
  const vec3 t1 = load3(surface + 16 * PLIANT_TILE), t2 = load3(surface + 19 * PLIANT_TILE);
  const real one = 1.0f, none = 0.0f, slope = TOUCH_SLOPE;
  const vec3 now_first = {t1.x + f.first_u.x, t1.y + f.first_u.y, t1.z + f.first_u.z};
  const vec3 now_second = {t2.x + f.second_u.x, t2.y + f.second_u.y, t2.z + f.second_u.z};
  const vec3 first = sub(now_first, f.first_w), second = sub(now_second, f.second_w), across = cross_lanes(first, second);
  s->normal = over(across, sqrt(dot_lanes(across, across)));
  const real length = sqrt(dot_lanes(first, first));
  s->tangent = over(first, length);
  const real height = dot_lanes(second, cross_lanes(s->normal, s->tangent));
  s->short_first = length > TOUCH_CRUSHED ? one / length : slope * length;
  s->short_height = height > TOUCH_CRUSHED ? one / height : slope * height;
  s->skew = dot_lanes(second, s->tangent) * s->short_height;
  const real spacing = LOAD(surface, 22 * PLIANT_TILE);
  s->density = spacing > 0.0f ? one / spacing : none;
}

// The normal changes by -(n . F' t_k) a^k, with the dual vectors a^k of the tangents.
INLINE vec3 tilt_of(touch_field f, touch_lanes s) {
  const real none = 0.0f;
  const real one = dot_lanes(s.normal, f.first_w) * s.short_first, two = dot_lanes(s.normal, f.second_w);
  const real across = fma(two, s.short_height, -(one * s.skew));
  const vec3 turn = times_add(one, s.tangent, times(across, cross_lanes(s.normal, s.tangent)));
  const vec3 r = {none - turn.x, none - turn.y, none - turn.z};  // avoids a negative zero
  return r;
}

INLINE void store_texels(__global float* touch_place, int first, int texel, vec3 v, real w) {
  texels_store_rows(v.x, v.y, v.z, w, touch_place + PLIANT_TOUCH_PLACE * first, PLACE_TEXELS, texel);
}
INLINE void store_places(__global float* touch_place, int first, touch_lanes s) {
  store_texels(touch_place, first, 0, s.x, s.yielding);
  store_texels(touch_place, first, 1, s.moved, s.short_first);
  store_texels(touch_place, first, 2, s.normal, s.skew);
  store_texels(touch_place, first, 3, s.tangent, s.short_height);
  store_texels(touch_place, first, 4, s.tilt, s.density);
}
