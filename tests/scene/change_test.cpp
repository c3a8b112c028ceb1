// Changes of parameters: what they may name, what stays, and what they are refused with.
#include "scene/change.h"

#include <gtest/gtest.h>

#include <string>

#include "pliant/error.h"
#include "scene/scene.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant::testing {
namespace {

std::string text_of(const std::string& more, const std::string& material) {
  return R"({"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [
    {"name": "liver", "surface": "meshes/cube.obj", "lattice": {"spacing": 0.02}, "material": )" +
         material +
         R"(, "inclusions": [{"sphere": [[0, 0, 0], 0.02], "material": {"young": 9000, "poisson": 0.3, "density": 1000}}],
     "fixed": [{"box": [[-1, -1, -1], [1, -0.04, 1]]}]},
    {"name": "rest", "surface": "meshes/cube.obj", "lattice": {"spacing": 0.02}, "translate": [0.2, 0, 0],
     "material": {"young": 3000, "poisson": 0.4, "density": 1000}, "model": {"type": "hybrid", "ratio": 0.3, "alpha": 0.4}}])" +
         more + "}";
}
Scene scene_with(const std::string& changes,
                 const std::string& material = R"({"young": 3000, "poisson": 0.4, "density": 1000})") {
  return parse_scene(text_of(changes.empty() ? "" : ", \"changes\": " + changes, material),
                     test::source_dir() + "/scenes/changes.json");
}
Scene after(const Scene& scene, const std::string& change) {
  return with_parameters(scene, changed_parameters(scene, "", change, "change"));
}
std::string refusal(const Scene& scene, const std::string& change) {
  return test::error_of([&] { static_cast<void>(changed_parameters(scene, "", change, "change")); });
}

TEST(Change, OneElasticConstantKeepsTheOther) {
  const Scene scene = scene_with("");
  const Material young = after(scene, R"({"body": "liver", "material": {"young": 6000}})").bodies[0].material;
  EXPECT_NEAR(young.moduli.young(), 6000, 1e-9);
  EXPECT_NEAR(young.moduli.poisson(), 0.4, 1e-14);
  const Material poisson = after(scene, R"({"body": "liver", "material": {"poisson": 0.2}})").bodies[0].material;
  EXPECT_NEAR(poisson.moduli.young(), 3000, 1e-9);
  EXPECT_NEAR(poisson.moduli.poisson(), 0.2, 1e-14);
  const Material mu = after(scene, R"({"body": "liver", "material": {"mu": 500}})").bodies[0].material;
  EXPECT_EQ(mu.moduli.mu, 500);
  EXPECT_EQ(mu.moduli.lambda, scene.bodies[0].material.moduli.lambda);
  const Material kappa = after(scene, R"({"body": "liver", "material": {"kappa": 20000}})").bodies[0].material;
  EXPECT_EQ(kappa.moduli.kappa, 20000);
  EXPECT_EQ(kappa.moduli.mu, scene.bodies[0].material.moduli.mu);
}

TEST(Change, WhatIsNotNamedStaysToTheLastBit) {
  const Scene scene = scene_with("");
  const Scene now = after(scene, R"({"body": "liver", "material": {"damping": 7}})");
  EXPECT_EQ(now.bodies[0].material.damping, 7);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(now.bodies[b].material.moduli.mu, scene.bodies[b].material.moduli.mu);
    EXPECT_EQ(now.bodies[b].material.moduli.kappa, scene.bodies[b].material.moduli.kappa);
    EXPECT_EQ(now.bodies[b].material.moduli.lambda, scene.bodies[b].material.moduli.lambda);
  }
  EXPECT_EQ(now.bodies[1].model.alpha, 0.4);
  EXPECT_EQ(now.gravity, scene.gravity);
  EXPECT_EQ(now.bodies[0].inclusions[0].material.moduli.mu, scene.bodies[0].inclusions[0].material.moduli.mu);
}

