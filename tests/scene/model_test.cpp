// The key "model": what arrives, what comes back, what is refused and with which words.
#include <map>

#include "scene/patched_scene.h"

namespace pliant::model_test {
namespace {

DeformationModel model_of(const std::string& model) { return parse_scene(with_model(model), "dir/s.json").bodies[0].model; }

const char* const moving_focus = R"({"focus": {"path": [[0, 0, 0.1, 0], [2, 0.5, 0.1, -1]]}})";

/// Every key of the type hybrid but region and stiffness, none at its default.
const char* const full = R"({"type": "hybrid", "ratio": 0.25, "seed": [0.1, -0.2, 0.3], "beta": 12.5, "width": 3, "alpha": 0.75,
  "damping": 0.125, "substeps": 4, "goals": "extrapolated", "coupling": "one-sided", "follow": "focus"})";

TEST(Model, EveryKeyArrives) {
  const DeformationModel m = parse_scene(with_model(full, moving_focus), "dir/s.json").bodies[0].model;
  EXPECT_EQ(m.type, ModelType::hybrid);
  EXPECT_EQ(m.ratio, 0.25);
  ASSERT_TRUE(m.seed);
  EXPECT_EQ(*m.seed, (Vec3d{0.1, -0.2, 0.3}));
  EXPECT_FALSE(m.region);
  EXPECT_EQ(m.beta, 12.5);
  EXPECT_EQ(m.width, 3);
  EXPECT_EQ(m.alpha, 0.75);
  EXPECT_EQ(m.young, 0);
  EXPECT_EQ(m.damping, 0.125);
  EXPECT_EQ(m.substeps, 4);
  EXPECT_TRUE(m.extrapolate);
  EXPECT_FALSE(m.conservative);
  EXPECT_EQ(m.follow, "focus");
  EXPECT_EQ(m.pointer, "/bodies/0/model");
}

TEST(Model, RegionAndStiffnessArrive) {
  const DeformationModel box =
      model_of(R"({"type": "hybrid", "region": {"box": [[0, 1, 2], [3, 4, 5]]}, "stiffness": {"young": 4000}})");
  ASSERT_TRUE(box.region);
  EXPECT_EQ(box.region->kind, Selection::Kind::box);
  EXPECT_EQ(box.region->a, (Vec3d{0, 1, 2}));
  EXPECT_EQ(box.region->b, (Vec3d{3, 4, 5}));
  EXPECT_EQ(box.region->pointer, "/bodies/0/model/region");
  EXPECT_EQ(box.young, 4000);
  const DeformationModel sphere = model_of(R"({"type": "hybrid", "region": {"sphere": [[1, 2, 3], 0.5]}})");
  ASSERT_TRUE(sphere.region);
  EXPECT_EQ(sphere.region->kind, Selection::Kind::sphere);
  EXPECT_EQ(sphere.region->a, (Vec3d{1, 2, 3}));
  EXPECT_EQ(sphere.region->radius, 0.5);
}

TEST(Model, WordsForTheDefaultsArrive) {
  const DeformationModel m =
      model_of(R"({"type": "hybrid", "beta": "auto", "goals": "held", "coupling": "conservative", "substeps": 1})");
  EXPECT_EQ(m.beta, 0);
  EXPECT_FALSE(m.extrapolate);
  EXPECT_TRUE(m.conservative);
}

TEST(Model, Defaults) {
  for (const char* text : {"hybrid", "flsm", "tled"}) {
    const DeformationModel m = model_of(std::string(R"({"type": ")") + text + "\"}");
    EXPECT_STREQ(to_string(m.type), text);
    EXPECT_EQ(m.ratio, 0.5);
    EXPECT_FALSE(m.seed);
    EXPECT_FALSE(m.region);
    EXPECT_EQ(m.beta, 0);
    EXPECT_EQ(m.width, 2);
    EXPECT_EQ(m.alpha, 0.5);
    EXPECT_EQ(m.matched, m.type == ModelType::hybrid);
    EXPECT_EQ(m.young > 0, m.matched) << "that of the material";
    EXPECT_EQ(m.damping, 0);
    EXPECT_EQ(m.substeps, 1);
    EXPECT_FALSE(m.extrapolate);
    EXPECT_TRUE(m.conservative);
    EXPECT_EQ(m.follow, "");
  }
  const Scene none = parse_scene(patched("{}", R"({"model": null})"), "dir/s.json");
  EXPECT_EQ(none.bodies[0].model.type, ModelType::tled);
  EXPECT_TRUE(none.focus.path.empty());
}

