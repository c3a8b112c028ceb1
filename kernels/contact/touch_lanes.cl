// Contact of tissue with tissue for LANES points at once (touch_point.cl): their numbers and states. Every lane does the same operations in the same
// order as a point alone; what does not concern a lane is computed and not stored.
#define PLACE_TEXELS (PLIANT_TOUCH_PLACE / 4)

#if LANES == 16
#define TO_INTEGER(x) convert_int16_rtz(x)  // of whole numbers within the range of int: exact
#define TO_REAL(i) convert_float16(i)
#define LANE_INDEX (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#else
#define TO_INTEGER(x) ((int)(x))
#define TO_REAL(i) ((float)(i))
#define LANE_INDEX 0
#endif

typedef struct {
  real x, y, z;
} vec3;
INLINE vec3 sub(vec3 a, vec3 b) {
  const vec3 r = {a.x - b.x, a.y - b.y, a.z - b.z};
  return r;
}
INLINE vec3 times(real s, vec3 a) {
  const vec3 r = {s * a.x, s * a.y, s * a.z};
  return r;
}
INLINE vec3 times_add(real s, vec3 a, vec3 b) {
  const vec3 r = {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
  return r;
}
INLINE real dot_lanes(vec3 a, vec3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
INLINE vec3 cross_lanes(vec3 a, vec3 b) {
  const vec3 r = {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
  return r;
}
INLINE vec3 where(integer c, vec3 a, vec3 b) {
  const vec3 r = {c ? a.x : b.x, c ? a.y : b.y, c ? a.z : b.z};
  return r;
}
// v / length; the z axis if the length is 0.
INLINE vec3 over(vec3 v, real length) {
  const real none = 0.0f, one = 1.0f;
  const vec3 r = {length > 0.0f ? v.x / length : none, length > 0.0f ? v.y / length : none, length > 0.0f ? v.z / length : one};
  return r;
}
INLINE vec3 load3(__global const float* planes) {
  const vec3 r = {LOAD(planes, 0), LOAD(planes, PLIANT_TILE), LOAD(planes, 2 * PLIANT_TILE)};
  return r;
}
INLINE vec3 xyz(texels t) {
  const vec3 r = {texels_x(t), texels_y(t), texels_z(t)};
  return r;
}

// quanta (contact_point.cl) of a force.
typedef struct {
  integer x, y, z;
} quanta3;
INLINE integer quanta_of(real value) {
  const real most = QUANTUM_LIMIT;
  const real inside = value > most ? most : (value < -most ? -most : value);
  const real number = rint(inside == inside ? inside : (real)(0.0f));
  return TO_INTEGER(number);
}
INLINE quanta3 quanta3_of(vec3 f, float inverse) {
  const quanta3 q = {quanta_of(f.x * inverse), quanta_of(f.y * inverse), quanta_of(f.z * inverse)};
  return q;
}
INLINE integer pick(integer c, integer a, integer b) { return c ? a : b; }
INLINE quanta3 negated_where(integer c, quanta3 q) {
  const quanta3 r = {pick(c, -q.x, q.x), pick(c, -q.y, q.y), pick(c, -q.z, q.z)};
  return r;
}
// Plane `plane` of integers, changed in some lanes.
INLINE void put(integer c, integer value, __global int* at, int plane) {
  STORE(pick(c, value, LOAD(at, plane * PLIANT_TILE)), at, plane * PLIANT_TILE);
}
INLINE void put_real(integer c, real value, __global float* at, int plane) {
  STORE(c ? value : LOAD(at, plane * PLIANT_TILE), at, plane * PLIANT_TILE);
}

typedef struct {
  vec3 x, moved, normal, tangent, tilt;  // tilt: change of the normal in the step
  real yielding, density;                // compliance W, and density of points: 1 / spacing [1/m]
  real short_first, skew, short_height;  // of the tangents: 1 / |F t1|, skew of F t2, 1 / height of F t2 over F t1
} touch_lanes;

// Texel `texel` of the rows of touch_place of LANES points from `first` on, and of the partners whose numbers + 1 are at k (of point 0 where k has none).
#if LANES == 16
#define OWN(l) BLOCK4(touch_place, PLACE_TEXELS * (first + (l)) + texel)
#define THEIRS(l) BLOCK4(touch_place, PLACE_TEXELS * (k[l] > 0 ? k[l] - 1 : 0) + texel)
#define ROWS(of)                        \
  texels t;                             \
  t.a = (float8)(of(0), of(4));         \
  t.b = (float8)(of(1), of(5));         \
  t.c = (float8)(of(2), of(6));         \
  t.d = (float8)(of(3), of(7));         \
  t.e = (float8)(of(8), of(12));        \
  t.f = (float8)(of(9), of(13));        \
  t.g = (float8)(of(10), of(14));       \
  t.h = (float8)(of(11), of(15));       \
  return t;
INLINE texels own_texels(__global const float* touch_place, int first, int texel) { ROWS(OWN) }
INLINE texels partner_texels(__global const float* touch_place, __global const int* k, int texel) { ROWS(THEIRS) }
#else
INLINE texels own_texels(__global const float* touch_place, int first, int texel) { return vload4(PLACE_TEXELS * first + texel, touch_place); }
INLINE texels partner_texels(__global const float* touch_place, __global const int* k, int texel) {
  return vload4(PLACE_TEXELS * (k[0] > 0 ? k[0] - 1 : 0) + texel, touch_place);
}
#endif

INLINE touch_lanes lanes_of(texels x, texels moved, texels normal, texels tangent, texels tilt) {
  const touch_lanes s = {xyz(x),      xyz(moved),     xyz(normal),     xyz(tangent),     xyz(tilt),
                         texels_w(x), texels_w(tilt), texels_w(moved), texels_w(normal), texels_w(tangent)};
  return s;
}
INLINE touch_lanes own_lanes(__global const float* touch_place, int first) {
  return lanes_of(own_texels(touch_place, first, 0), own_texels(touch_place, first, 1), own_texels(touch_place, first, 2), own_texels(touch_place, first, 3),
                  own_texels(touch_place, first, 4));
}
// What a partner needs for its gap without and with the rotation of its normal, and for its frame: most pairs need only the first.
INLINE void load_front(__global const float* touch_place, __global const int* k, touch_lanes* s) {
  const texels x = partner_texels(touch_place, k, 0);
  s->x = xyz(x);
  s->yielding = texels_w(x);
  s->moved = xyz(partner_texels(touch_place, k, 1));
  s->normal = xyz(partner_texels(touch_place, k, 2));
}
INLINE void load_tilt(__global const float* touch_place, __global const int* k, touch_lanes* s) {
  const texels tilt = partner_texels(touch_place, k, 4);
  s->tilt = xyz(tilt);
  s->density = texels_w(tilt);
}
INLINE void load_tangent(__global const float* touch_place, __global const int* k, touch_lanes* s) { s->tangent = xyz(partner_texels(touch_place, k, 3)); }
