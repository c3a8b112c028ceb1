// Twin of kernels/laws/inversion.cl: laws below J = 1/4.
#pragma once
#include <cmath>

namespace pliant::ref {

/// Returns d = 4 J - 1 for j = J - 1.
template <class Scalar>
inline Scalar low_distance(Scalar j) {
  return std::fma(Scalar(4), j, Scalar(3));
}
/// Continuation of 1 / J.
template <class Scalar>
inline Scalar low_inverse(Scalar d) {
  return std::fma(Scalar(-4), d, Scalar(4));
}
/// f, the continuation of J^-2/3.
template <class Scalar>
inline Scalar low_first(Scalar d) {
  return Scalar(2.5198420997897464L) *
         std::fma(d, std::fma(Scalar(0.5555555555555556L), d, Scalar(-0.6666666666666667L)), Scalar(1));
}
/// -f' / 2.
template <class Scalar>
inline Scalar low_first_slope(Scalar d) {
  return Scalar(10.079368399158986L) * std::fma(Scalar(-0.5555555555555556L), d, Scalar(0.3333333333333333L));
}
/// h, the continuation of J^-4/3.
template <class Scalar>
inline Scalar low_second(Scalar d) {
  return Scalar(6.3496042078727974L) *
         std::fma(d, std::fma(Scalar(1.5555555555555556L), d, Scalar(-1.3333333333333333L)), Scalar(1));
}
/// -h' / 2.
template <class Scalar>
inline Scalar low_second_slope(Scalar d) {
  return Scalar(12.699208415745595L) * std::fma(Scalar(-3.1111111111111112L), d, Scalar(1.3333333333333333L));
}

}  // namespace pliant::ref