TEST(Model, EndsOfTheRangesAreAllowed) {
  for (const char* text : {R"({"type": "hybrid", "ratio": 0, "damping": 0, "alpha": 1, "width": 1, "substeps": 1})",
                           R"({"type": "hybrid", "ratio": 1, "damping": 1, "alpha": 1e-30, "width": 5, "substeps": 64})"}) {
    EXPECT_EQ(message(with_model(text)), "") << text;
  }
}

TEST(Model, AutomaticSubstepsChooseTheirGoals) {
  EXPECT_EQ(model_of(R"({"type": "hybrid", "substeps": "auto"})").substeps, 0);
  EXPECT_EQ(message(with_model(R"({"type": "hybrid", "substeps": "auto", "goals": "extrapolated", "damping": 0})")), "");
  const std::map<std::string, Json> refused{{"goals", "held"}, {"alpha", 0.5}, {"damping", 0.1}};
  for (const auto& [key, value] : refused) {
    Json model{{"type", "hybrid"}, {"substeps", "auto"}};
    model[key] = value;
    const std::string got = message(with_model(model.dump()));
    EXPECT_EQ(got.find("dir/s.json: /bodies/0/model/" + key + ": got "), 0U) << got;
    EXPECT_NE(got.find(R"("substeps": "auto")"), std::string::npos) << got;
  }
  EXPECT_NE(message(with_model(R"({"type": "hybrid", "substeps": 0})")).find("/bodies/0/model/substeps: got 0"),
            std::string::npos);
}

TEST(Model, EveryElementMayBeOperational) {
  for (const char* element : {"hex8", "hex8full", "tet4", "tet4anp"}) {
    EXPECT_EQ(message(patched("{}", std::string(R"({"element": ")") + element + "\"}")), "") << element;
  }
}

TEST(Model, RoundTripKeepsEverything) {
  const std::vector<std::string> models{
      full,
      R"({"type": "hybrid", "ratio": 0.1, "alpha": 0.3})",
      R"({"type": "hybrid", "region": {"sphere": [[1, 2, 3], 0.7]}, "stiffness": {"young": 1234.5}, "beta": 3})",
      R"({"type": "hybrid", "region": {"box": [[0, 1, 2], [3, 4, 5]]}, "goals": "extrapolated"})",
      R"({"type": "hybrid"})",
      R"({"type": "hybrid", "substeps": "auto", "stiffness": {"young": 900}})",
      R"({"type": "flsm", "width": 4, "alpha": 0.9, "damping": 0.2})",
      R"({"type": "flsm", "width": 5, "stiffness": {"young": 800}})"};
  for (const std::string& text : models) {
    const Scene a = parse_scene(with_model(text, moving_focus), "dir/s.json");
    const std::string written = scene_to_json(a);
    const Scene b = parse_scene(written, "dir/s.json");
    EXPECT_EQ(scene_to_json(b), written);
    const DeformationModel& m = a.bodies[0].model;
    const DeformationModel& n = b.bodies[0].model;
    EXPECT_EQ(n.type, m.type);
    EXPECT_EQ(n.ratio, m.ratio);
    EXPECT_EQ(n.seed, m.seed);
    ASSERT_EQ(n.region.has_value(), m.region.has_value());
    if (m.region) {
      EXPECT_EQ(n.region->kind, m.region->kind);
      EXPECT_EQ(n.region->a, m.region->a);
      EXPECT_EQ(n.region->b, m.region->b);
      EXPECT_EQ(n.region->radius, m.region->radius);
    }
    EXPECT_EQ(n.beta, m.beta);
    EXPECT_EQ(n.width, m.width);
    EXPECT_EQ(n.alpha, m.alpha);
    EXPECT_EQ(n.young, m.young);
    EXPECT_EQ(n.matched, m.matched);
    EXPECT_EQ(n.damping, m.damping);
    EXPECT_EQ(n.substeps, m.substeps);
    EXPECT_EQ(n.extrapolate, m.extrapolate);
    EXPECT_EQ(n.conservative, m.conservative);
    EXPECT_EQ(n.follow, m.follow);
    EXPECT_EQ(n.pointer, m.pointer);
    EXPECT_EQ(b.focus.path, a.focus.path);
    EXPECT_EQ(schema().findings(Json::parse(written)), std::vector<std::string>()) << written;
  }
}

