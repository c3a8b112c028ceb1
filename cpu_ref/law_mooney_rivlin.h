// W = c10 (J^-2/3 I1 - 3) + c01 (J^-4/3 I2 - 3) + kappa/2 (J - 1)^2; the derivation is in kernels/law_mooney_rivlin.cl.
#pragma once
#include "cube_root.h"
#include "green_strain.h"

namespace pliant::ref {

template <class Scalar>
struct MooneyRivlin {
  static constexpr bool invertible = false;
  Scalar first, second, kappa;  ///< 2 c10, 2 c01, kappa

  explicit MooneyRivlin(const Scalar* law_parameters)
      : first(law_parameters[0]), second(law_parameters[1]), kappa(law_parameters[2]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return kappa * j; }

  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale,
                                                               Scalar pressure) const {
    constexpr Scalar one = 1, two = 2, four = 4;
    const Sym3<Scalar> e = green_strain(d.h);
    const Scalar jacobian = one + d.j;
    const Scalar root = inverse_cube_root(jacobian), squared = root * root;
    const Scalar inverse = one / jacobian, third = one / (Scalar(3) * jacobian);
    const Scalar excess = std::fma(Scalar(3), d.q, d.t) - squared_norm(d.h);
    const Scalar s = std::fma(-excess, third, one);
    const Scalar diagonal = std::fma(e.m00, e.m11, std::fma(e.m11, e.m22, e.m00 * e.m22));
    const Scalar z = std::fma(four, diagonal, -std::fma(e.m01, e.m01, std::fma(e.m02, e.m02, e.m12 * e.m12)));
    const Scalar w = (two * third) * std::fma(four, (e.m00 + e.m11) + e.m22, z);

    const Scalar a = scale * (first * squared);
    const Scalar b = scale * (second * (squared * squared)), twice_b = two * b;
    const Scalar p = scale * pressure;
    const Scalar volumetric = std::fma(-b, w, p);
    const Scalar difference = std::fma(a, s, std::fma(b, w, std::fma(twice_b, inverse, -p)));
    const Scalar identity =
        std::fma(a, std::fma(-s, d.t, excess * third), std::fma(twice_b * inverse, d.q, std::fma(volumetric, d.t, volumetric)));
    const Mat3<Scalar> x = combine(d, identity, std::fma(two, b, a), difference, -difference);
    const Sym3<Scalar> g{
        twice_b * (e.m11 + e.m22), twice_b * (e.m00 + e.m22), twice_b * (e.m00 + e.m11), -b * e.m01, -b * e.m02, -b * e.m12};
    const Mat3<Scalar> y = times_gradient(d.h, g);
    return {x.m00 + y.m00, x.m01 + y.m01, x.m02 + y.m02, x.m10 + y.m10, x.m11 + y.m11,
            x.m12 + y.m12, x.m20 + y.m20, x.m21 + y.m21, x.m22 + y.m22};
  }
};

}  // namespace pliant::ref
