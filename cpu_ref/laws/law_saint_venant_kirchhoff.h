// S = lambda tr(E) I + 2 mu E with the Green-Lagrange strain E = (H + H^T + H^T H) / 2;   P = S + H S.
#pragma once
#include "cpu_ref/elements/green_strain.h"

namespace pliant::ref {

template <class Scalar>
struct SaintVenantKirchhoff {
  static constexpr bool invertible = false;
  Scalar low, mu, lambda;

  explicit SaintVenantKirchhoff(const Scalar* law_parameters)
      : low(law_parameters[0]), mu(law_parameters[1]), lambda(law_parameters[2]) {}
  [[nodiscard]] Scalar pressure(Scalar) const { return 0; }

  template <class Low>
  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale, Scalar /*pressure*/,
                                                               Low is_low) const {
    const Sym3<Scalar> e = green_strain(d.h);
    const Scalar m = scale * mu;
    const Scalar two_m = Scalar(2) * m;
    const Scalar l = (scale * lambda) * ((e.m00 + e.m11) + e.m22);
    const Mat3<Scalar> p = times_gradient(d.h, Sym3<Scalar>{std::fma(two_m, e.m00, l), std::fma(two_m, e.m11, l),
                                                            std::fma(two_m, e.m22, l), m * e.m01, m * e.m02, m * e.m12});
    const Scalar below = Scalar(4) * (low - (Scalar(1) + d.j));
    const Scalar y = -((scale * std::fma(Scalar(2), mu, lambda)) * (below * below));
    const Scalar one = Scalar(1) + d.t;
    const auto barrier = [&](Scalar cofactor, Scalar pij) {
      const Scalar more = std::fma(y, cofactor, pij);
      return is_low ? more : pij;
    };
    return {barrier((one - d.h.m00) + d.c.m00, p.m00), barrier(d.c.m01 - d.h.m10, p.m01),
            barrier(d.c.m02 - d.h.m20, p.m02),         barrier(d.c.m10 - d.h.m01, p.m10),
            barrier((one - d.h.m11) + d.c.m11, p.m11), barrier(d.c.m12 - d.h.m21, p.m12),
            barrier(d.c.m20 - d.h.m02, p.m20),         barrier(d.c.m21 - d.h.m12, p.m21),
            barrier((one - d.h.m22) + d.c.m22, p.m22)};
  }
};

}  // namespace pliant::ref
