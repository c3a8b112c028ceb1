#include <fmt/format.h>

#include "scene/parts.h"

namespace pliant {

namespace {

const char* const pairs = "exactly one of the pairs young + poisson, lambda + mu, mu + kappa";

/// "young, mu": the moduli that are there.
std::vector<std::string> given_moduli(const Reader& material) {
  std::vector<std::string> given;
  for (const char* key : {"young", "poisson", "lambda", "mu", "kappa"}) {
    if (material.has(key)) given.emplace_back(key);
  }
  return given;
}

void from_young(const Reader& material, Material& m) {
  const double young = material.at("young").positive();
  const Reader field = material.at("poisson");
  const double poisson = field.number("a number with -1 < poisson < 0.5");
  if (!(poisson > -1 && poisson < 0.5)) field.fail("a number with -1 < poisson < 0.5");
  m.mu = young / (2 * (1 + poisson));
  m.lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  m.kappa = m.lambda + 2 * m.mu / 3;
}

void from_lame(const Reader& material, Material& m) {
  m.mu = material.at("mu").positive();
  const Reader field = material.at("lambda");
  m.lambda = field.number();
  m.kappa = m.lambda + 2 * m.mu / 3;
  if (!(m.kappa > 0)) field.fail(fmt::format("a number > -2 mu / 3 = {}, so that the bulk modulus is positive", -2 * m.mu / 3));
}

}  // namespace

Material read_material(const Reader& material) {
  material.expect_object("material");
  Material m;
  if (material.has("law")) m.law = material.at("law").word(law_words());
  const std::vector<std::string> given = given_moduli(material);
  if (given == std::vector<std::string>{"young", "poisson"}) {
    from_young(material, m);
  } else if (given == std::vector<std::string>{"lambda", "mu"}) {
    from_lame(material, m);
  } else if (given == std::vector<std::string>{"mu", "kappa"}) {
    m.mu = material.at("mu").positive();
    m.kappa = material.at("kappa").positive();
    m.lambda = m.kappa - 2 * m.mu / 3;
  } else {
    material.fail(given.empty() ? "no elastic constants" : "the elastic constants " + listed(given), pairs);
  }
  // Float kernels use all three; poisson near 0.5 or -1 makes some of them run away.
  if (!(m.mu <= 1e30 && m.kappa <= 1e30 && m.kappa >= 1e-30)) {
    material.fail(fmt::format("mu = {:g} Pa and kappa = {:g} Pa from these elastic constants", m.mu, m.kappa),
                  "moduli from 1e-30 to 1e30 Pa");
  }
  if (material.has("density")) m.density = material.at("density").positive();
  if (material.has("damping")) m.damping = material.at("damping").non_negative();
  if (material.has("hourglass")) m.hourglass = material.at("hourglass").non_negative();
  if (material.has("toughness")) m.toughness = material.at("toughness").positive();
  if (material.has("integrity")) {
    const Reader integrity = material.at("integrity");
    m.integrity = integrity.positive();
    if (m.toughness == 0) integrity.fail("no integrity without a toughness");
    if (!(m.integrity <= 1)) integrity.fail("a number with 0 < integrity <= 1");
  }
  return m;
}

}  // namespace pliant
