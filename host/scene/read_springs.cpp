// The key "spring" of a mass-spring model and of a join, and the key "joins" of a scene.
#include <fmt/format.h>

#include <algorithm>

#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {
namespace {

/// The keys of each law besides those of all.
std::vector<std::string> keys_of(SpringLaw law) {
  switch (law) {
    case SpringLaw::linear:
      return {"stiffness"};
    case SpringLaw::cubic:
      return {"lambda1", "lambda2"};
    case SpringLaw::measured:
      return {"a", "b"};
    case SpringLaw::curve:
      break;
  }
  return {"table"};
}

void refuse_other_laws(const Reader& spring, SpringLaw law) {
  const std::vector<std::string> own = keys_of(law);
  for (const Word<SpringLaw>& w : spring_law_words()) {
    for (const std::string& key : keys_of(w.value)) {
      if (!spring.has(key) || std::find(own.begin(), own.end(), key) != own.end()) continue;
      spring.at(key).fail(
          fmt::format("no \"{}\" with the law {} (it belongs to {})", key, word_of(spring_law_words(), law), w.word));
    }
  }
}

std::vector<std::array<double, 2>> read_spring_table(const Reader& table) {
  const char* const expected = "a list of at least two rows [elongation, force]";
  const char* const row_expected = "a row [elongation, force] in metres and newtons";
  std::vector<std::array<double, 2>> rows;
  for (const Reader& row : table.items(expected, 2)) {
    const std::vector<Reader> parts = row.items(row_expected);
    if (parts.size() != 2) row.fail(row_expected);
    rows.push_back({parts[0].number(), parts[1].number()});
    if (rows.size() < 2) continue;
    const auto &before = rows[rows.size() - 2], &now = rows.back();
    if (!(now[0] > before[0])) parts[0].fail(fmt::format("an elongation above the previous row's {}", before[0]));
    if (now[1] < before[1]) parts[1].fail(fmt::format("a force of at least the previous row's {}", before[1]));
  }
  const auto pulls = [](const std::array<double, 2>& row) { return row[1] != 0; };
  if (std::none_of(rows.begin(), rows.end(), pulls)) table.fail("a force that is not 0 in at least one row");
  return rows;
}

std::string read_joined(const Reader& name, const Scene& scene) {
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) names.push_back(body.name);
  const std::string text = name.text("the name of a body");
  if (std::find(names.begin(), names.end(), text) == names.end())
    name.fail(fmt::format("the name of a body, one of {}", listed(names)));
  return text;
}

Join read_join(const Reader& entry, const Scene& scene) {
  entry.expect_object("join");
  Join join;
  join.pointer = entry.pointer();
  const char* const two = "a list of the names of two different bodies";
  const Reader bodies = entry.at("bodies", two);
  const std::vector<Reader> names = bodies.items(two);
  if (names.size() != 2) bodies.fail(two);
  for (std::size_t i = 0; i < 2; ++i) join.bodies[i] = read_joined(names[i], scene);
  if (join.bodies[0] == join.bodies[1]) bodies.fail(two);
  describe_join(ReadKeys{entry}, join);
  const Reader spring = entry.at("spring", "a spring such as {\"stiffness\": 40}");
  join.spring = read_spring(spring);
  if (join.spring.law == SpringLaw::linear && join.spring.stiffness == 0) {
    spring.fail("a number \"stiffness\" > 0 [N/m]: a join has no material to take it from");
  }
  return join;
}

}  // namespace

Spring read_spring(const Reader& spring) {
  spring.expect_object("spring");
  Spring s;
  describe_spring(ReadKeys{spring}, s);
  refuse_other_laws(spring, s.law);
  if (s.law == SpringLaw::cubic)
    static_cast<void>(spring.at("lambda2", "lambda2 [N], the force at rest per relative elongation"));
  if (s.law == SpringLaw::measured) static_cast<void>(spring.at("b", "b [m/N], one over the stiffness at rest"));
  if (s.law == SpringLaw::curve) s.curve = read_spring_table(spring.at("table", "rows [elongation, force]"));
  return s;
}

std::vector<Join> read_joins(const Reader& joins, const Scene& scene) {
  std::vector<Join> all;
  for (const Reader& entry : joins.items("a list of objects")) all.push_back(read_join(entry, scene));
  return all;
}

void check_springs(const Reader& top, const Scene& scene) {
  for (const Body& body : scene.bodies) {
    const Reader entry = top.at("bodies").items("a list of bodies")[static_cast<std::size_t>(&body - scene.bodies.data())];
    if (body.membrane && scene.solver.enabled)
      entry.at("membrane").fail("none with \"solver\": {\"type\": \"static\"}, which knows no membranes");
    if (!body.springs.empty() && scene.solver.enabled)
      entry.at("springs").fail("none with \"solver\": {\"type\": \"static\"}, which knows no springs");
    for (const SpringList& list : body.springs) {
      if (list.spring.damping > 0)
        require_integrator(top, scene, &IntegratorInfo::keeps_increment, fmt::format("{}/spring has a damping", list.pointer));
    }
    if (!body.vessels.empty() && scene.solver.enabled)
      entry.at("vessels").fail("none with \"solver\": {\"type\": \"static\"}, which knows no vessels");
    const bool joined = std::any_of(scene.joins.begin(), scene.joins.end(), [&](const Join& j) {
      return std::find(j.bodies.begin(), j.bodies.end(), body.name) != j.bodies.end();
    });
    if (body.model.substeps > 1 && (joined || body.membrane || !body.vessels.empty())) {
      entry.at("model")
          .at("substeps")
          .fail(fmt::format("1, because of the {}, which pull on shape matching in every step", joined ? "joins"
                                                                                                : body.membrane
                                                                                                    ? "membrane's triangles"
                                                                                                    : "vessels"));
    }
    if (body.model.type != ModelType::mass_spring) continue;
    if (scene.solver.enabled)
      entry.at("model").at("type").fail("tled with \"solver\": {\"type\": \"static\"}, which knows no springs");
    if (element_info(body.element).corners != 4) {
      entry.at("element").fail(elements_with([](const ElementInfo& e) { return e.corners == 4; }) +
                               ": springs lie along the edges of tetrahedra");
    }
    if (body.model.spring.damping > 0)
      require_integrator(top, scene, &IntegratorInfo::keeps_increment,
                         fmt::format("{}/spring has a damping", body.model.pointer));
  }
  for (const Join& join : scene.joins) {
    if (join.spring.damping > 0)
      require_integrator(top, scene, &IntegratorInfo::keeps_increment, fmt::format("{}/spring has a damping", join.pointer));
    if (scene.solver.enabled) top.at("joins").fail("none with \"solver\": {\"type\": \"static\"}, which knows no springs");
  }
}

}  // namespace pliant
