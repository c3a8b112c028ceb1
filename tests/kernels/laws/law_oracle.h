// The laws in their textbook form: energies W(F), whose stress follows by differentiation. The third leg beside kernel and
// twin, and beside host/material: it shares nothing with any of them.
#pragma once
#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <vector>

#include "laws.h"

namespace pliant::kernel_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A number and its derivatives by the nine components of F.
struct Dual {
  using Slope = Eigen::Matrix<double, 9, 1>;
  double value = 0;
  Slope slope = Slope::Zero();
  Dual(double v = 0) : value(v) {}  // NOLINT: numbers are constants
  Dual(double v, Slope s) : value(v), slope(std::move(s)) {}
  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.value * b.value, a.value * b.slope + b.value * a.slope}; }
  friend Dual log(const Dual& a) { return {std::log(a.value), a.slope / a.value}; }
  friend Dual pow(const Dual& a, double n) { return {std::pow(a.value, n), n * std::pow(a.value, n - 1) * a.slope}; }
};

inline double value_of(double a) { return a; }
inline double value_of(const Dual& a) { return a.value; }

/// Below J = 1/4: Taylor's polynomial of second order about it.
template <class Number>
Number from_quarter(const Number& j, double value, double first, double second) {
  const Number d = j - Number(0.25);
  return Number(value) + Number(first) * d + Number(second / 2) * d * d;
}
template <class Number>
Number low_log(const Number& j) {
  using std::log;
  return value_of(j) < 0.25 ? from_quarter(j, std::log(0.25), 4, -16) : log(j);
}
template <class Number>
Number low_pow(const Number& j, double n) {
  using std::pow;
  if (!(value_of(j) < 0.25)) return pow(j, n);
  return from_quarter(j, std::pow(0.25, n), n * std::pow(0.25, n - 1), n * (n - 1) * std::pow(0.25, n - 2));
}

/// What energies of isotropic materials are made of: C = F^T F, I1 = tr C, I2 = ((tr C)^2 - tr C^2) / 2, J = det F.
template <class Number>
struct Invariants {
  Number i1{}, i2{}, j{}, c_squared{};  ///< c_squared: tr C^2
  explicit Invariants(const Number (&f)[9]) {
    Number c[9];
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) c[3 * a + b] = f[a] * f[b] + f[3 + a] * f[3 + b] + f[6 + a] * f[6 + b];
    }
    i1 = c[0] + c[4] + c[8];
    for (const Number& x : c) c_squared = c_squared + x * x;
    i2 = 0.5 * (i1 * i1 - c_squared);
    j = f[0] * (f[4] * f[8] - f[5] * f[7]) + f[1] * (f[5] * f[6] - f[3] * f[8]) + f[2] * (f[3] * f[7] - f[4] * f[6]);
  }
};

/// W without the volumetric part U(J) = k/2 (J - 1)^2, and k (0: the law has no such part), continued below J = 1/4 if it is
/// singular at 0. `p`: its parameters, in the order of docs/scene.md.
template <class Number>
struct Textbook {
  Number energy;
  double bulk = 0;
};
template <class Number>
Textbook<Number> textbook(Law law, const Number (&f)[9], const std::vector<double>& p) {
  using std::log;
  const Invariants<Number> k(f);
  switch (law) {
    case Law::neo_hookean:  // mu, lambda
      return {p[0] / 2 * (k.i1 - 3) - p[0] * low_log(k.j), p[1]};
    case Law::saint_venant_kirchhoff:  // mu, lambda; tr E = (I1 - 3) / 2, E:E = (tr C^2 - 2 I1 + 3) / 4
    {
      const Number below = value_of(k.j) < 0.25 ? Number(0.25) - k.j : Number(0);
      return {p[1] / 8 * (k.i1 - 3) * (k.i1 - 3) + p[0] / 4 * (k.c_squared - 2 * k.i1 + 3) +
                  16 * (p[1] + 2 * p[0]) / 3 * below * below * below,
              0};
    }
    case Law::isochoric_neo_hookean:  // mu, kappa
      return {p[0] / 2 * (low_pow(k.j, -2.0 / 3) * k.i1 - 3), p[1]};
    case Law::mooney_rivlin:  // c10, c01, kappa
      return {p[0] * (low_pow(k.j, -2.0 / 3) * k.i1 - 3) + p[1] * (low_pow(k.j, -4.0 / 3) * k.i2 - 3), p[2]};
    case Law::yeoh: {  // c10, c20, c30, kappa
      const Number x = low_pow(k.j, -2.0 / 3) * k.i1 - 3;
      return {x * (p[0] + x * (p[1] + x * p[2])), p[3]};
    }
    case Law::stable_neo_hookean: {  // mu, lambda of linear elasticity
      const double mu = 4 * p[0] / 3, lambda = p[1] + 5 * p[0] / 6, alpha = 1 + mu / lambda - mu / (4 * lambda);
      const Number volume = lambda / 2 * ((k.j - alpha) * (k.j - alpha) - (k.j - 1) * (k.j - 1));  // beside U(J)
      return {mu / 2 * (k.i1 - 3) - mu / 2 * log(k.i1 + 1) + volume, lambda};
    }
  }
  return {};
}

inline Matrix3d cofactors(const Matrix3d& f) {
  Matrix3d c;
  for (int i = 0; i < 3; ++i) c.row(i) = f.row((i + 1) % 3).cross(f.row((i + 2) % 3));
  return c;
}

/// First Piola-Kirchhoff stress P = dW/dF [Pa]. `pressure` replaces dU/dJ where there is a volumetric part.
inline Matrix3d piola_stress(Law law, const Matrix3d& f, const std::vector<double>& p, std::optional<double> pressure = {}) {
  Dual components[9];
  for (int c = 0; c < 9; ++c) components[c] = {f(c / 3, c % 3), Dual::Slope::Unit(c)};
  const Textbook<Dual> w = textbook(law, components, p);
  const double dudj = w.bulk == 0 ? 0 : pressure.value_or(w.bulk * (f.determinant() - 1));
  Matrix3d stress = dudj * cofactors(f);
  for (int c = 0; c < 9; ++c) stress(c / 3, c % 3) += w.energy.slope[c];
  return stress;
}

/// Strain energy density W(F) [Pa].
inline double energy_density(Law law, const Matrix3d& f, const std::vector<double>& p) {
  double components[9];
  for (int c = 0; c < 9; ++c) components[c] = f(c / 3, c % 3);
  const Textbook<double> w = textbook(law, components, p);
  const double dilation = f.determinant() - 1;
  return w.energy + w.bulk / 2 * dilation * dilation;
}

}  // namespace pliant::kernel_test
