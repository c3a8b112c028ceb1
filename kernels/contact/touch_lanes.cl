// Contact of tissue with tissue for LANES points at once (touch_point.cl, contact_lanes.cl): their numbers and states.
#include "contact_lanes.cl"

#define PLACE_TEXELS (PLIANT_TOUCH_PLACE / 4)

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
