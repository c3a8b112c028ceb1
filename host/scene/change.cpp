#include "scene/change.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "pliant/error.h"
#include "scene/described_keys.h"
#include "scene/json_text.h"
#include "scene/parts.h"

namespace pliant {
namespace {

using Json = nlohmann::json;

/// The document of a scene with parameters, without its changes.
Json document_with(const Scene& scene, const Json& parameters) {
  Json top = document_of(scene);
  top.erase("changes");
  if (parameters.contains("gravity")) top["gravity"] = parameters["gravity"];
  const Json none = Json::object();
  const Json& bodies = parameters.contains("bodies") ? parameters["bodies"] : none;
  for (Json& body : top["bodies"]) {
    const auto changed = bodies.find(body["name"].get<std::string>());
    if (changed == bodies.end()) continue;
    for (const auto& [key, value] : changed->items()) {
      if (key != "inclusions") {
        body[key] = value;
        continue;
      }
      for (const auto& [index, material] : value.items()) body["inclusions"].at(std::stoul(index))["material"] = material;
    }
  }
  return top;
}

/// Copies what changes may change.
Scene with_values(const Scene& scene, const Scene& values) {
  Scene out = scene;
  out.gravity = values.gravity;
  out.gravity_curve = values.gravity_curve;
  for (std::size_t b = 0; b < out.bodies.size(); ++b) {
    Body& body = out.bodies[b];
    const Body& from = values.bodies.at(b);
    body.material = from.material;
    for (std::size_t i = 0; i < body.inclusions.size(); ++i) body.inclusions[i].material = from.inclusions.at(i).material;
    DeformationModel model = from.model;
    model.cells = body.model.cells;
    model.pointer = body.model.pointer;
    body.model = std::move(model);
    body.fixed = from.fixed;
  }
  return out;
}

Json parsed(const std::string& parameters) { return parameters.empty() ? Json::object() : Json::parse(parameters); }

/// Throws Error, or what nlohmann::json throws, for parameters that changed_parameters() cannot have made of this scene.
void check_form(const Json& parameters, const Scene& scene) {
  const Json none = Json::object();
  for (const auto& [key, value] : parameters.get_ref<const Json::object_t&>()) {
    if (key != "gravity" && key != "bodies") throw Error(ErrorCode::bad_input, fmt::format("\"{}\"", key));
  }
  const Json& bodies = parameters.contains("bodies") ? parameters["bodies"] : none;
  for (const auto& [name, body] : bodies.get_ref<const Json::object_t&>()) {
    const auto named = [&, &of = name](const Body& b) { return b.name == of; };
    if (std::none_of(scene.bodies.begin(), scene.bodies.end(), named))
      throw Error(ErrorCode::bad_input, fmt::format("a body \"{}\"", name));
    static_cast<void>(body.get_ref<const Json::object_t&>());
  }
}

/// The elastic constants that stay, beside those that a change gives; `given`: keys of the change.
void complete_moduli(Json& base, const Material& now, const std::vector<std::string>& given) {
  const Json before = base;
  for (const std::string& key : moduli_keys()) base.erase(key);
  if (given.size() != 1) return;
  const std::string& key = given.front();
  if (key == "young") base["poisson"] = now.young_field != nullptr ? now.young_field->poisson : now.moduli.poisson();
  if (key == "poisson") base["young"] = now.young_field != nullptr ? before.at("young") : Json(now.moduli.young());
  if (key == "lambda" || key == "kappa") base["mu"] = now.moduli.mu;
  if (key == "mu") base["lambda"] = now.moduli.lambda;
}

Json merged_material(Json base, const Material& now, const Json& change) {
  std::vector<std::string> given;
  for (const std::string& key : moduli_keys()) {
    if (change.contains(key)) given.push_back(key);
  }
  const bool same_law = !change.contains("law") || change["law"] == law_info(now.law).word;
  if (same_law && law_info(now.law).takes_moduli) {
    if (!given.empty()) complete_moduli(base, now, given);
  } else if (!same_law) {
    // A law that takes moduli too keeps them; one with parameters of its own gives them all.
    const auto other =
        std::find_if(law_words().begin(), law_words().end(), [&](const Word<Law>& w) { return change["law"] == w.word; });
    const bool keeps =
        given.empty() && law_info(now.law).takes_moduli && other != law_words().end() && law_info(other->value).takes_moduli;
    for (const std::string& key : elastic_keys()) {
      if (!keeps) base.erase(key);
    }
  }
  base.update(change);
  return base;
}

Json merged_model(Json base, const Reader& change) {
  for (const char* key : {"type", "follow", "cut"}) {
    if (!change.has(key) || (base.contains(key) && base[key] == change.at(key).json())) continue;
    change.at(key).fail(fmt::format("no other \"{}\" than the scene began with", key));
  }
  if (change.has("alpha")) base.erase("stiffness");
  if (change.has("stiffness")) base.erase("alpha");
  base.update(change.json());
  return base;
}

/// An axis alone would be held where it was at rest, and the node thrown there.
void check_held(const Reader& fixed) {
  for (const Reader& entry : fixed.items("a list of objects")) {
    entry.expect_object("fixed");
    if (entry.has("axes") && entry.at("axes").json() != "xyz")
      entry.at("axes").fail("\"xyz\": a change holds nodes where they are, in all directions");
  }
}

std::size_t body_of(const Reader& entry, const Scene& scene) {
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) names.push_back(body.name);
  if (!entry.has("body")) {
    if (names.size() > 1) entry.fail("no \"body\"", "the name of a body, one of " + listed(names));
    return 0;
  }
  const std::string name = entry.at("body").text("the name of a body");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) entry.at("body").fail("the name of a body, one of " + listed(names));
  return static_cast<std::size_t>(found - names.begin());
}

