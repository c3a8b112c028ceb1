#include <fmt/format.h>

#include <algorithm>

#include "scene/described_keys.h"
#include "scene/parts.h"
#include "scene/probe.h"

namespace pliant {

namespace {

/// Returns the body whose nodes a probe uses.
const Body& read_whose(const Reader& probe, const Scene& scene) {
  if (!probe.has("body")) {
    if (scene.bodies.size() == 1) return scene.bodies[0];
    probe.fail("no \"body\"", "the name of a body, because the scene has several");
  }
  const Reader field = probe.at("body");
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) {
    if (field.json() == body.name) return body;
    names.push_back(body.name);
  }
  field.fail_word(names);
}

/// Returns a tool or a body, and a body or nothing.
std::vector<std::string> read_between(const Reader& field, const Scene& scene) {
  std::vector<std::string> tools, bodies, names;
  for (const ContactTool& tool : scene.tools) tools.push_back(tool.name);
  for (const Body& body : scene.bodies) bodies.push_back(body.name);
  std::vector<std::string> all = tools;
  all.insert(all.end(), bodies.begin(), bodies.end());
  const char* const expected = "the name of a tool or a body, and that of another body, or none for all bodies";
  for (const Reader& entry : field.items(expected, 1)) {
    const std::vector<std::string>& known = names.empty() ? all : bodies;
    const auto same = [&](const std::string& name) { return entry.json() == name; };
    if (std::none_of(known.begin(), known.end(), same)) entry.fail_word(known);
    if (std::any_of(tools.begin(), tools.end(), same) && std::any_of(bodies.begin(), bodies.end(), same))
      entry.fail("a name that a tool and a body do not share");
    names.push_back(entry.json());
  }
  if (names.size() > 2 || (names.size() == 2 && names[0] == names[1])) field.fail(expected);
  return names;
}

std::vector<Quantity> read_quantities(const Reader& probe, bool point, bool between) {
  if (!probe.has("quantities")) {
    if (between) return {Quantity::interpenetration};
    return {Quantity::position, Quantity::displacement, Quantity::velocity};
  }
  std::vector<Quantity> list;
  for (const Reader& entry : probe.at("quantities").items("a list of at least one quantity", 1)) {
    const Quantity q = entry.word(quantity_words());
    const std::string& word = word_of(quantity_words(), q);
    if (between && q != Quantity::interpenetration)
      entry.fail(fmt::format("no {} between tools and bodies: only their interpenetration", word));
    if (!between && q == Quantity::interpenetration)
      entry.fail("no interpenetration of a point or a selection: \"between\": [a tool or a body, a body] has one");
    if (point && (q == Quantity::reaction || q == Quantity::force || q == Quantity::energy))
      entry.fail(fmt::format("no {} of a point: a selection of nodes (box, plane, ...) has one", word));
    if (!point && (q == Quantity::stress || q == Quantity::green_strain || q == Quantity::almansi_strain))
      entry.fail(fmt::format("no {} of a selection: a \"point\" has one", word));
    if (std::find(list.begin(), list.end(), q) != list.end()) entry.fail("every quantity at most once");
    list.push_back(q);
  }
  return list;
}

SceneProbe read_probe(const Reader& probe, const Scene& scene) {
  probe.expect_object("probe");
  SceneProbe out;
  out.pointer = probe.pointer();
  // Files and columns are named after probes.
  const Reader name = probe.at("name", "a name of 1 to 100 characters");
  out.name = read_name(name, "slashes, commas, quotation marks", "/\\,\"");
  if (out.name[0] == '.') name.fail("a name without a dot at its beginning");
  const bool point = probe.has("point");
  const bool between = probe.has("between");
  out.quantities = read_quantities(probe, point, between);
  if (point || between) {
    for (const char* key : {"box", "sphere", "plane", "surface", "region", "data", "dimension", "nodes", "all", "body"}) {
      if (probe.has(key)) probe.at(key).fail(fmt::format("no \"{}\" with {}", key, point ? "a \"point\"" : "\"between\""));
    }
    if (point && between) probe.at("between").fail("no \"between\" with a \"point\"");
    if (between) out.between = read_between(probe.at("between"), scene);
    describe_place(ReadKeys{probe}, out);
    return out;
  }
  const Body& body = read_whose(probe, scene);
  out.body = body.name;
  out.where = read_selection(probe, Selected::nodes, frame_of(body, scene.file.parent_path()));
  for (const Quantity q : out.quantities) {
    if ((q != Quantity::reaction && q != Quantity::energy) || !body.model.matches()) continue;
    probe.fail(fmt::format("{} {} of body \"{}\", whose model is {}", q == Quantity::reaction ? "a" : "an",
                           word_of(quantity_words(), q), body.name, to_string(body.model.type)),
               "a body of finite elements (tled): shape matching knows no forces and no energy");
  }
  return out;
}

void read_every(const Reader& field, SceneProbes& probes) {
  if (!field.json().is_object()) {
    probes.every_seconds = field.number("a time in seconds of at least 1e-9, or {\"steps\": N}");
    if (!(probes.every_seconds >= 1e-9)) field.fail("a time in seconds of at least 1e-9, or {\"steps\": N}");
    return;
  }
  field.expect_object("probe_every");
  describe_pace(ReadKeys{field}, probes);
}

}  // namespace

std::shared_ptr<const SceneProbes> read_probes(const Reader& top, const Scene& scene) {
  if (!top.has("probes")) {
    if (top.has("probe_every")) top.at("probe_every").fail("\"probes\" with it");
    return nullptr;
  }
  const Reader field = top.at("probes");
  if (scene.solver.enabled) field.fail("none with \"solver\": {\"type\": \"static\"}: there are no steps");
  SceneProbes probes;
  for (const Reader& entry : field.items("a list of objects")) {
    probes.list.push_back(read_probe(entry, scene));
    check_last_name(entry, probes.list, "probe");
  }
  if (top.has("probe_every")) read_every(top.at("probe_every"), probes);
  return std::make_shared<const SceneProbes>(std::move(probes));
}

}  // namespace pliant
