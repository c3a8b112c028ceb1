// Continuation of laws that are singular at J = 0 below J = 1/4: functions of J alone are replaced by their second-order polynomial about 1/4, and
// the invariants of F^T F stay. The stress and its derivative are continuous; it is finite for every F and drives an inverted element back. With d =
// 4 J - 1:
//   J^-1   ->  4 (1 - d)                          (from -ln J; neo-Hookean)
//   J^-2/3 ->  f = f0 (1 - 2/3 d + 5/9 d^2)       f0 = (1/4)^-2/3
//   J^-4/3 ->  h = h0 (1 - 4/3 d + 14/9 d^2)      h0 = (1/4)^-4/3
#define LOW_VOLUME 0.25f
static inline real low_distance(real j) { return fma(4.0f, j, 3.0f); }  // d for j = J - 1
static inline real low_inverse(real d) { return fma(-4.0f, d, 4.0f); }
static inline real low_first(real d) { return 2.5198420997897464f * fma(d, fma(0.5555555555555556f, d, -0.6666666666666667f), 1.0f); }
// -f' / 2
static inline real low_first_slope(real d) { return 10.079368399158986f * fma(-0.5555555555555556f, d, 0.3333333333333333f); }
static inline real low_second(real d) { return 6.3496042078727974f * fma(d, fma(1.5555555555555556f, d, -1.3333333333333333f), 1.0f); }
// -h' / 2
static inline real low_second_slope(real d) { return 12.699208415745595f * fma(-3.1111111111111112f, d, 1.3333333333333333f); }
