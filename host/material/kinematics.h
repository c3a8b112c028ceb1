// Kinematic quantities of the laws: F = I + H and its invariants in double, without cancellation at small strain, and parts
// of their tangents. A tangent component dP_ij/dF_kl is at row 3 i + j, column 3 k + l.
#pragma once
#include <Eigen/Dense>
#include <cmath>

namespace pliant {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// A function of J and its first two derivatives.
struct OfJ {
  double value = 0, slope = 0, curvature = 0;
};

struct Kinematics {
  using Matrix3d = Eigen::Matrix3d;
  Matrix3d h, f, cofactor;  ///< H = F - I, F, cof F
  double j = 0;             ///< J - 1
  double trace = 0;         ///< tr H
  double norm2 = 0;         ///< |H|^2
  double low = 0;           ///< Material::low
  Matrix3d difference;      ///< J F - cof F: J times F - F^-T, to rounding of its own size

  explicit Kinematics(const Matrix3d& gradient, double low_j = 0) : h(gradient), low(low_j) {
    const Matrix3d identity = Matrix3d::Identity(), minors = cofactor_of(h);
    trace = h.trace();
    norm2 = h.squaredNorm();
    f = identity + h;
    cofactor = (1 + trace) * identity - h.transpose() + minors;
    j = trace + minors.trace() + h.row(0).dot(minors.row(0));
    difference = h + h.transpose() + (j - trace) * identity + j * h - minors;
  }
  /// |F|^2 - 3.
  [[nodiscard]] double stretch() const { return 2 * trace + norm2; }
  /// Returns whether J is below `low`, where functions of J alone that are singular at 0 are continued by their second-order
  /// polynomials about `low`; the invariants of F^T F stay.
  [[nodiscard]] bool is_low() const { return 1 + j < low; }
  /// J^p, continued.
  [[nodiscard]] OfJ continued_power(double p) const {
    return continued({std::pow(low, p), p * std::pow(low, p - 1), p * (p - 1) * std::pow(low, p - 2)});
  }
  /// ln J, continued.
  [[nodiscard]] OfJ continued_log() const { return continued({std::log(low), 1 / low, -1 / (low * low)}); }

  /// F^-T; requires J != 0.
  [[nodiscard]] Matrix3d inverse_transposed() const { return cofactor / (1 + j); }

  static Matrix3d cofactor_of(const Matrix3d& m) {
    Matrix3d c;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d a = m.row((i + 1) % 3), b = m.row((i + 2) % 3);
      c.row(i) = a.cross(b);
    }
    return c;
  }

 private:
  [[nodiscard]] OfJ continued(const OfJ& at) const {
    const double d = 1 + j - low;
    return {at.value + d * (at.slope + d / 2 * at.curvature), at.slope + d * at.curvature, at.curvature};
  }
};

/// out_ijkl += scale a_ij b_kl
inline void add_product(Matrix9d& out, double scale, const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  for (int r = 0; r < 9; ++r) {
    for (int c = 0; c < 9; ++c) out(r, c) += scale * a(r / 3, r % 3) * b(c / 3, c % 3);
  }
}

/// out_ijkl += scale q_il q_kj: the derivative of -F^-T in the direction dF is q dF^T q with q = F^-T.
inline void add_crossed(Matrix9d& out, double scale, const Eigen::Matrix3d& q) {
  for (int r = 0; r < 9; ++r) {
    for (int c = 0; c < 9; ++c) out(r, c) += scale * q(r / 3, c % 3) * q(c / 3, r % 3);
  }
}

/// out_ijkl += scale d(cof F)_ij / dF_kl, which is linear in F for every J.
inline void add_cofactor_slope(Matrix9d& out, double scale, const Eigen::Matrix3d& f) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      // (cof F)_ij = F_i1j1 F_i2j2 - F_i1j2 F_i2j1
      const int row = 3 * i + j;
      out(row, 3 * i1 + j1) += scale * f(i2, j2);
      out(row, 3 * i2 + j2) += scale * f(i1, j1);
      out(row, 3 * i1 + j2) -= scale * f(i2, j1);
      out(row, 3 * i2 + j1) -= scale * f(i1, j2);
    }
  }
}

/// Second derivative of f(J) i(F), where i has the derivative `slope` and its second derivative is added by the caller:
/// out += scale (f' (slope cof + cof slope) + f'' i cof cof + f' i d(cof F)/dF).
inline void add_function_of_j(Matrix9d& out, double scale, const OfJ& f, double i, const Eigen::Matrix3d& slope,
                              const Kinematics& k) {
  add_product(out, scale * f.slope, slope, k.cofactor);
  add_product(out, scale * f.slope, k.cofactor, slope);
  add_product(out, scale * f.curvature * i, k.cofactor, k.cofactor);
  add_cofactor_slope(out, scale * f.slope * i, k.f);
}

}  // namespace pliant
