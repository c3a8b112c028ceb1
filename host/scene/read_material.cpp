#include <fmt/format.h>

#include <algorithm>

#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

namespace {

const char* const pairs = "exactly one of the pairs young + poisson, lambda + mu, mu + kappa";

/// The largest modulus is that of the material: what is said of it holds for all.
std::shared_ptr<const YoungField> read_field(const Reader& young, const ElasticConstants& e, const TaggedMesh* mesh) {
  if (mesh == nullptr) young.fail("a number: only the elements of a volume mesh (\"mesh\") have fields");
  auto field = std::make_shared<YoungField>();
  field->name = e.young->field;
  field->poisson = *e.poisson;
  field->values = mesh->values(field->name, young.pointer() + "/field");
  for (const double v : field->values) {
    if (v >= least_modulus && v <= most_modulus) field->largest = std::max(field->largest, v);
  }
  if (!(field->largest > 0)) young.fail(fmt::format("\"{}\" with moduli from 1e-30 to 1e30 Pa; it has none", field->name));
  return field;
}

Moduli read_moduli(const Reader& material, const TaggedMesh* mesh, std::shared_ptr<const YoungField>& field) {
  ElasticConstants e;
  describe_elastic(ReadKeys{material}, e);
  std::vector<std::string> given;
  for (const std::string& key : moduli_keys()) {
    if (material.has(key)) given.push_back(key);
  }
  if (given.size() == 2 && e.young && e.poisson) {
    if (!e.young->field.empty()) field = read_field(material.at("young"), e, mesh);
    return Moduli::from_young(field != nullptr ? field->largest : e.young->value, *e.poisson);
  }
  if (given.size() == 2 && e.mu && e.kappa) return Moduli::from_bulk(*e.mu, *e.kappa);
  if (given.size() != 2 || !e.mu || !e.lambda)
    material.fail(given.empty() ? "no elastic constants" : "the elastic constants " + listed(given), pairs);
  const Moduli m = Moduli::from_lame(*e.lambda, *e.mu);
  if (!(m.kappa > 0))
    material.at("lambda").fail(fmt::format("a number > -2 mu / 3 = {}, so that the bulk modulus is positive", -2 * m.mu / 3));
  return m;
}

std::vector<double> read_parameters(const Reader& material, const LawInfo& law) {
  std::vector<double> values;
  for (const ParameterInfo& p : law.parameters) {
    const Reader field = material.at(p.name, fmt::format("the {} of the law {} [{}]", p.what, law.word, p.unit));
    const double value = p.lower == least_modulus ? field.positive() : field.number();
    if (!(value >= p.lower && value <= p.upper)) field.fail(fmt::format("a number from {} to {}", p.lower, p.upper));
    values.push_back(value);
  }
  return values;
}

/// Elastic constants that the law does not take.
void refuse_foreign(const Reader& material, const LawInfo& law) {
  const std::vector<std::string> own = elastic_keys(law);
  for (const std::string& key : elastic_keys()) {
    if (!material.has(key) || std::find(own.begin(), own.end(), key) != own.end()) continue;
    material.at(key).fail(
        fmt::format("no \"{}\" with the law {}, which takes {}", key, law.word, law.takes_moduli ? pairs : listed(own)));
  }
}

void read_elasticity(const Reader& material, const TaggedMesh* mesh, Material& m) {
  const Law law = material.has("law") ? material.at("law").word(law_words()) : m.law;
  const LawInfo& info = law_info(law);
  refuse_foreign(material, info);
  if (info.takes_moduli) {
    m.set_moduli(law, read_moduli(material, mesh, m.young_field));
  } else {
    m.set_parameters(law, read_parameters(material, info));
  }
  // Float kernels use all three; poisson near 0.5 or -1 makes some of them run away.
  const Moduli& e = m.moduli;
  if (!(e.mu > 0 && e.mu <= most_modulus && e.kappa <= most_modulus && e.kappa >= least_modulus)) {
    material.fail(fmt::format("mu = {:g} Pa and kappa = {:g} Pa from these elastic constants", e.mu, e.kappa),
                  "moduli from 1e-30 to 1e30 Pa");
  }
}

}  // namespace

Material read_material(const Reader& material, const TaggedMesh* mesh) {
  material.expect_object("material");
  Material m;
  read_elasticity(material, mesh, m);
  describe_material(ReadKeys{material}, m);
  if (material.has("integrity") && m.toughness == 0) material.at("integrity").fail("no integrity without a toughness");
  return m;
}

}  // namespace pliant
