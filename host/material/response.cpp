#include "material/response.h"

#include <cmath>

#include "material/every_law.h"

namespace pliant {

using Eigen::Matrix3d;

bool respond(const Material& material, const Matrix3d& h, bool tangent, Response& out) {
  const Kinematics k(h, material.low);
  if (!std::isfinite(k.j) || !(1 + k.j > 0 || material.low > 0 || law_info(material.law).invertible)) return false;
  with_law(material, [&](const auto& law) {
    const double bulk = law.bulk();
    out.energy = law.energy(k) + bulk / 2 * k.j * k.j;
    out.stress = law.stress(k) + bulk * k.j * k.cofactor;
    if (!tangent) return;
    out.tangent.setZero();
    law.add_tangent(k, out.tangent);
    add_product(out.tangent, bulk, k.cofactor, k.cofactor);
    add_cofactor_slope(out.tangent, bulk * k.j, k.f);
  });
  return true;
}

void respond_linear(const Material& material, const Matrix3d& h, Response& out) {
  const Moduli& m = material.moduli;
  const Matrix3d identity = Matrix3d::Identity(), strain = 0.5 * (h + h.transpose());
  out.stress = m.lambda * strain.trace() * identity + 2 * m.mu * strain;
  out.energy = 0.5 * out.stress.cwiseProduct(strain).sum();
  out.tangent = m.mu * Matrix9d::Identity();
  add_crossed(out.tangent, m.mu, identity);
  add_product(out.tangent, m.lambda, identity, identity);
}

double energy_without_volume(const Material& material, const Matrix3d& h) {
  const Kinematics k(h, material.low);
  return with_law(material, [&](const auto& law) { return law.energy(k); });
}

double volume_modulus(const Material& material) {
  return with_law(material, [](const auto& law) { return law.bulk(); });
}

Matrix3d green_strain(const Matrix3d& h) { return 0.5 * (h + h.transpose() + h.transpose() * h); }

/// As F^-T E F^-1, which does not cancel at small strain.
std::optional<Matrix3d> almansi_strain(const Matrix3d& h) {
  const Kinematics k(h);
  if (!(1 + k.j > 0) || !h.allFinite()) return {};
  const Matrix3d inverse = k.inverse_transposed();
  return inverse * green_strain(h) * inverse.transpose();
}

std::optional<Matrix3d> cauchy_stress(const Material& material, const Matrix3d& h) {
  const double j = 1 + Kinematics(h).j;
  Response out;
  if (!(j > 0) || !h.allFinite() || !respond(material, h, false, out)) return {};
  return out.stress * (Matrix3d::Identity() + h).transpose() / j;
}

}  // namespace pliant