TEST(Model, TledIsNotWritten) {
  const Json written = Json::parse(scene_to_json(parse_scene(with_model(R"({"type": "tled"})"), "dir/s.json")));
  EXPECT_FALSE(written["bodies"][0].contains("model"));
  EXPECT_FALSE(written.contains("focus"));
}

struct Case {
  const char* model;
  const char* expected;  ///< the message after "dir/s.json: ", or its beginning
};

TEST(Model, ValuesOutOfRangeAreNamed) {
  const std::vector<Case> cases{
      {R"("hybrid")",
       R"(/bodies/0/model: got "hybrid", expected an object with the keys type, ratio, seed, follow, region, beta)"},
      {R"({})", R"(/bodies/0/model: got no "type", expected one of tled, hybrid, flsm, mass-spring)"},
      {R"({"type": "hybird"})",
       R"(/bodies/0/model/type: got "hybird", expected one of tled, hybrid, flsm, mass-spring (did you mean "hybrid"?))"},
      {R"({"type": "hybrid", "ratio": 1.01})", "/bodies/0/model/ratio: got 1.01, expected a number with 0 <= ratio <= 1"},
      {R"({"type": "hybrid", "ratio": -0.5})", "/bodies/0/model/ratio: got -0.5, expected a number with 0 <= ratio <= 1"},
      {R"({"type": "hybrid", "ratio": "0.4"})", R"(/bodies/0/model/ratio: got "0.4", expected a number with 0 <= ratio)"},
      {R"({"type": "hybrid", "seed": [1, 2]})", "/bodies/0/model/seed: got [1,2], expected three numbers [x, y, z]"},
      {R"({"type": "hybrid", "seed": [1, 2, null]})", "/bodies/0/model/seed/2: got null, expected a number"},
      {R"({"type": "hybrid", "region": {}})",
       R"(/bodies/0/model/region: got neither "box" nor "sphere", expected exactly one of them)"},
      {R"({"type": "hybrid", "region": {"box": [[0, 0, 0], [1, 1, 1]], "sphere": [[0, 0, 0], 1]}})",
       R"(/bodies/0/model/region: got both "box" and "sphere", expected exactly one of them)"},
      {R"({"type": "hybrid", "region": {"sphere": [[0, 0, 0], -1]}})",
       "/bodies/0/model/region/sphere/1: got -1, expected a number > 0"},
      {R"({"type": "hybrid", "region": {"all": true}})",
       R"(/bodies/0/model/region: got the unknown key "all", expected one of box, sphere)"},
      {R"({"type": "hybrid", "beta": 0})", R"(/bodies/0/model/beta: got 0, expected "auto" or a number > 0 [N/m])"},
      {R"({"type": "hybrid", "beta": -3})", R"(/bodies/0/model/beta: got -3, expected "auto" or a number > 0 [N/m])"},
      {R"({"type": "hybrid", "beta": "stiff"})", R"(/bodies/0/model/beta: got "stiff", expected "auto" or a number > 0 [N/m])"},
      {R"({"type": "flsm", "width": 0})", "/bodies/0/model/width: got 0, expected a whole number from 1 to 5"},
      {R"({"type": "flsm", "width": 6})", "/bodies/0/model/width: got 6, expected a whole number from 1 to 5"},
      {R"({"type": "flsm", "width": 1.5})", "/bodies/0/model/width: got 1.5, expected a whole number from 1 to 5"},
      {R"({"type": "flsm", "alpha": 0})", "/bodies/0/model/alpha: got 0, expected a number with 0 < alpha <= 1"},
      {R"({"type": "flsm", "alpha": 1.5})", "/bodies/0/model/alpha: got 1.5, expected a number with 0 < alpha <= 1"},
      {R"({"type": "flsm", "stiffness": 3000})", "/bodies/0/model/stiffness: got 3000, expected an object with the keys young"},
      {R"({"type": "flsm", "stiffness": {}})",
       R"(/bodies/0/model/stiffness: got no "young", expected effective Young's modulus of shape matching [Pa])"},
      {R"({"type": "flsm", "stiffness": {"young": 0}})", "/bodies/0/model/stiffness/young: got 0, expected a number > 0"},
      {R"({"type": "flsm", "damping": -0.1})", "/bodies/0/model/damping: got -0.1, expected a number with 0 <= damping <= 1"},
      {R"({"type": "flsm", "damping": 2})", "/bodies/0/model/damping: got 2, expected a number with 0 <= damping <= 1"},
      {R"({"type": "hybrid", "substeps": 0})", "/bodies/0/model/substeps: got 0, expected \"auto\" or a whole"},
      {R"({"type": "hybrid", "substeps": 65})", "/bodies/0/model/substeps: got 65, expected \"auto\" or a whole"},
      {R"({"type": "hybrid", "goals": "hold"})",
       R"(/bodies/0/model/goals: got "hold", expected one of held, extrapolated (did you mean "held"?))"},
      {R"({"type": "hybrid", "coupling": "onesided"})",
       R"(/bodies/0/model/coupling: got "onesided", expected one of conservative, one-sided (did you mean "one-sided"?))"},
  };
  for (const Case& c : cases) expect_refused(with_model(c.model), c.expected);
  expect_refused(with_model(R"({"type": "hybrid", "follow": ""})"), R"(/bodies/0/model/follow: got "", expected a name)");
  // Which names there are is more than a JSON schema can say.
  const std::string tools = R"({"tools": [{"name": "rod", "shape": {"sphere": 0.01}}, {"name": "table",
    "shape": {"half_space": [[0, 0, 0], [0, 1, 0]]}}]})";
  const auto follow = [&](const std::string& name) {
    return message(with_model(R"({"type": "hybrid", "follow": ")" + name + "\"}", tools));
  };
  EXPECT_EQ(follow("rod"), "");
  EXPECT_EQ(follow("host/knife"), "");
  EXPECT_EQ(follow("path"),
            "dir/s.json: /bodies/0/model/follow: got \"path\", expected the name of a target of the region, one of "
            "focus, rod, table, or host/NAME for a blade that a program moves");
  EXPECT_EQ(follow("table"),
            "dir/s.json: /bodies/0/model/follow: got \"table\", expected something that is in one place, which a "
            "half space is not");
  EXPECT_EQ(message(patched(R"({"tool": {"path": [[0, 0, 0, 0]]}})")),
            "dir/s.json: top level: got the key \"tool\", expected \"focus\", which is its name since 0.2.0");
}