/// Only what tears has been prepared for it.
void check_toughness(const Reader& material, const Material& now) {
  if (material.has("toughness") && now.toughness == 0)
    material.at("toughness").fail("none: a material that did not tear when the scene began does not begin to");
}

/// Springs with a law of their own follow no modulus. Their dampers do where materials differ in stiffness_damping: an edge has
/// the mean of those around it, weighted by their moduli.
void check_springs(const Reader& material, const Body& now) {
  const DeformationModel& model = now.model;
  if (model.type != ModelType::mass_spring) return;
  if (model.edge_springs) {
    if (model.spring.law == SpringLaw::linear && model.spring.stiffness == 0) return;
    const auto differs = [&](const auto& i) { return i.material.stiffness_damping != now.material.stiffness_damping; };
    if (std::any_of(now.inclusions.begin(), now.inclusions.end(), differs)) return;
  }
  for (const std::string& key : elastic_keys()) {
    if (material.has(key))
      material.at(key).fail(fmt::format("no \"{}\": the springs of body \"{}\" have a law of their own", key, now.name));
  }
}

void change_material(const Reader& entry, Json& body, const Body& now, Json& kept) {
  const Reader change = entry.at("material");
  change.expect_object("material");
  check_springs(change, now);
  if (!entry.has("inclusion")) {
    check_toughness(change, now.material);
    kept["material"] = merged_material(body["material"], now.material, change.json());
    return;
  }
  if (now.inclusions.empty()) entry.at("inclusion").fail("no inclusion: the body has none");
  const auto i = entry.at("inclusion").integer(0, static_cast<std::int64_t>(now.inclusions.size()) - 1);
  const Material& material = now.inclusions[static_cast<std::size_t>(i)].material;
  check_toughness(change, material);
  kept["inclusions"][std::to_string(i)] =
      merged_material(body["inclusions"].at(static_cast<std::size_t>(i))["material"], material, change.json());
}

