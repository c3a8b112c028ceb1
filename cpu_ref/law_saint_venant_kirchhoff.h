// S = lambda tr(E) I + 2 mu E with the Green-Lagrange strain E = (H + H^T + H^T H) / 2;   P = S + H S.
#pragma once
#include "green_strain.h"

namespace pliant::ref {

template <class Scalar>
struct SaintVenantKirchhoff {
  static constexpr bool invertible = false;
  Scalar mu, lambda;

  explicit SaintVenantKirchhoff(const Scalar* law_parameters) : mu(law_parameters[0]), lambda(law_parameters[1]) {}
  [[nodiscard]] Scalar pressure(Scalar) const { return 0; }

  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale,
                                                               Scalar /*pressure*/) const {
    const Sym3<Scalar> e = green_strain(d.h);
    const Scalar m = scale * mu;
    const Scalar two_m = Scalar(2) * m;
    const Scalar l = (scale * lambda) * ((e.m00 + e.m11) + e.m22);
    return times_gradient(d.h, Sym3<Scalar>{std::fma(two_m, e.m00, l), std::fma(two_m, e.m11, l), std::fma(two_m, e.m22, l),
                                            m * e.m01, m * e.m02, m * e.m12});
  }
};

}  // namespace pliant::ref