TEST(Model, UnknownKeysSuggestTheNearest) {
  expect_refused(
      with_model(R"({"type": "hybrid", "ration": 0.4})"),
      R"(/bodies/0/model: got the unknown key "ration", expected one of type, ratio, seed, follow, region, )"
      R"(beta, substeps, goals, coupling, width, damping, cut, alpha, stiffness, spring, edge_springs (did you mean "ratio"?))");
  expect_refused(with_model(R"({"type": "flsm", "stiffness": {"yuong": 1}})"),
                 R"(/bodies/0/model/stiffness: got the unknown key "yuong", expected one of young (did you mean "young"?))");
  expect_refused(patched(R"({"focus": {"paths": []}})"),
                 R"(/focus: got the unknown key "paths", expected one of path (did you mean "path"?))");
  expect_refused(patched(R"({"tol": 1})"), R"(top level: got the unknown key "tol")");
}

TEST(Model, KeysThatMakeNoSenseForTheTypeAreRefused) {
  const Json values = Json::parse(R"({"ratio": 0.5, "seed": [0, 0, 0], "region": {"sphere": [[0, 0, 0], 1]}, "beta": "auto",
    "substeps": 2, "goals": "held", "coupling": "one-sided", "follow": "focus", "width": 2, "alpha": 0.5,
    "stiffness": {"young": 1}, "damping": 0})");
  const std::set<std::string> of_regions{"width", "alpha", "stiffness", "damping"};
  for (const auto& [key, value] : values.items()) {
    for (const std::string type : {"tled", "flsm", "hybrid"}) {
      Json scene = Json::parse(patched(moving_focus));
      scene["bodies"][0]["model"] = {{"type", type}, {key, value}};
      if (type == "hybrid" || (type == "flsm" && of_regions.count(key) > 0)) {
        EXPECT_EQ(message(scene.dump()), "") << key;
        EXPECT_TRUE(schema().findings(scene).empty()) << key;
        continue;
      }
      const std::string needed = of_regions.count(key) > 0 ? "hybrid or flsm" : "hybrid";
      const std::string got = message(scene.dump());
      EXPECT_EQ(got.find("dir/s.json: /bodies/0/model/" + key + ": got "), 0U) << got;
      const std::string expected = "expected no \"" + key + "\" with the type " + type + " (it needs the type " + needed + ")";
      EXPECT_NE(got.find(expected), std::string::npos) << got;
      EXPECT_FALSE(schema().findings(scene).empty()) << key << " " << type;
    }
  }
}

