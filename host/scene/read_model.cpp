// The key "model" of a body and the key "focus" of a scene.
#include <fmt/format.h>

#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

namespace {

void refuse(const Reader& model, const std::vector<std::string>& keys, ModelType type, const char* needed) {
  for (const std::string& key : keys) {
    if (!model.has(key)) continue;
    model.at(key).fail(fmt::format("no \"{}\" with the type {} (it needs the type {})", key, to_string(type), needed));
  }
}

void refuse_both(const Reader& model, const std::string& a, const std::string& b, const char* expected) {
  if (model.has(a) && model.has(b)) model.fail(fmt::format("both \"{}\" and \"{}\"", a, b), expected);
}

void refuse_senseless(const Reader& model, ModelType type) {
  if (type != ModelType::hybrid) refuse(model, hybrid_keys(), type, "hybrid");
  const bool matching = type == ModelType::hybrid || type == ModelType::flsm;
  if (!matching) refuse(model, matching_keys(), type, "hybrid or flsm");
  if (type != ModelType::mass_spring) refuse(model, {"spring", "edge_springs"}, type, "mass-spring");
  for (const std::string& key : growth_keys()) refuse_both(model, "region", key, "either a region, or ratio, seed and follow");
  refuse_both(model, "alpha", "stiffness", "at most one: a stiffness chooses alpha");
}

/// What automatic substeps cannot have beside them: it belongs to a step of shape matching, whose length is chosen.
void check_automatic(const Reader& model, const DeformationModel& m) {
  const auto refuse = [&](const char* key, const char* instead) {
    model.at(key).fail(
        fmt::format("no {} with \"substeps\": \"auto\": it belongs to a step of shape matching, whose length is chosen "
                    "(give {} instead)",
                    key, instead));
  };
  if (model.has("alpha")) refuse("alpha", "a \"stiffness\"");
  if (m.damping > 0) refuse("damping", "a \"damping\" of the material");
  if (model.has("goals") && !m.extrapolate) model.at("goals").fail("\"extrapolated\" with \"substeps\": \"auto\"");
}

Selection read_region(const Reader& region) {
  region.expect_object("region");
  if (region.has("box") == region.has("sphere")) {
    region.fail(region.has("box") ? "both \"box\" and \"sphere\"" : "neither \"box\" nor \"sphere\"", "exactly one of them");
  }
  return read_selection(region, Selected::elements, {});
}

}  // namespace

DeformationModel read_model(const Reader& model, bool lattice) {
  model.expect_object("model");
  DeformationModel m;
  m.pointer = model.pointer();
  describe_type(ReadKeys{model}, m);
  if (lattice && m.type == ModelType::mass_spring) {
    model.at("type").fail(
        "tled, hybrid or flsm with a lattice (springs need a \"mesh\" of tetrahedra, or a surface with a \"thickness\")");
  }
  if (!lattice && m.matches()) {
    model.at("type").fail(
        "tled or mass-spring with a volume mesh or a sheet (shape matching needs a lattice: give a \"surface\" with a "
        "\"lattice\")");
  }
  refuse_senseless(model, m.type);
  describe_growth(ReadKeys{model}, m);
  describe_interface(ReadKeys{model}, m);
  describe_regions(ReadKeys{model}, m);
  if (m.substeps == 0) check_automatic(model, m);
  describe_alpha(ReadKeys{model}, m);
  if (model.has("region")) m.region = read_region(model.at("region"));
  if (model.has("stiffness")) {
    const Reader stiffness = model.at("stiffness");
    stiffness.expect_object("stiffness");
    describe_stiffness(ReadKeys{stiffness}, m);
  }
  describe_network(ReadKeys{model}, m);
  if (model.has("spring")) m.spring = read_spring(model.at("spring"));
  m.matched = m.type == ModelType::hybrid && !model.has("alpha") && !model.has("stiffness");
  return m;
}

Focus read_focus(const Reader& focus) {
  focus.expect_object("focus");
  Focus f;
  const char* const expected = "a list of at least one row [time, x, y, z]";
  f.path = read_rows<4>(focus.at("path", expected), expected, "a row [time, x, y, z] in seconds and metres");
  return f;
}

/// Whether there is something of the name that "follow" gives.
void check_follow(const Reader& follow, const Scene& scene, const std::string& name) {
  if (name == kFocus) {
    if (!scene.focus.path.empty()) return;
    follow.fail("the scene's key \"focus\" to follow, such as \"focus\": {\"path\": [[0, 0, 0.1, 0]]}");
  }
  if (name.starts_with(kHostBlade) && name.size() > std::string_view(kHostBlade).size()) return;
  std::vector<std::string> names{kFocus};
  for (const Blade& blade : scene.blades) names.push_back(blade.name);
  for (const ContactTool& tool : scene.tools) {
    if (tool.name == name && tool.shape == ToolShape::half_space)
      follow.fail("something that is in one place, which a half space is not");
    names.push_back(tool.name);
  }
  if (std::find(names.begin(), names.end(), name) == names.end())
    follow.fail(fmt::format("the name of a target of the region, one of {}, or {}NAME for a blade that a program moves",
                            listed(names), kHostBlade));
}

/// Beside a damping in proportion to stiffness, which springs have, too.
static bool has_viscosity(const Body& body) {
  const auto of = [](const Material& m) { return m.viscosity > 0 || m.bulk_viscosity > 0; };
  return of(body.material) ||
         std::any_of(body.inclusions.begin(), body.inclusions.end(), [&](const Inclusion& i) { return of(i.material); });
}

void check_viscous(const Reader& top, const Scene& scene) {
  for (const Body& body : scene.bodies) {
    bool viscous = body.material.viscous();
    for (const Inclusion& inclusion : body.inclusions) viscous = viscous || inclusion.material.viscous();
    if (!viscous) continue;
    require_integrator(top, scene, &IntegratorInfo::keeps_increment,
                       fmt::format("{} has a {}", body.pointer, has_viscosity(body) ? "viscosity" : "stiffness_damping"));
    if (body.model.type == ModelType::tled || (body.model.type == ModelType::mass_spring && !has_viscosity(body))) continue;
    const std::vector<Reader> bodies = top.at("bodies").items("a list of bodies");
    const Reader type = bodies[static_cast<std::size_t>(&body - scene.bodies.data())].at("model").at("type");
    if (has_viscosity(body)) type.fail(fmt::format("tled, because {} has a viscosity, which is one of elements", body.pointer));
    type.fail(fmt::format("tled or mass-spring, because {} has a stiffness_damping", body.pointer));
  }
}

void check_models(const Reader& top, const Scene& scene) {
  const std::vector<Reader> bodies = top.at("bodies").items("a list of bodies");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const DeformationModel& m = scene.bodies[i].model;
    if (!m.matches()) continue;
    require_integrator(top, scene, &IntegratorInfo::matching, fmt::format("{} has the type {}", m.pointer, to_string(m.type)));
    if (m.follow.empty()) continue;
    if (scene.relaxation.enabled) {
      top.at("relaxation").fail(fmt::format("false, because {}/follow moves the region as time goes on", m.pointer));
    }
    check_follow(bodies[i].at("model").at("follow"), scene, m.follow);
  }
}

}  // namespace pliant
