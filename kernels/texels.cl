// Loads, stores and gathers of sixteen texels (float4), or of one. Memory is always x y z w per texel.
#if LANES == 16
// Two halves of eight texels; 128-bit lane g of a, b, c, d holds texel 4 g, 4 g + 1, 4 g + 2, 4 g + 3 of its half, so that a field is obtained by
// unpacking within the lanes. (PoCL compiles wider shuffles to two to three times as many instructions.)
typedef struct {
  float8 a, b, c, d, e, f, g, h;
} texels;
#define UNPACK_LO(a, b) (float8)((a).s0, (b).s0, (a).s1, (b).s1, (a).s4, (b).s4, (a).s5, (b).s5)
#define UNPACK_HI(a, b) (float8)((a).s2, (b).s2, (a).s3, (b).s3, (a).s6, (b).s6, (a).s7, (b).s7)
#define PAIRS_LO(a, b) (float8)((a).s01, (b).s01, (a).s45, (b).s45)
#define PAIRS_HI(a, b) (float8)((a).s23, (b).s23, (a).s67, (b).s67)
static inline float16 texels_x(texels t) {
  return (float16)(PAIRS_LO(UNPACK_LO(t.a, t.b), UNPACK_LO(t.c, t.d)), PAIRS_LO(UNPACK_LO(t.e, t.f), UNPACK_LO(t.g, t.h)));
}
static inline float16 texels_y(texels t) {
  return (float16)(PAIRS_HI(UNPACK_LO(t.a, t.b), UNPACK_LO(t.c, t.d)), PAIRS_HI(UNPACK_LO(t.e, t.f), UNPACK_LO(t.g, t.h)));
}
static inline float16 texels_z(texels t) {
  return (float16)(PAIRS_LO(UNPACK_HI(t.a, t.b), UNPACK_HI(t.c, t.d)), PAIRS_LO(UNPACK_HI(t.e, t.f), UNPACK_HI(t.g, t.h)));
}
static inline float16 texels_w(texels t) {
  return (float16)(PAIRS_HI(UNPACK_HI(t.a, t.b), UNPACK_HI(t.c, t.d)), PAIRS_HI(UNPACK_HI(t.e, t.f), UNPACK_HI(t.g, t.h)));
}
// `k` points to sixteen texel indices.
static inline texels texels_gather(__global const float* p, __global const int* k) {
  texels t;
  t.a = (float8)(BLOCK4(p, k[0]), BLOCK4(p, k[4]));
  t.b = (float8)(BLOCK4(p, k[1]), BLOCK4(p, k[5]));
  t.c = (float8)(BLOCK4(p, k[2]), BLOCK4(p, k[6]));
  t.d = (float8)(BLOCK4(p, k[3]), BLOCK4(p, k[7]));
  t.e = (float8)(BLOCK4(p, k[8]), BLOCK4(p, k[12]));
  t.f = (float8)(BLOCK4(p, k[9]), BLOCK4(p, k[13]));
  t.g = (float8)(BLOCK4(p, k[10]), BLOCK4(p, k[14]));
  t.h = (float8)(BLOCK4(p, k[11]), BLOCK4(p, k[15]));
  return t;
}
static inline texels texels_load(__global const float* p, int i) {
  texels t;
  t.a = (float8)(BLOCK4(p, i), BLOCK4(p, i + 4));
  t.b = (float8)(BLOCK4(p, i + 1), BLOCK4(p, i + 5));
  t.c = (float8)(BLOCK4(p, i + 2), BLOCK4(p, i + 6));
  t.d = (float8)(BLOCK4(p, i + 3), BLOCK4(p, i + 7));
  t.e = (float8)(BLOCK4(p, i + 8), BLOCK4(p, i + 12));
  t.f = (float8)(BLOCK4(p, i + 9), BLOCK4(p, i + 13));
  t.g = (float8)(BLOCK4(p, i + 10), BLOCK4(p, i + 14));
  t.h = (float8)(BLOCK4(p, i + 11), BLOCK4(p, i + 15));
  return t;
}
static inline void texels_store_half(float8 x, float8 y, float8 z, float8 w, __global float* p) {
  const float8 xy0 = UNPACK_LO(x, y), xy1 = UNPACK_HI(x, y), zw0 = UNPACK_LO(z, w), zw1 = UNPACK_HI(z, w);
  const float8 a = PAIRS_LO(xy0, zw0), b = PAIRS_HI(xy0, zw0), c = PAIRS_LO(xy1, zw1), d = PAIRS_HI(xy1, zw1);
  vstore8((float8)(a.lo, b.lo), 0, p);
  vstore8((float8)(c.lo, d.lo), 1, p);
  vstore8((float8)(a.hi, b.hi), 2, p);
  vstore8((float8)(c.hi, d.hi), 3, p);
}
static inline void texels_store(float16 x, float16 y, float16 z, float16 w, __global float* p, int i) {
  texels_store_half(x.lo, y.lo, z.lo, w.lo, p + 4 * i);
  texels_store_half(x.hi, y.hi, z.hi, w.hi, p + 4 * i + 32);
}
// Rows of `stride` texels, one per lane: stores texel `texel` of each.
#define STORE_HALF(half, l)                                                                              \
  {                                                                                                     \
    const float8 xy0 = UNPACK_LO(x.half, y.half), xy1 = UNPACK_HI(x.half, y.half);                       \
    const float8 zw0 = UNPACK_LO(z.half, w.half), zw1 = UNPACK_HI(z.half, w.half);                       \
    const float8 a = PAIRS_LO(xy0, zw0), b = PAIRS_HI(xy0, zw0), c = PAIRS_LO(xy1, zw1), d = PAIRS_HI(xy1, zw1); \
    vstore4(a.lo, stride * (l) + texel, p);                                                                \
    vstore4(b.lo, stride * ((l) + 1) + texel, p);                                                          \
    vstore4(c.lo, stride * ((l) + 2) + texel, p);                                                          \
    vstore4(d.lo, stride * ((l) + 3) + texel, p);                                                          \
    vstore4(a.hi, stride * ((l) + 4) + texel, p);                                                          \
    vstore4(b.hi, stride * ((l) + 5) + texel, p);                                                          \
    vstore4(c.hi, stride * ((l) + 6) + texel, p);                                                          \
    vstore4(d.hi, stride * ((l) + 7) + texel, p);                                                          \
  }
static inline void texels_store_rows(float16 x, float16 y, float16 z, float16 w, __global float* p, int stride, int texel) {
  STORE_HALF(lo, 0)
  STORE_HALF(hi, 8)
}
static inline float16 gather(__global const float* p, __global const int* k) {
  return (float16)(p[k[0]], p[k[1]], p[k[2]], p[k[3]], p[k[4]], p[k[5]], p[k[6]], p[k[7]], p[k[8]], p[k[9]], p[k[10]], p[k[11]],
                   p[k[12]], p[k[13]], p[k[14]], p[k[15]]);
}
#else
typedef float4 texels;
#define texels_x(t) ((t).x)
#define texels_y(t) ((t).y)
#define texels_z(t) ((t).z)
#define texels_w(t) ((t).w)
#define texels_gather(p, k) vload4((k)[0], p)
#define texels_load(p, i) vload4(i, p)
#define texels_store(x, y, z, w, p, i) vstore4((float4)(x, y, z, w), i, p)
#define texels_store_rows(x, y, z, w, p, stride, texel) vstore4((float4)(x, y, z, w), texel, p)
#define gather(p, k) ((p)[(k)[0]])
#endif