TEST(Model, KeysThatExcludeEachOther) {
  for (const std::string key : {R"("ratio": 0.5)", R"("seed": [0, 0, 0])", R"("follow": "focus")"}) {
    const std::string name = key.substr(0, key.find(':'));
    expect_refused(
        with_model(R"({"type": "hybrid", "region": {"sphere": [[0, 0, 0], 1]}, )" + key + "}", moving_focus),
        R"(/bodies/0/model: got both "region" and )" + name + ", expected either a region, or ratio, seed and follow");
  }
  for (const std::string type : {"hybrid", "flsm"}) {
    expect_refused(with_model(R"({"type": ")" + type + R"(", "alpha": 0.5, "stiffness": {"young": 1}})"),
                   R"(/bodies/0/model: got both "alpha" and "stiffness", expected at most one: a stiffness chooses alpha)");
  }
}

TEST(Model, ShapeMatchingNeedsALattice) {
  for (const std::string type : {"hybrid", "flsm"}) {
    const std::string body = R"({"surface": null, "lattice": null, "mesh": "a.msh", "model": {"type": ")" + type + "\"}}";
    expect_refused(patched("{}", body), R"(/bodies/0/model/type: got ")" + type +
                                            R"(", expected tled or mass-spring with a volume mesh or a sheet )" +
                                            R"((shape matching needs a lattice: give a "surface" with a "lattice"))");
  }
  const std::string tled = R"({"surface": null, "lattice": null, "mesh": "a.msh", "model": {"type": "tled"}})";
  EXPECT_EQ(message(patched("{}", tled)), "");
  EXPECT_TRUE(schema().findings(Json::parse(patched("{}", tled))).empty());
}

