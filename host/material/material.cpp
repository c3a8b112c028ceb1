#include "material/material.h"

#include <utility>

#include "material/every_law.h"

namespace pliant {

Moduli Moduli::from_young(double young, double poisson) {
  return from_lame(young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson)));
}

Moduli Moduli::from_lame(double lambda, double mu) { return {mu, lambda, lambda + 2 * mu / 3}; }

Moduli Moduli::from_bulk(double mu, double kappa) { return {mu, kappa - 2 * mu / 3, kappa}; }

std::span<const Law, law_count> all_laws() {
#define PLIANT_LAW(stem, Type) Law::stem,
  static constexpr Law laws[law_count]{PLIANT_LAWS(PLIANT_LAW)};
#undef PLIANT_LAW
  return laws;
}

const LawInfo& law_info(Law law) {
  return with_law(law, []<class Type>(std::type_identity<Type>) -> const LawInfo& { return Type::info; });
}

void Material::set_moduli(Law new_law, const Moduli& new_moduli) {
  law = new_law;
  moduli = new_moduli;
  parameters = with_law(law, [&]<class Type>(std::type_identity<Type>) { return Type::from_moduli(new_moduli); });
}

void Material::set_parameters(Law new_law, std::vector<double> new_parameters) {
  law = new_law;
  parameters = std::move(new_parameters);
  moduli = with_law(*this, [](const auto& l) { return l.moduli(); });
}

Material Material::scaled(double factor) const {
  Material out = *this;
  for (double& p : out.parameters) p *= factor;
  out.moduli = {factor * moduli.mu, factor * moduli.lambda, factor * moduli.kappa};
  return out;
}

Material make_material(Law law, const Moduli& moduli, double density) {
  Material m;
  m.set_moduli(law, moduli);
  m.density = density;
  return m;
}

std::vector<double> law_constants(const Material& material) {
  std::vector<double> constants = with_law(material, [](const auto& l) { return l.constants(); });
  constants.insert(constants.begin(), material.low);
  return constants;
}

}  // namespace pliant
