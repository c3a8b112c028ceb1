#include "statics/law.h"

#include <cmath>

namespace pliant::statics {
namespace {

using Eigen::Matrix3d;

/// What the laws share: I + h, its cofactors, J - 1 without cancellation.
struct Kinematics {
  Matrix3d f, cofactor;
  double j = 0;      ///< J - 1
  double trace = 0;  ///< tr h
  double norm2 = 0;  ///< |h|^2
  /// (J F - cof F): J times F - F^-T, to rounding of its own size.
  Matrix3d difference;
};

Matrix3d cofactor_of(const Matrix3d& m) {
  Matrix3d c;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = m.row((i + 1) % 3), b = m.row((i + 2) % 3);
    c.row(i) = a.cross(b);
  }
  return c;
}

Kinematics kinematics_of(const Matrix3d& h) {
  Kinematics k;
  const Matrix3d identity = Matrix3d::Identity();
  const Matrix3d minors = cofactor_of(h);
  k.trace = h.trace();
  k.norm2 = h.squaredNorm();
  k.f = identity + h;
  k.cofactor = (1 + k.trace) * identity - h.transpose() + minors;
  k.j = k.trace + minors.trace() + h.row(0).dot(minors.row(0));
  k.difference = h + h.transpose() + (k.j - k.trace) * identity + k.j * h - minors;
  return k;
}

/// out_ijkl += scale a_ij b_kl
void add_product(Matrix9d& out, double scale, const Matrix3d& a, const Matrix3d& b) {
  for (int r = 0; r < 9; ++r) {
    for (int c = 0; c < 9; ++c) out(r, c) += scale * a(r / 3, r % 3) * b(c / 3, c % 3);
  }
}

/// out_ijkl += scale q_il q_kj: the derivative of -F^-T in the direction dF is q dF^T q.
void add_crossed(Matrix9d& out, double scale, const Matrix3d& q) {
  for (int r = 0; r < 9; ++r) {
    for (int c = 0; c < 9; ++c) out(r, c) += scale * q(r / 3, c % 3) * q(c / 3, r % 3);
  }
}

void neo_hookean(const Material& m, const Kinematics& k, bool tangent, Response& out) {
  const double j = 1 + k.j;
  out.energy = m.mu / 2 * (2 * k.trace + k.norm2) - m.mu * std::log1p(k.j) + m.lambda / 2 * k.j * k.j;
  out.stress = m.mu / j * k.difference + m.lambda * k.j * k.cofactor;
  if (!tangent) return;
  const Matrix3d q = k.cofactor / j;
  out.tangent = m.mu * Matrix9d::Identity();
  add_crossed(out.tangent, m.mu - m.lambda * k.j * j, q);
  add_product(out.tangent, m.lambda * (1 + 2 * k.j) * j, q, q);
}

void isochoric(const Material& m, const Kinematics& k, bool tangent, Response& out) {
  const double j = 1 + k.j;
  const double stretch = (2 * k.trace + k.norm2) / 3;  // I1 / 3 - 1
  const double root = std::exp(-2.0 / 3 * std::log1p(k.j));
  // J^-2/3 I1 - 3 = 3 (J^-2/3 (1 + stretch) - 1)
  out.energy = 1.5 * m.mu * std::expm1(std::log1p(stretch) - 2.0 / 3 * std::log1p(k.j)) + m.kappa / 2 * k.j * k.j;
  const Matrix3d deviator = (k.difference - stretch * k.cofactor) / j;  // F - I1/3 F^-T
  out.stress = m.mu * root * deviator + m.kappa * k.j * k.cofactor;
  if (!tangent) return;
  const Matrix3d q = k.cofactor / j;
  const double g = m.mu * root;
  out.tangent = g * Matrix9d::Identity();
  add_product(out.tangent, -2.0 / 3 * g, q, k.f);
  add_product(out.tangent, -2.0 / 3 * g, deviator, q);
  add_crossed(out.tangent, g * (1 + stretch) - m.kappa * k.j * j, q);
  add_product(out.tangent, m.kappa * (1 + 2 * k.j) * j, q, q);
}

void saint_venant_kirchhoff(const Material& m, const Kinematics& k, const Matrix3d& h, bool tangent, Response& out) {
  const Matrix3d identity = Matrix3d::Identity();
  const Matrix3d strain = 0.5 * (h + h.transpose() + h.transpose() * h);
  const Matrix3d second = m.lambda * strain.trace() * identity + 2 * m.mu * strain;
  out.energy = m.lambda / 2 * strain.trace() * strain.trace() + m.mu * strain.squaredNorm();
  out.stress = k.f * second;
  if (!tangent) return;
  const Matrix3d left = k.f * k.f.transpose();
  out.tangent.setZero();
  add_product(out.tangent, m.lambda, k.f, k.f);
  add_crossed(out.tangent, m.mu, k.f);
  for (int r = 0; r < 9; ++r) {
    for (int c = 0; c < 9; ++c) {
      if (r / 3 == c / 3) out.tangent(r, c) += second(r % 3, c % 3);
      if (r % 3 == c % 3) out.tangent(r, c) += m.mu * left(r / 3, c / 3);
    }
  }
}

}  // namespace

bool respond(const Material& material, const Matrix3d& h, bool tangent, Response& out) {
  const Kinematics k = kinematics_of(h);
  if (!(1 + k.j > 0 && std::isfinite(k.j))) return false;
  switch (material.law) {
    case Law::neo_hookean:
      neo_hookean(material, k, tangent, out);
      break;
    case Law::isochoric_neo_hookean:
      isochoric(material, k, tangent, out);
      break;
    case Law::saint_venant_kirchhoff:
      saint_venant_kirchhoff(material, k, h, tangent, out);
      break;
  }
  return true;
}

void respond_linear(const Material& material, const Matrix3d& h, Response& out) {
  const double lambda = material.law == Law::isochoric_neo_hookean ? material.kappa - 2 * material.mu / 3 : material.lambda;
  const Matrix3d identity = Matrix3d::Identity(), strain = 0.5 * (h + h.transpose());
  out.stress = lambda * strain.trace() * identity + 2 * material.mu * strain;
  out.energy = 0.5 * out.stress.cwiseProduct(strain).sum();
  out.tangent = material.mu * Matrix9d::Identity();
  add_crossed(out.tangent, material.mu, identity);
  add_product(out.tangent, lambda, identity, identity);
}

}  // namespace pliant::statics
