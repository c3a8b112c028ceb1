// Springs and joins in scene files: each mistake gets one message, from the loader and the schema alike; what is written is
// read again.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/patched_scene.h"

namespace pliant::springs_test {
namespace {

using Json = nlohmann::json;
using model_test::schema;

Json good() {
  return Json::parse(R"({"format": "pliant-scene/1", "bodies": [
    {"name": "a", "mesh": "a.msh", "material": {"young": 3000, "poisson": 0.45},
     "model": {"type": "mass-spring", "spring": {"law": "measured", "a": -0.2, "b": 0.02, "damping": 0.1}}},
    {"name": "b", "mesh": "b.msh", "material": {"young": 3000, "poisson": 0.45}}],
    "joins": [{"bodies": ["a", "b"], "distance": 0.01, "spring": {"stiffness": 4}, "break_stretch": 2}]})");
}

struct Mistake {
  const char* pointer;
  const char* value;
  const char* expected;
  bool schema_sees = true;
};

TEST(SceneSprings, EachMistakeHasOneMessage) {
  const std::vector<Mistake> mistakes{
      {"/joins/0/bodies/1", R"("c")", "/joins/0/bodies/1: got \"c\", expected the name of a body, one of a, b", false},
      {"/joins/0/bodies", R"(["a", "a"])", "/joins/0/bodies: got [\"a\",\"a\"], expected a list of the names of two different",
       false},
      {"/joins/0/distance", "0", "/joins/0/distance: got 0, expected a number > 0"},
      {"/joins/0/spring", "{}", "/joins/0/spring: got {}, expected a number \"stiffness\" > 0", false},
      {"/joins/0/break_stretch", "1", "/joins/0/break_stretch: got 1, expected a number > 1"},
      {"/joins/0/spring", R"({"stiffness": 4, "a": 1})", "/joins/0/spring/a: got 1, expected no \"a\" with the law linear"},
      {"/bodies/0/model/spring", R"({"law": "measured", "a": 1})", "/bodies/0/model/spring: got no \"b\", expected b [m/N]"},
      {"/bodies/0/model/spring", R"({"law": "measured", "a": 1, "b": 0})",
       "/bodies/0/model/spring/b: got 0, expected a number > 0"},
      {"/bodies/0/model/spring", R"({"law": "cubic", "lambda1": 1})", "/bodies/0/model/spring: got no \"lambda2\""},
      {"/bodies/0/model/spring", R"({"law": "table", "table": [[0, 0]]})", "/bodies/0/model/spring/table: got"},
      {"/bodies/0/model/spring", R"({"law": "table", "table": [[0, 0], [0, 1]]})",
       "/bodies/0/model/spring/table/1/0: got 0, expected an elongation above the previous row's 0", false},
      {"/bodies/0/model/spring", R"({"law": "table", "table": [[0, 0], [1, 0]]})",
       "/bodies/0/model/spring/table: got [[0,0],[1,0]], expected a force that is not 0 in at least one row", false},
      {"/bodies/0/model/spring", R"({"law": "table", "table": [[0, 0], [1, -1]]})",
       "/bodies/0/model/spring/table/1/1: got -1, expected a force of at least the previous row's 0", false},
      {"/bodies/0/model/width", "2", "/bodies/0/model/width: got 2, expected no \"width\" with the type mass-spring"},
      {"/bodies/1/model", R"({"type": "tled", "spring": {}})",
       "/bodies/1/model/spring: got {}, expected no \"spring\" with the type tled"},
      {"/bodies/0/element", R"("hex8")", "/bodies/0/element: got \"hex8\", expected tet4", false},
      {"/integrator", R"("textbook")", "/integrator: got \"textbook\"", false},
      {"/solver", R"({"type": "static"})", "/bodies/0/model/type: got \"mass-spring\", expected tled with", false},
  };
  ASSERT_EQ(model_test::message(good().dump()), "");
  EXPECT_TRUE(schema().findings(good()).empty());
  for (const Mistake& m : mistakes) {
    Json scene = good();
    scene[Json::json_pointer(m.pointer)] = Json::parse(m.value);
    const std::string expected = std::string("dir/s.json: ") + m.expected, got = model_test::message(scene.dump());
    EXPECT_EQ(got.substr(0, expected.size()), expected) << m.pointer << " = " << m.value << "\n" << got;
    if (m.schema_sees) {
      EXPECT_FALSE(schema().findings(scene).empty()) << m.pointer << " = " << m.value;
    }
  }
}

TEST(SceneSprings, StaticSolutionsRefuseJoins) {
  Json scene = good();
  scene["bodies"][0].erase("model");
  scene["solver"] = {{"type", "static"}};
  EXPECT_EQ(model_test::message(scene.dump()).substr(0, 26), "dir/s.json: /joins: got [{");
}

TEST(SceneSprings, SurfacesHaveNone) {
  model_test::expect_refused(model_test::with_model(R"({"type": "mass-spring"})"),
                             "/bodies/0/model/type: got \"mass-spring\", expected tled, hybrid or flsm with a lattice");
}

TEST(SceneSprings, WriterAndReaderAgree) {
  for (const char* spring :
       {R"({"law": "cubic", "lambda1": 3, "lambda2": 2, "slack": true})", R"({"stiffness": 7, "damping": 0.5})",
        R"({"law": "table", "table": [[-1, -2], [0, 0], [1, 5]]})", R"({"law": "measured", "a": 0.5, "b": 2})"}) {
    Json document = good();
    document["bodies"][0]["model"]["spring"] = Json::parse(spring);
    const Scene scene = parse_scene(document.dump(), "dir/s.json"), again = parse_scene(scene_to_json(scene), "dir/s.json");
    const Spring &a = scene.bodies[0].model.spring, &b = again.bodies[0].model.spring;
    EXPECT_EQ(again.bodies[0].model.type, ModelType::mass_spring);
    EXPECT_EQ(std::tie(a.law, a.stiffness, a.lambda1, a.lambda2, a.a, a.b, a.curve, a.damping, a.slack),
              std::tie(b.law, b.stiffness, b.lambda1, b.lambda2, b.a, b.b, b.curve, b.damping, b.slack))
        << spring;
    ASSERT_EQ(again.joins.size(), 1U);
    EXPECT_EQ(again.joins[0].bodies, scene.joins[0].bodies);
    EXPECT_EQ(again.joins[0].distance, 0.01);
    EXPECT_EQ(again.joins[0].break_stretch, 2);
    EXPECT_EQ(again.joins[0].break_force, 0);
    EXPECT_EQ(again.joins[0].spring.stiffness, 4);
  }
}

}  // namespace
}  // namespace pliant::springs_test