TEST(Change, ChangesAddUp) {
  const Scene scene = scene_with("");
  std::string parameters;
  for (const char* change :
       {R"({"gravity": [1, 2, 3]})", R"({"body": "liver", "material": {"young": 6000}})",
        R"({"body": "liver", "inclusion": 0, "material": {"young": 1000, "damping": 2}})",
        R"({"body": "liver", "material": {"law": "saint-venant-kirchhoff"}})",
        R"({"body": "rest", "model": {"ratio": 0.6, "stiffness": {"young": 2000}}})", R"({"body": "liver", "fixed": []})"}) {
    parameters = changed_parameters(scene, parameters, change, "change");
  }
  const Scene now = with_parameters(scene, parameters);
  EXPECT_EQ(now.gravity, (Vec3d{1, 2, 3}));
  EXPECT_NEAR(now.bodies[0].material.moduli.young(), 6000, 1e-9);
  EXPECT_STREQ(to_string(now.bodies[0].material.law), "saint-venant-kirchhoff");
  EXPECT_NEAR(now.bodies[0].inclusions[0].material.moduli.young(), 1000, 1e-9);
  EXPECT_NEAR(now.bodies[0].inclusions[0].material.moduli.poisson(), 0.3, 1e-14);
  EXPECT_EQ(now.bodies[0].inclusions[0].material.damping, 2);
  EXPECT_EQ(now.bodies[1].model.ratio, 0.6);
  EXPECT_EQ(now.bodies[1].model.young, 2000);
  EXPECT_TRUE(now.bodies[0].fixed.empty());
}

TEST(Change, ALawWithParametersOfItsOwn) {
  const Scene scene = scene_with("");
  const Scene now =
      after(scene, R"({"body": "liver", "material": {"law": "mooney-rivlin", "c10": 200, "c01": 100, "kappa": 9000}})");
  EXPECT_STREQ(to_string(now.bodies[0].material.law), "mooney-rivlin");
  EXPECT_NEAR(now.bodies[0].material.moduli.mu, 600, 1e-9);
  EXPECT_NE(refusal(scene, R"({"body": "liver", "material": {"law": "mooney-rivlin"}})").find("c10"), std::string::npos);
}

TEST(Change, AMatchedModelFollowsItsMaterial) {
  const Scene scene =
      parse_scene(R"({"format": "pliant-scene/1", "bodies": [{"surface": "meshes/cube.obj", "lattice": {"spacing": 0.02},
    "material": {"young": 3000, "poisson": 0.4, "density": 1000}, "model": {"type": "hybrid"}}]})",
                  test::source_dir() + "/scenes/changes.json");
  ASSERT_TRUE(scene.bodies[0].model.matched);
  EXPECT_NEAR(after(scene, R"({"material": {"young": 1500}})").bodies[0].model.young, 1500, 1e-9);
}

TEST(Change, TheFileIsWrittenBack) {
  const Scene scene =
      scene_with(R"([{"time": 0.1, "gravity": [0, 0, 0]}, {"time": 0.1, "body": "liver", "material": {"young": 100}}])");
  ASSERT_EQ(scene.changes.size(), 2u);
  const Scene again = parse_scene(scene_to_json(scene), scene.file);
  ASSERT_EQ(again.changes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.changes[i].time, scene.changes[i].time);
    EXPECT_EQ(again.changes[i].text, scene.changes[i].text);
  }
}

