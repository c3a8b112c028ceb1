// The rotation of a region: Horn's quaternion (1987), the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix, by repeated squaring. It
// is a proper rotation also for planar, linear and inverted regions, without trigonometry or an initial guess. Each region stops squaring by itself,
// so that its bits do not depend on its neighbours: whole regions after 4 squarings, lines after 16.
typedef struct {
  real n00, n01, n02, n03, n11, n12, n13, n22, n23, n33;
} symmetric4;

INLINE symmetric4 squared(symmetric4 n) {
  symmetric4 s;
  s.n00 = fma(n.n03, n.n03, fma(n.n02, n.n02, fma(n.n01, n.n01, n.n00 * n.n00)));
  s.n01 = fma(n.n03, n.n13, fma(n.n02, n.n12, fma(n.n01, n.n11, n.n00 * n.n01)));
  s.n02 = fma(n.n03, n.n23, fma(n.n02, n.n22, fma(n.n01, n.n12, n.n00 * n.n02)));
  s.n03 = fma(n.n03, n.n33, fma(n.n02, n.n23, fma(n.n01, n.n13, n.n00 * n.n03)));
  s.n11 = fma(n.n13, n.n13, fma(n.n12, n.n12, fma(n.n11, n.n11, n.n01 * n.n01)));
  s.n12 = fma(n.n13, n.n23, fma(n.n12, n.n22, fma(n.n11, n.n12, n.n01 * n.n02)));
  s.n13 = fma(n.n13, n.n33, fma(n.n12, n.n23, fma(n.n11, n.n13, n.n01 * n.n03)));
  s.n22 = fma(n.n23, n.n23, fma(n.n22, n.n22, fma(n.n12, n.n12, n.n02 * n.n02)));
  s.n23 = fma(n.n23, n.n33, fma(n.n22, n.n23, fma(n.n12, n.n13, n.n02 * n.n03)));
  s.n33 = fma(n.n33, n.n33, fma(n.n23, n.n23, fma(n.n13, n.n13, n.n03 * n.n03)));
  return s;
}

// Scales the trace to [1, 2) by a power of two, which is faster than a division, and rounds entries to a grid of 2^-31: smaller values would become
// denormal within two squarings.
INLINE symmetric4 normalised(symmetric4 n) {
  const real grid = 0.005859375f;  // 1.5 * 2^23 * 2^-31
  const real scale = AS_REAL(0x7f000000 - (AS_INTEGER((n.n00 + n.n11) + (n.n22 + n.n33)) & 0x7f800000));
  symmetric4 s;
  s.n00 = fma(n.n00, scale, grid) - grid;
  s.n01 = fma(n.n01, scale, grid) - grid;
  s.n02 = fma(n.n02, scale, grid) - grid;
  s.n03 = fma(n.n03, scale, grid) - grid;
  s.n11 = fma(n.n11, scale, grid) - grid;
  s.n12 = fma(n.n12, scale, grid) - grid;
  s.n13 = fma(n.n13, scale, grid) - grid;
  s.n22 = fma(n.n22, scale, grid) - grid;
  s.n23 = fma(n.n23, scale, grid) - grid;
  s.n33 = fma(n.n33, scale, grid) - grid;
  return s;
}

static inline real trace4(symmetric4 n) { return (n.n00 + n.n11) + (n.n22 + n.n33); }

INLINE symmetric4 kept(integer settled, symmetric4 n, symmetric4 next) {
  const symmetric4 s = {settled ? n.n00 : next.n00, settled ? n.n01 : next.n01, settled ? n.n02 : next.n02, settled ? n.n03 : next.n03,
                        settled ? n.n11 : next.n11, settled ? n.n12 : next.n12, settled ? n.n13 : next.n13, settled ? n.n22 : next.n22,
                        settled ? n.n23 : next.n23, settled ? n.n33 : next.n33};
  return s;
}

