// The first invariant of the isochoric part of C, I1* = J^-2/3 I1 (Flory 1961), and its derivatives, for laws that depend on
// it. Below k.low J^-2/3 is continued.
#pragma once
#include <cmath>

#include "material/kinematics.h"

namespace pliant {

struct IsochoricFirst {
  double excess = 0;         ///< I1* - 3
  Eigen::Matrix3d gradient;  ///< dI1*/dF = 2 J^-2/3 (F - I1/3 F^-T)

  explicit IsochoricFirst(const Kinematics& k) {
    third_ = k.stretch() / 3;  // I1 / 3 - 1
    if (k.is_low()) {
      power_ = k.continued_power(-2.0 / 3);
      excess = power_.value * (3 + k.stretch()) - 3;
      gradient = 2 * power_.value * k.f + power_.slope * (3 + k.stretch()) * k.cofactor;
      return;
    }
    root_ = std::exp(-2.0 / 3 * std::log1p(k.j));
    excess = 3 * std::expm1(std::log1p(third_) - 2.0 / 3 * std::log1p(k.j));
    deviator_ = (k.difference - third_ * k.cofactor) / (1 + k.j);
    gradient = 2 * root_ * deviator_;
  }
  /// out += scale d2I1*/dF2
  void add_curvature(const Kinematics& k, double scale, Matrix9d& out) const {
    if (k.is_low()) {
      out += 2 * scale * power_.value * Matrix9d::Identity();
      add_function_of_j(out, scale, power_, 3 + k.stretch(), 2 * k.f, k);
      return;
    }
    const Eigen::Matrix3d q = k.inverse_transposed();
    const double g = 2 * scale * root_;
    out += g * Matrix9d::Identity();
    add_product(out, -2.0 / 3 * g, q, k.f);
    add_product(out, -2.0 / 3 * g, deviator_, q);
    add_crossed(out, g * (1 + third_), q);
  }

 private:
  double third_ = 0, root_ = 0;
  OfJ power_;                 ///< J^-2/3, continued
  Eigen::Matrix3d deviator_;  ///< F - I1/3 F^-T
};

}  // namespace pliant
