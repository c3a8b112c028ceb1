// The three laws in their textbook form, in double with Eigen: the oracle that is neither twin.
#pragma once
#include <Eigen/Dense>
#include <cmath>
#include <optional>

#include "layout.h"

namespace pliant::kernel_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// First Piola-Kirchhoff stress P = F S [Pa]. `pressure` replaces dU/dJ = p1 (J - 1).
inline Matrix3d piola_stress(int law, const Matrix3d& f, double p0, double p1, std::optional<double> pressure = {}) {
  const Matrix3d identity = Matrix3d::Identity(), c = f.transpose() * f, inverse = c.inverse();
  const double j = f.determinant(), p = pressure.value_or(p1 * (j - 1));
  Matrix3d s;
  if (law == PLIANT_LAW_NEO_HOOKEAN) {
    s = p0 * (identity - inverse) + p * j * inverse;
  } else if (law == PLIANT_LAW_SAINT_VENANT_KIRCHHOFF) {
    const Matrix3d e = 0.5 * (c - identity);
    s = p1 * e.trace() * identity + 2 * p0 * e;
  } else {
    s = p0 * std::pow(j, -2.0 / 3) * (identity - c.trace() / 3 * inverse) + p * j * inverse;
  }
  return f * s;
}

/// Strain energy density W(F) [Pa].
inline double energy_density(int law, const Matrix3d& f, double p0, double p1) {
  const Matrix3d c = f.transpose() * f;
  const double j = f.determinant(), volumetric = p1 / 2 * (j - 1) * (j - 1);
  if (law == PLIANT_LAW_NEO_HOOKEAN) return p0 / 2 * (c.trace() - 3) - p0 * std::log(j) + volumetric;
  if (law == PLIANT_LAW_SAINT_VENANT_KIRCHHOFF) {
    const Matrix3d e = 0.5 * (c - Matrix3d::Identity());
    return p1 / 2 * e.trace() * e.trace() + p0 * (e * e).trace();
  }
  return p0 / 2 * (std::pow(j, -2.0 / 3) * c.trace() - 3) + volumetric;
}

}  // namespace pliant::kernel_test