TEST(Change, WhatCannotChangeIsRefusedWithOneMessage) {
  const Scene scene = scene_with("");
  const auto says = [&](const char* change, const char* what) {
    const std::string message = refusal(scene, change);
    EXPECT_NE(message.find(what), std::string::npos) << change << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  says("{", "change");
  says("{}", "at least one of gravity, material, model, fixed");
  says(R"({"material": {"young": 1}})", "one of liver, rest");
  says(R"({"body": "lever", "material": {"young": 1}})", "\"lever\"");
  says(R"({"body": "liver"})", "nothing changes");
  says(R"({"body": "liver", "material": {"yuong": 1}})", "did you mean \"young\"");
  says(R"({"body": "liver", "material": {"young": -5}})", "-5");
  says(R"({"body": "liver", "material": {"young": null}})", "null");
  says(R"({"body": "liver", "material": {"young": 5, "kappa": 5}})", "exactly one of the pairs");
  says(R"({"body": "liver", "material": {"toughness": 5}})", "did not tear");
  says(R"({"body": "liver", "inclusion": 1, "material": {"young": 5}})", "from 0 to 0");
  says(R"({"body": "rest", "inclusion": 0, "material": {"young": 5}})", "the body has none");
  says(R"({"body": "liver", "inclusion": 0})", "without a \"material\"");
  says(R"({"body": "liver", "model": {"alpha": 0.2}})", "without shape matching");
  says(R"({"body": "rest", "model": {"type": "flsm"}})", "began with");
  says(R"({"body": "rest", "model": {"alpha": 2}})", "alpha");
  says(R"({"body": "liver", "fixed": [{"all": true, "axes": "x"}]})", "in all directions");
  says(R"({"body": "liver", "fixed": [{"all": true, "axis": "x"}]})", "axis");
  says(R"({"time": 3, "gravity": [0, 0, 0]})", "happens now");
  says(R"({"gravity": [0, 0]})", "gravity");
}

/// A network of springs with a law of their own has no use for a modulus, unless it weighs dampers.
TEST(Change, AModulusThatNoSpringFollowsIsRefused) {
  const auto net = [](const std::string& spring, const std::string& more) {
    return parse_scene(R"({"format": "pliant-scene/1", "bodies": [{"name": "net", "mesh": "meshes/cube_tet.vtu",
      "model": {"type": "mass-spring")" +
                           spring + R"(},
      "material": {"young": 3000, "poisson": 0.4, "density": 1000, "stiffness_damping": 0.001})" +
                           more + "}]}",
                       test::source_dir() + "/scenes/changes.json");
  };
  const auto harder = [](const std::string& damping) {
    return R"(, "inclusions": [{"sphere": [[0, 0, 0], 0.02], "material": {"young": 9000, "poisson": 0.3, "density": 1000,
      "stiffness_damping": )" +
           damping + "}}]";
  };
  const std::string stiffer = R"({"material": {"young": 6000}})", own = R"(, "spring": {"stiffness": 20})";
  EXPECT_EQ(refusal(net("", ""), stiffer), "");
  EXPECT_EQ(refusal(net(own, harder("0.002")), stiffer), "");
  EXPECT_EQ(refusal(net(own, ""), R"({"material": {"damping": 3, "stiffness_damping": 0.01}})"), "");
  const auto refused = [&](const Scene& scene) {
    const std::string message = refusal(scene, stiffer);
    EXPECT_NE(message.find("springs of body \"net\" have a law of their own"), std::string::npos) << message;
  };
  refused(net(own, ""));
  refused(net(own, harder("0.001")));
  refused(net(R"(, "spring": {"law": "measured", "a": 0.1, "b": 0.01})", ""));
  refused(net(R"(, "edge_springs": false)", R"(, "springs": [{"nodes": [[0, 1]], "spring": {"stiffness": 3}}])"));
}

TEST(Change, AFileWithABadChangeIsRefusedAtItsPlace) {
  const auto message = [](const char* changes) { return test::error_of([&] { static_cast<void>(scene_with(changes)); }); };
  EXPECT_NE(message(R"([{"time": 0.2, "gravity": [0, 0, 0]}, {"time": 0.1, "gravity": [0, 0, 0]}])").find("/changes/1/time"),
            std::string::npos);
  EXPECT_NE(message(R"([{"time": -1, "gravity": [0, 0, 0]}])").find("/changes/0/time"), std::string::npos);
  EXPECT_NE(message(R"([{"gravity": [0, 0, 0]}])").find("time"), std::string::npos);
  EXPECT_NE(message(R"([{"time": 1, "body": "liver", "material": {"density": 0}}])").find("/changes/0"), std::string::npos);
  EXPECT_NE(message(R"([{"time": 1, "body": "liver", "material": {"densty": 1}}])").find("/changes/0/material"),
            std::string::npos);
  EXPECT_NE(message(R"({"time": 1})").find("a list of changes"), std::string::npos);
}

TEST(Change, ParametersThatDoNotBelongToTheSceneAreRefused) {
  const Scene scene = scene_with("");
  for (const char* parameters :
       {"{", "[]", R"({"bodies": 3})", R"({"bodies": {"lever": {}}})", R"({"gravty": 3})",
        R"({"bodies": {"liver": {"inclusions": {"7": {}}}}})", R"({"bodies": {"liver": {"material": {"young": 1}}}})"}) {
    EXPECT_THROW(static_cast<void>(with_parameters(scene, parameters)), Error) << parameters;
  }
}

}  // namespace
}  // namespace pliant::testing
