// The displacement gradient H = F - I and the quantities that the material laws use. Formulas are written in H to avoid cancellation at small strain:
// with C = cof H, t = tr H, q = tr C + det H
//   J - 1 = t + q,   cof F = (1 + t) I - H^T + C,   J F - cof F = q I + J H + H^T - C.
typedef struct {
  real m00, m01, m02, m10, m11, m12, m20, m21, m22;
} mat3;

typedef struct {
  mat3 h;   // H [1]
  mat3 c;   // cof H [1]
  real t;   // tr H
  real q;   // tr cof H + det H
  real j;   // J - 1
} deformation;

static inline mat3 cofactor(mat3 h) {
  mat3 c;
  c.m00 = fma(h.m11, h.m22, -(h.m12 * h.m21));
  c.m01 = fma(h.m12, h.m20, -(h.m10 * h.m22));
  c.m02 = fma(h.m10, h.m21, -(h.m11 * h.m20));
  c.m10 = fma(h.m02, h.m21, -(h.m01 * h.m22));
  c.m11 = fma(h.m00, h.m22, -(h.m02 * h.m20));
  c.m12 = fma(h.m01, h.m20, -(h.m00 * h.m21));
  c.m20 = fma(h.m01, h.m12, -(h.m02 * h.m11));
  c.m21 = fma(h.m02, h.m10, -(h.m00 * h.m12));
  c.m22 = fma(h.m00, h.m11, -(h.m01 * h.m10));
  return c;
}

static inline deformation deformation_of(mat3 h) {
  deformation d;
  d.h = h;
  d.c = cofactor(h);
  d.t = (h.m00 + h.m11) + h.m22;
  const real det = fma(h.m02, d.c.m02, fma(h.m01, d.c.m01, h.m00 * d.c.m00));
  d.q = ((d.c.m00 + d.c.m11) + d.c.m22) + det;
  d.j = d.t + d.q;
  return d;
}

// |H|^2; |F|^2 = 3 + 2 tr H + |H|^2.
static inline real squared_norm(mat3 h) {
  return fma(h.m22, h.m22, fma(h.m21, h.m21, fma(h.m20, h.m20, fma(h.m12, h.m12, fma(h.m11, h.m11, fma(h.m10, h.m10,
         fma(h.m02, h.m02, fma(h.m01, h.m01, h.m00 * h.m00))))))));
}

// a I + b H + c H^T + e C
static inline mat3 combine(deformation d, real a, real b, real c, real e) {
  mat3 p;
  p.m00 = fma(e, d.c.m00, fma(c, d.h.m00, fma(b, d.h.m00, a)));
  p.m01 = fma(e, d.c.m01, fma(c, d.h.m10, b * d.h.m01));
  p.m02 = fma(e, d.c.m02, fma(c, d.h.m20, b * d.h.m02));
  p.m10 = fma(e, d.c.m10, fma(c, d.h.m01, b * d.h.m10));
  p.m11 = fma(e, d.c.m11, fma(c, d.h.m11, fma(b, d.h.m11, a)));
  p.m12 = fma(e, d.c.m12, fma(c, d.h.m21, b * d.h.m12));
  p.m20 = fma(e, d.c.m20, fma(c, d.h.m02, b * d.h.m20));
  p.m21 = fma(e, d.c.m21, fma(c, d.h.m12, b * d.h.m21));
  p.m22 = fma(e, d.c.m22, fma(c, d.h.m22, fma(b, d.h.m22, a)));
  return p;
}