/// The parameters after one entry.
Json after(const Scene& scene, const Json& before, const Reader& entry) {
  entry.expect_object("change");
  Json parameters = before;
  bool changes = false;
  if (entry.has("gravity")) {
    parameters["gravity"] = entry.at("gravity").json();
    changes = true;
  }
  if (entry.has("inclusion") && !entry.has("material")) entry.at("inclusion").fail("no \"inclusion\" without a \"material\"");
  const bool of_body = entry.has("material") || entry.has("model") || entry.has("fixed");
  if (entry.has("body") && !of_body) entry.fail("a \"body\" of which nothing changes", "a material, a model or fixed");
  if (!changes && !of_body) entry.fail("no change", "at least one of gravity, material, model, fixed");
  if (!of_body) return parameters;
  const std::size_t b = body_of(entry, scene);
  const Scene now = with_values(scene, read_document(document_with(scene, before), scene.file));
  Json body = document_with(scene, before)["bodies"].at(b);
  Json& kept = parameters["bodies"][now.bodies[b].name];
  if (entry.has("material")) change_material(entry, body, now.bodies[b], kept);
  if (entry.has("model")) {
    const Reader model = entry.at("model");
    model.expect_object("model");
    if (!now.bodies[b].model.matches())
      model.fail("a model of a body without shape matching", "none: only the numbers of shape matching can change");
    if (model.has("substeps") && model.at("substeps").json() == "auto")
      model.at("substeps").fail("a whole number from 1 to 64: \"auto\" is chosen when a scene begins");
    kept["model"] = merged_model(body["model"], model);
  }
  if (entry.has("fixed")) {
    check_held(entry.at("fixed"));
    kept["fixed"] = entry.at("fixed").json();
  }
  return parameters;
}

/// read_document() with other words for the file.
void check(const Scene& scene, const Json& parameters, const std::string& where) {
  try {
    static_cast<void>(read_document(document_with(scene, parameters), scene.file));
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: the scene would be invalid: {}", where, error.what()));
  }
}

}  // namespace

Scene with_parameters(const Scene& scene, const std::string& parameters) {
  if (parameters.empty()) return scene;
  try {
    check_form(parsed(parameters), scene);
    return with_values(scene, read_document(document_with(scene, parsed(parameters)), scene.file));
  } catch (const std::exception& error) {
    throw Error(ErrorCode::bad_input, fmt::format("its changed parameters do not belong to this scene: {}", error.what()));
  }
}

std::string changed_parameters(const Scene& scene, const std::string& parameters, const std::string& change,
                               const std::string& where) {
  check_takes_changes(scene);
  const Json document = parse_json(change, where);
  const Reader entry(document, where, "");
  if (document.contains("time")) entry.at("time").fail("no time: the change happens now");
  const Json next = after(scene, parsed(parameters), entry);
  check(scene, next, where);
  return next.dump();
}

bool differ_in_gravity_alone(const std::string& a, const std::string& b) {
  Json of_a = parsed(a), of_b = parsed(b);
  of_a.erase("gravity");
  of_b.erase("gravity");
  return of_a == of_b;
}

void check_takes_changes(const Scene& scene) {
  if (scene.solver.enabled)
    throw Error(ErrorCode::bad_input, "a scene with \"solver\": {\"type\": \"static\"} has no changes: nothing runs");
  const IntegratorInfo& integrator = integrator_info(scene.integrator);
  if (!integrator.edits) {
    throw Error(ErrorCode::bad_input,
                fmt::format("a scene with \"integrator\": \"{}\" cannot change while it runs, only with {}", integrator.word,
                            integrators_with(&IntegratorInfo::edits)));
  }
}

std::vector<SceneChange> read_changes(const Reader& changes, const Scene& scene) {
  std::vector<SceneChange> all;
  Json parameters = Json::object();
  const std::string where = scene.file.empty() ? "scene" : scene.file.string();
  for (const Reader& entry : changes.items("a list of changes")) {
    entry.expect_object("change");
    if (all.empty()) {
      try {
        check_takes_changes(scene);
      } catch (const Error& error) {
        changes.fail("a list of changes", error.what());
      }
    }
    ChangePlace place;
    describe_change(ReadKeys{entry}, place);
    if (!all.empty() && place.time < all.back().time)
      entry.at("time").fail(fmt::format("a time that is not before the previous one, {} s", all.back().time));
    Json text = entry.json();
    text.erase("time");
    parameters = after(scene, parameters, entry);
    check(scene, parameters, where + ": " + entry.pointer());
    all.push_back({place.time, text.dump(), entry.pointer()});
  }
  return all;
}

}  // namespace pliant
