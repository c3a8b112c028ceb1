// Contact with LANES points at once: vectors, and forces in quanta. Every lane does the same operations in the same order as a point alone; what does not
// concern a lane is computed and not stored.
#if LANES == 16
#define TO_INTEGER(x) convert_int16_rtz(x)  // of whole numbers within the range of int: exact
#define TO_REAL(i) convert_float16(i)
#define LANE_INDEX (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#define LANE(v, l) (((const float*)&(v))[l])
#define SET_LANE(v, l, x) (((float*)&(v))[l] = (x))
#define LANE_INT(v, l) (((const int*)&(v))[l])
#define SET_LANE_INT(v, l, x) (((int*)&(v))[l] = (x))
#define SAME(x) ((float16)(x))
#else
#define TO_INTEGER(x) ((int)(x))
#define TO_REAL(i) ((float)(i))
#define LANE_INDEX 0
#define LANE(v, l) (v)
#define SET_LANE(v, l, x) ((v) = (x))
#define LANE_INT(v, l) (v)
#define SET_LANE_INT(v, l, x) ((v) = (x))
#define SAME(x) (x)
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
INLINE quanta3 less(quanta3 a, quanta3 b) {
  const quanta3 r = {a.x - b.x, a.y - b.y, a.z - b.z};
  return r;
}
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
INLINE void put3(integer c, vec3 v, __global float* at) {
  put_real(c, v.x, at, 0);
  put_real(c, v.y, at, 1);
  put_real(c, v.z, at, 2);
}