// Returns R - I for the rotation R closest to a + e, with the symmetric undeformed moment a and the contribution e of the displacements.
// Antisymmetric parts come from e alone, so small rotations keep their precision. `size`: trace of a. Sets `ok` to false and R = I if a + e is
// negligible compared to it or not finite.
static inline mat3 rotation_of(real axx, real ayy, real azz, real axy, real axz, real ayz, mat3 e, real size, integer* ok) {
  const real none = 0.0f, one = 1.0f;
  const mat3 b = {axx + e.m00, axy + e.m01, axz + e.m02, axy + e.m10, ayy + e.m11, ayz + e.m12, axz + e.m20, ayz + e.m21, azz + e.m22};
  const real f2 = fma(b.m22, b.m22, fma(b.m21, b.m21, fma(b.m20, b.m20, fma(b.m12, b.m12, fma(b.m11, b.m11,
                  fma(b.m10, b.m10, fma(b.m02, b.m02, fma(b.m01, b.m01, b.m00 * b.m00))))))));
  *ok = f2 > (1e-12f * size) * (1e-12f * size) && f2 < INFINITY;
  const real scale = *ok ? one / sqrt(f2) : none;
  // With |a + e| = 1 the sum of the largest and the smallest eigenvalue is at least -2 / sqrt(3), in a region turned inside out. A shift by more than
  // half of that makes the largest the largest in magnitude, and a shift by little more leaves least of the others of a whole region.
  const real shift = 0.625f;
  symmetric4 n;
  n.n00 = fma((b.m00 + b.m11) + b.m22, scale, shift);
  n.n11 = fma((b.m00 - b.m11) - b.m22, scale, shift);
  n.n22 = fma((b.m11 - b.m00) - b.m22, scale, shift);
  n.n33 = fma((b.m22 - b.m00) - b.m11, scale, shift);
  n.n01 = (e.m21 - e.m12) * scale;
  n.n02 = (e.m02 - e.m20) * scale;
  n.n03 = (e.m10 - e.m01) * scale;
  n.n12 = (b.m01 + b.m10) * scale;
  n.n13 = (b.m02 + b.m20) * scale;
  n.n23 = (b.m12 + b.m21) * scale;
  // tr^2 - tr(n^2) = 2 (sum of products of two eigenvalues). At 0.025 tr^2 no other eigenvalue exceeds 1/79 of the largest, and two squarings leave
  // 2^-25 of it.
  integer settled = !*ok;
  for (int k = 0; k < 8 && ANY(!settled); ++k) {
    const symmetric4 scaled = normalised(n), square = squared(scaled);
    const real trace = trace4(scaled), few = 0.025f;
    n = kept(settled, n, squared(square));
    settled = settled || fma(trace, trace, -trace4(square)) <= few * (trace * trace);
  }
  real w = n.n00, x = n.n01, y = n.n02, z = n.n03, largest = n.n00;
#define TAKE(c0, c1, c2, c3, diagonal)  \
  {                                     \
    const integer larger = (diagonal) > largest; \
    w = larger ? (c0) : w;              \
    x = larger ? (c1) : x;              \
    y = larger ? (c2) : y;              \
    z = larger ? (c3) : z;              \
    largest = larger ? (diagonal) : largest; \
  }
  TAKE(n.n01, n.n11, n.n12, n.n13, n.n11)
  TAKE(n.n02, n.n12, n.n22, n.n23, n.n22)
  TAKE(n.n03, n.n13, n.n23, n.n33, n.n33)
#undef TAKE
  const real unit = one / largest;  // before squaring, since the squares of a column may underflow
  w = w * unit, x = x * unit, y = y * unit, z = z * unit;
  const real two = 2.0f / fma(z, z, fma(y, y, fma(x, x, w * w)));
  const real x2 = two * x, y2 = two * y, z2 = two * z;
  mat3 d;
  d.m00 = -fma(y2, y, z2 * z);
  d.m01 = fma(x2, y, -(z2 * w));
  d.m02 = fma(x2, z, y2 * w);
  d.m10 = fma(x2, y, z2 * w);
  d.m11 = -fma(x2, x, z2 * z);
  d.m12 = fma(y2, z, -(x2 * w));
  d.m20 = fma(x2, z, -(y2 * w));
  d.m21 = fma(y2, z, x2 * w);
  d.m22 = -fma(x2, x, y2 * y);
  return d;
}
