// W = mu/2 (J^-2/3 I1 - 3) + kappa/2 (J - 1)^2, hence P = mu J^-2/3 (F - s cof F) + kappa (J - 1) cof F with s = I1 / (3 J).
#pragma once
#include "cube_root.h"
#include "deformation.h"

namespace pliant::ref {

template <class Scalar>
struct IsochoricNeoHookean {
  static constexpr bool invertible = false;
  Scalar mu, kappa;

  explicit IsochoricNeoHookean(const Scalar* law_parameters) : mu(law_parameters[0]), kappa(law_parameters[1]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return kappa * j; }

  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale,
                                                               Scalar pressure) const {
    const Scalar jacobian = Scalar(1) + d.j;
    const Scalar root = inverse_cube_root(jacobian);
    const Scalar hh = squared_norm(d.h);
    const Scalar third = Scalar(1) / (Scalar(3) * jacobian);
    const Scalar excess = std::fma(Scalar(3), d.q, d.t) - hh;  // 3 J (1 - s)
    const Scalar one_minus_s = excess * third;
    const Scalar s = std::fma(-excess, third, Scalar(1));
    const Scalar m = scale * (mu * (root * root));
    const Scalar p = scale * pressure;
    const Scalar difference = std::fma(m, s, -p);
    return combine(d, std::fma(p, d.t, std::fma(m, std::fma(-s, d.t, one_minus_s), p)), m, difference, -difference);
  }
};

}  // namespace pliant::ref