TEST(Model, ShapeMatchingHasOneIntegrator) {
  for (const std::string type : {"hybrid", "flsm"}) {
    const std::string model = R"({"type": ")" + type + "\"}";
    const std::string because = ", because /bodies/0/model has the type " + type;
    expect_refused(with_model(model, R"({"integrator": "textbook"})"),
                   R"(/integrator: got "textbook", expected increment)" + because);
    expect_refused(with_model(model, R"({"integrator": "forward-euler"})"),
                   R"(/integrator: got "forward-euler", expected increment)" + because);
    EXPECT_EQ(message(with_model(model, R"({"integrator": "increment", "relaxation": true})")), "");
  }
  const std::string tled = with_model(R"({"type": "tled"})", R"({"integrator": "textbook", "relaxation": true})");
  EXPECT_EQ(message(tled), "");
  EXPECT_TRUE(schema().findings(Json::parse(tled)).empty());
}

TEST(Model, AnIntegratorIsRefusedWithThoseThatAreAllowed) {
  const std::string tled = R"({"type": "tled"})";
  EXPECT_EQ(message(with_model(tled, R"({"integrator": "forward-euler"})")), "");
  expect_refused(with_model(tled, R"({"integrator": "forward-euler", "relaxation": true})"),
                 R"(/integrator: got "forward-euler", expected increment or textbook, because the scene has relaxation)");
  const std::string contact = message(with_model(tled, R"({"integrator": "forward-euler", "contact": true})"));
  EXPECT_NE(contact.find(R"(got "forward-euler", expected increment, because the scene has contact)"), std::string::npos)
      << contact;
}

TEST(Model, ViscosityIsOfElementsAndOfIncrements) {
  const auto viscous = [](const std::string& type, const std::string& top) {
    Json scene = Json::parse(with_model("{\"type\": \"" + type + "\"}", top));
    scene["bodies"][0]["material"]["viscosity"] = 5;
    scene["bodies"][0]["material"]["bulk_viscosity"] = 7;
    return scene.dump();
  };
  for (const std::string integrator : {"increment", "forward-euler"})
    EXPECT_EQ(message(viscous("tled", R"({"integrator": ")" + integrator + "\"}")), "");
  const std::string textbook = message(viscous("tled", R"({"integrator": "textbook"})")),
                    hybrid = message(viscous("hybrid", "{}"));
  EXPECT_NE(textbook.find(R"(got "textbook", expected increment or forward-euler, because /bodies/0 has a viscosity)"),
            std::string::npos)
      << textbook;
  EXPECT_NE(hybrid.find(R"(/bodies/0/model/type: got "hybrid", expected tled, because /bodies/0 has a viscosity)"),
            std::string::npos)
      << hybrid;
  const Material m = parse_scene(scene_to_json(parse_scene(viscous("tled", "{}"), "s")), "s").bodies[0].material;
  EXPECT_EQ(m.viscosity + 10 * m.bulk_viscosity, 75);
}

TEST(Model, ARegionThatMovesIsNotRelaxed) {
  const std::string model = R"({"type": "hybrid", "follow": "focus"})", focus = R"("focus": {"path": [[0, 0, 0.1, 0]]})";
  expect_refused(with_model(model, "{" + focus + R"(, "relaxation": true})"),
                 "/relaxation: got true, expected false, because /bodies/0/model/follow moves the region as time goes on");
  EXPECT_EQ(message(with_model(model, "{" + focus + R"(, "relaxation": false})")), "");
}

TEST(Model, TheSecondBodyIsCheckedToo) {
  Json scene = Json::parse(with_model(R"({"type": "tled"})", R"({"integrator": "textbook"})"));
  scene["bodies"].push_back(Json::parse(good)["bodies"][0]);
  scene["bodies"][1]["name"] = "b";
  expect_refused(scene.dump(),
                 R"(/integrator: got "textbook", expected increment, because /bodies/1/model has the type hybrid)");
  scene.erase("integrator");
  scene["bodies"][1]["model"]["follow"] = "focus";
  expect_refused(scene.dump(), R"(/bodies/1/model/follow: got "focus", expected the scene's key "focus" to follow)");
}

}  // namespace
}  // namespace pliant::model_test
