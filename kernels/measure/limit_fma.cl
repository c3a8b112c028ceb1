// Measures a device's arithmetic limit: eight independent chains of 64 fma per index, 1024 operations.
#include "arith.cl"

__kernel void limit_fma(__global float* a, float s) {
  const int i = FIRST_INDEX;
  const real factor = s;
  const real x = LOAD(a, i);
  real c0 = x, c1 = x + 1.0f, c2 = x + 2.0f, c3 = x + 3.0f, c4 = x + 4.0f, c5 = x + 5.0f, c6 = x + 6.0f, c7 = x + 7.0f;
  for (int k = 0; k < 64; ++k) {
    c0 = fma(c0, factor, x);
    c1 = fma(c1, factor, x);
    c2 = fma(c2, factor, x);
    c3 = fma(c3, factor, x);
    c4 = fma(c4, factor, x);
    c5 = fma(c5, factor, x);
    c6 = fma(c6, factor, x);
    c7 = fma(c7, factor, x);
  }
  STORE(((c0 + c1) + (c2 + c3)) + ((c4 + c5) + (c6 + c7)), a, i);
}
