// Known-answer test: every operation that docs/determinism.md allows, on inputs for which devices are known to differ. A device counts as bit-exact
// only if the host finds all results equal bit for bit (host/backends/interface/probe.cpp). a, b, c, k: [count]. reals: [17][count], ints: [5][count].
#include "arith.cl"

#if LANES == 16
#define TO_REAL convert_float16
#define TO_INTEGER convert_int16
#else
#define TO_REAL convert_float
#define TO_INTEGER convert_int
#endif
#define BIT(condition, n) ((condition) ? (integer)(1 << (n)) : (integer)(0))

__kernel void probe(__global const float* a, __global const float* b, __global const float* c, __global const int* k,
                    __global float* reals, __global int* ints, int count) {
  const int i = FIRST_INDEX;
  const real x = LOAD(a, i), y = LOAD(b, i), z = LOAD(c, i);
  const integer n = LOAD(k, i);
  STORE(x * y + z, reals, i);
  STORE(x * y - z, reals, count + i);
  STORE(fma(x, y, z), reals, 2 * count + i);
  STORE(x / y, reals, 3 * count + i);
  STORE(1.0f / x, reals, 4 * count + i);
  STORE(sqrt(fabs(x)), reals, 5 * count + i);
  STORE(x + y, reals, 6 * count + i);
  STORE(x - y, reals, 7 * count + i);
  STORE(x * y, reals, 8 * count + i);
  STORE(floor(x), reals, 9 * count + i);
  STORE(rint(x), reals, 10 * count + i);
  STORE(copysign(x, y), reals, 11 * count + i);
  STORE(x < y ? x : y, reals, 12 * count + i);
  STORE(x > y ? x : z, reals, 13 * count + i);
  STORE(-x, reals, 14 * count + i);
  STORE(TO_REAL(n), reals, 15 * count + i);
  STORE(AS_REAL(AS_INTEGER(x) ^ (n & 0xff)), reals, 16 * count + i);

  const integer order = BIT(x < y, 0) | BIT(x <= y, 1) | BIT(x == y, 2) | BIT(x != y, 3) | BIT(x > y, 4) | BIT(x >= y, 5);
  STORE(order | BIT(!(x > 0.0f), 6) | BIT(x == x, 7), ints, i);
  STORE(x == x ? AS_INTEGER(x) : (integer)(0), ints, count + i);
  const real guarded = fabs(x) < 1048576.0f ? rint(x) : (real)(0.0f);
  STORE(TO_INTEGER(guarded), ints, 2 * count + i);
  STORE((n * 3 + 7) ^ (n >> 2), ints, 3 * count + i);
  STORE((n & 255) << 3 | (n / 7 & 7), ints, 4 * count + i);
}
