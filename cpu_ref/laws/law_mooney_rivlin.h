// W = c10 (J^-2/3 I1 - 3) + c01 (J^-4/3 I2 - 3) + kappa/2 (J - 1)^2; the derivation is in kernels/laws/law_mooney_rivlin.cl.
#pragma once
#include "cpu_ref/cube_root.h"
#include "cpu_ref/elements/green_strain.h"
#include "cpu_ref/laws/inversion.h"

namespace pliant::ref {

template <class Scalar>
struct MooneyRivlin {
  static constexpr bool invertible = false;
  Scalar low, first, second, kappa;  ///< 2 c10, 2 c01, kappa

  explicit MooneyRivlin(const Scalar* law_parameters)
      : low(law_parameters[0]), first(law_parameters[1]), second(law_parameters[2]), kappa(law_parameters[3]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return kappa * j; }

  template <class Low>
  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale, Scalar pressure,
                                                               Low is_low) const {
    constexpr Scalar one = 1, two = 2, four = 4;
    const Sym3<Scalar> e = green_strain(d.h);
    const Scalar jacobian = one + d.j;
    const Scalar root = inverse_cube_root(jacobian), squared = root * root;
    const Scalar inverse = one / jacobian, third = one / (Scalar(3) * jacobian);
    const Scalar hh = squared_norm(d.h);
    const Scalar excess = std::fma(Scalar(3), d.q, d.t) - hh;
    const Scalar s = std::fma(-excess, third, one);
    const Scalar diagonal = std::fma(e.m00, e.m11, std::fma(e.m11, e.m22, e.m00 * e.m22));
    const Scalar z = std::fma(four, diagonal, minus(std::fma(e.m01, e.m01, std::fma(e.m02, e.m02, e.m12 * e.m12))));
    const Scalar i2 = std::fma(four, (e.m00 + e.m11) + e.m22, z);  // I2 - 3
    const Scalar w = (two * third) * i2;

    const Scalar low_d = low_distance(d.j), low_a = low_first(low_d), low_b = low_second(low_d), fourth = squared * squared;
    const Scalar a = scale * (first * (is_low ? low_a : squared));
    const Scalar b = scale * (second * (is_low ? low_b : fourth)), twice_b = two * b;
    const Scalar p = scale * pressure;
    const Scalar volumetric = std::fma(-b, w, p);
    const Scalar low_difference = std::fma(scale * first, low_first_slope(low_d) * (Scalar(3) + std::fma(two, d.t, hh)),
                                           std::fma(scale * second, low_second_slope(low_d) * (Scalar(3) + i2), -p));
    const Scalar high_difference = std::fma(a, s, std::fma(b, w, std::fma(twice_b, inverse, -p)));
    const Scalar difference = is_low ? low_difference : high_difference;
    const Scalar whole = std::fma(two, b, a);
    const Scalar low_identity = std::fma(-difference, d.t, whole - difference);
    const Scalar identity =
        std::fma(a, std::fma(-s, d.t, excess * third), std::fma(twice_b * inverse, d.q, std::fma(volumetric, d.t, volumetric)));
    const Mat3<Scalar> x = combine(d, is_low ? low_identity : identity, whole, difference, -difference);
    const Sym3<Scalar> g{
        twice_b * (e.m11 + e.m22), twice_b * (e.m00 + e.m22), twice_b * (e.m00 + e.m11), -b * e.m01, -b * e.m02, -b * e.m12};
    const Mat3<Scalar> y = times_gradient(d.h, g);
    return {x.m00 + y.m00, x.m01 + y.m01, x.m02 + y.m02, x.m10 + y.m10, x.m11 + y.m11,
            x.m12 + y.m12, x.m20 + y.m20, x.m21 + y.m21, x.m22 + y.m22};
  }
};

}  // namespace pliant::ref
