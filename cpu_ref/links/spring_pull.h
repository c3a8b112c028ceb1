// Twin of kernels/links/spring_pull.cl.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pliant::ref {

/// Force over elongation of one spring: 0 linear, 1 cubic, 2 measured, 3 curve.
template <int Law, class Scalar>
Scalar spring_law_force(Scalar e, Scalar first, Scalar second, const Scalar* spring_curve, std::int32_t segments) {
  if constexpr (Law == 1) {
    return std::fma(first * e, e, second) * e;
  } else if constexpr (Law == 2) {
    const Scalar size = std::abs(e);
    const Scalar limit = first < Scalar(0) ? (Scalar(-0.75) * second) / first : Scalar(1e30F);
    const Scalar most = size < limit ? size : limit;
    const Scalar inverse = Scalar(1) / std::fma(first, most, second);
    const Scalar force = std::fma((second * inverse) * inverse, size - most, most * inverse);
    return e < Scalar(0) ? -force : force;
  } else if constexpr (Law == 3) {
    Scalar force = std::fma(spring_curve[2], e - spring_curve[0], spring_curve[1]);
    for (std::int32_t k = 1; k < segments; ++k) {
      const Scalar* s = spring_curve + std::ptrdiff_t{3} * k;
      const Scalar here = std::fma(s[2], e - s[0], s[1]);
      force = e >= s[0] ? here : force;
    }
    return second * force;
  } else {
    return second * e;
  }
}

/// Numbers of one spring: difference of its ends at rest, l0, |D|^2 - l0^2, those of its law, its damper.
template <class Scalar>
struct SpringNumbers {
  Scalar rest[3], length, squares, first, second, damper;
};

/// F / |d|, and d. `u`, `w`: differences of the ends' displacements and last increments.
template <int Law, bool Slack, bool Viscous, class Scalar>
Scalar spring_pull(const SpringNumbers<Scalar>& s, const Scalar (&u)[3], const Scalar (&w)[3], const Scalar* spring_curve,
                   std::int32_t segments, Scalar dt, Scalar (&d)[3]) {
  for (int c = 0; c < 3; ++c) d[c] = s.rest[c] + u[c];
  const Scalar length = std::sqrt(std::fma(d[2], d[2], std::fma(d[1], d[1], d[0] * d[0])));
  const Scalar longer =
      std::fma(u[2], s.rest[2] + d[2], std::fma(u[1], s.rest[1] + d[1], u[0] * (s.rest[0] + d[0]))) + s.squares;
  const Scalar both = length + s.length, area = both * length;
  // Divided first and chosen then, which a compiler can do for several springs at once.
  const Scalar reciprocal = Scalar(1) / area;
  const Scalar one_over = area > Scalar(0) ? reciprocal : Scalar(0);
  const Scalar e = (longer * length) * one_over, inverse = both * one_over;
  Scalar force = spring_law_force<Law>(e, s.first, s.second, spring_curve, segments);
  if constexpr (Viscous) {
    const Scalar rate = (std::fma(w[2], d[2], std::fma(w[1], d[1], w[0] * d[0])) * inverse) / dt;
    force = std::fma(s.damper, rate, force);
  }
  if constexpr (Slack) force = e > Scalar(0) && force > Scalar(0) ? force : Scalar(0);
  return force * inverse;
}

}  // namespace pliant::ref
