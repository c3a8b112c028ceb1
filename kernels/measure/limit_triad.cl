// Measures a device's memory bandwidth: a <- b + s c over long arrays (McCalpin's triad), 12 bytes and 2 operations per number.
#include "arith.cl"

__kernel void limit_triad(__global float* a, __global const float* b, __global const float* c, float s) {
  const int i = FIRST_INDEX;
  STORE(fma((real)(s), LOAD(c, i), LOAD(b, i)), a, i);
}
