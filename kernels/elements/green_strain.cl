// Symmetric tensors for laws written with the Green-Lagrange strain E = (H + H^T + H^T H) / 2.
typedef struct {
  real m00, m11, m22, m01, m02, m12;
} sym3;

// E on the diagonal, 2 E off the diagonal.
static inline sym3 green_strain(mat3 h) {
  sym3 e;
  e.m00 = fma(0.5f, fma(h.m20, h.m20, fma(h.m10, h.m10, h.m00 * h.m00)), h.m00);
  e.m11 = fma(0.5f, fma(h.m21, h.m21, fma(h.m11, h.m11, h.m01 * h.m01)), h.m11);
  e.m22 = fma(0.5f, fma(h.m22, h.m22, fma(h.m12, h.m12, h.m02 * h.m02)), h.m22);
  e.m01 = fma(h.m20, h.m21, fma(h.m10, h.m11, h.m00 * h.m01)) + (h.m01 + h.m10);
  e.m02 = fma(h.m20, h.m22, fma(h.m10, h.m12, h.m00 * h.m02)) + (h.m02 + h.m20);
  e.m12 = fma(h.m21, h.m22, fma(h.m11, h.m12, h.m01 * h.m02)) + (h.m12 + h.m21);
  return e;
}

// F S = S + H S.
static inline mat3 times_gradient(mat3 h, sym3 s) {
  mat3 p;
  p.m00 = fma(h.m02, s.m02, fma(h.m01, s.m01, fma(h.m00, s.m00, s.m00)));
  p.m01 = fma(h.m02, s.m12, fma(h.m01, s.m11, fma(h.m00, s.m01, s.m01)));
  p.m02 = fma(h.m02, s.m22, fma(h.m01, s.m12, fma(h.m00, s.m02, s.m02)));
  p.m10 = fma(h.m12, s.m02, fma(h.m11, s.m01, fma(h.m10, s.m00, s.m01)));
  p.m11 = fma(h.m12, s.m12, fma(h.m11, s.m11, fma(h.m10, s.m01, s.m11)));
  p.m12 = fma(h.m12, s.m22, fma(h.m11, s.m12, fma(h.m10, s.m02, s.m12)));
  p.m20 = fma(h.m22, s.m02, fma(h.m21, s.m01, fma(h.m20, s.m00, s.m02)));
  p.m21 = fma(h.m22, s.m12, fma(h.m21, s.m11, fma(h.m20, s.m01, s.m12)));
  p.m22 = fma(h.m22, s.m22, fma(h.m21, s.m12, fma(h.m20, s.m02, s.m22)));
  return p;
}
