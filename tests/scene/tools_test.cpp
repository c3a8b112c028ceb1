// The key "tools": what is read, what is written again, what is refused; poses between the rows of a path.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/vec.h"
#include "scene/scene.h"
#include "support/error_of.h"

namespace pliant {
namespace {

std::string with_tools(const std::string& tools, const std::string& more = "") {
  return R"({"format": "pliant-scene/1", "bodies": [{"surface": "a.obj", "lattice": {"spacing": 0.1}, "material": {"young": 3000,
      "poisson": 0.45}}], "tools": )" +
         tools + more + "}";
}

TEST(Tools, EveryShapeIsReadAndWrittenAgain) {
  const std::string text = with_tools(R"([{"shape": {"sphere": 0.01}},
    {"name": "rod", "shape": {"capsule": [[0, 0, 0], [0, 0.1, 0], 0.008]}, "path": [[0, 1, 2, 3], [1, 1, 2, 4, 0, 0, 1, 0]],
     "friction": 0.3, "contact": {"stiffness": 1e6, "exponent": 1.5, "alpha": 0.5}},
    {"shape": {"box": [0.1, 0.2, 0.3]}, "contact": {"stiffness": "auto"}},
    {"shape": {"half_space": [[0, -0.1, 0], [0, 2, 0]]}},
    {"shape": {"mesh": "hand.obj"}, "scale": 0.001},
    {"shape": {"sequence": "meshes/hand"}, "scale": 0.01, "frames_per_second": 25},
    {"shape": {"sphere": 0.01}, "grip": {}},
    {"shape": {"sphere": 0.01}, "grip": {"strength": 4000, "times": [[0, 0.5], [0.5, 2]]}}])");
  const Scene scene = parse_scene(text, "scenes/x.json");
  ASSERT_EQ(scene.tools.size(), 8u);
  EXPECT_FALSE(scene.tools[0].grip);
  EXPECT_EQ(scene.tools[6].grip, GripSpec{});
  EXPECT_EQ(scene.tools[7].grip, (GripSpec{4000, {{0, 0.5}, {0.5, 2}}}));
  EXPECT_EQ(scene.tools[0].name, "tool0");
  EXPECT_EQ(scene.tools[0].radius, 0.01);
  EXPECT_EQ(scene.tools[1].pointer, "/tools/1");
  EXPECT_EQ(scene.tools[1].second, (Vec3d{0, 0.1, 0}));
  EXPECT_EQ(scene.tools[1].exponent, 1.5);
  EXPECT_EQ(scene.tools[1].path[0], (std::array<double, 8>{0, 1, 2, 3, 0, 0, 0, 1}));
  EXPECT_EQ(scene.tools[2].size, (Vec3d{0.1, 0.2, 0.3}));
  EXPECT_EQ(scene.tools[2].stiffness, 0);
  EXPECT_EQ(scene.tools[3].second, (Vec3d{0, 2, 0}));
  EXPECT_EQ(scene.tools[4].mesh, "scenes/hand.obj");
  EXPECT_EQ(scene.tools[4].scale, 0.001);
  EXPECT_EQ(scene.tools[5].mesh, "scenes/meshes/hand");
  EXPECT_EQ(scene.tools[5].frames_per_second, 25);
  const std::string written = scene_to_json(scene);
  EXPECT_EQ(scene_to_json(parse_scene(written, "scenes/x.json")), written);
}

TEST(Tools, BadOnesAreRefused) {
  const auto error = [](const std::string& tools, const std::string& more = "") {
    return test::error_of([&] { (void)parse_scene(with_tools(tools, more), "x.json"); });
  };
  const std::string ball = R"("shape": {"sphere": 0.01})";
  const std::pair<std::string, std::string> cases[] = {
      {"[{}]",
       "/tools/0: got no \"shape\", expected an object with one of the keys sphere, capsule, box, half_space, mesh or "
       "sequence"},
      {R"([{"shape": {}}])",
       "/tools/0/shape: got {}, expected one of the keys sphere, capsule, box, half_space, mesh or sequence"},
      {R"([{"shape": {"sphere": 0.1, "box": [1, 1, 1]}}])", "expected one of the keys sphere"},
      {R"([{"shape": {"spere": 0.1}}])", "did you mean \"sphere\"?"},
      {"[{" + ball + R"(, "grip": {"strength": 0}}])", "/tools/0/grip/strength: got 0, expected a number > 0"},
      {"[{" + ball + R"(, "grip": {"times": [[0.5, 0.5]]}}])", "/tools/0/grip/times/0: got [0.5,0.5], expected from < to"},
      {"[{" + ball + R"(, "grip": {"times": [[0, 1], [0.5, 2]]}}])",
       "/tools/0/grip/times/1: got [0.5,2], expected from < to, and not before the row above ends"},
      {"[{" + ball + R"(, "grip": {"force": 3}}])",
       "/tools/0/grip: got the unknown key \"force\", expected one of times, strength"},
      {R"([{"shape": {"sphere": 0}}])", "/tools/0/shape/sphere: got 0, expected a number > 0"},
      {R"([{"shape": {"capsule": [[0, 0, 0], [0, 0, 0], 1]}}])", "two different ends"},
      {R"([{"shape": {"box": [1, -1, 1]}}])", "/tools/0/shape/box: got [1,-1,1], expected three edges"},
      {R"([{"shape": {"half_space": [[0, 0, 0], [0, 0, 0]]}}])", "the outward normal, not zero"},
      {"[{" + ball + R"(, "path": []}])", "/tools/0/path: got [], expected a list of at least one row"},
      {"[{" + ball + R"(, "path": [[0, 1, 2]]}])", "/tools/0/path/0: got [0,1,2], expected a row"},
      {"[{" + ball + R"(, "path": [[1, 0, 0, 0], [1, 0, 0, 1]]}])", "/tools/0/path/1/0: got 1, expected a time after"},
      {"[{" + ball + R"(, "path": [[0, 0, 0, 0, 0, 0, 0, 0.9]]}])",
       "got a quaternion of length 0.9, expected a unit quaternion"},
      {"[{" + ball + R"(, "friction": -0.1}])", "/tools/0/friction: got -0.1"},
      {"[{" + ball + R"(, "contact": {"exponent": 1.5}}])", "/tools/0/contact/exponent: got 1.5, expected this key only with"},
      {"[{" + ball + R"(, "contact": {"stiffness": 1e6, "exponent": 2}}])",
       "/tools/0/contact/exponent: got 2, expected 1 or 1.5"},
      {"[{" + ball + R"(, "contact": {"stiffness": 0}}])", "/tools/0/contact/stiffness: got 0, expected \"auto\" or"},
      {"[{" + ball + R"(, "scale": 2}])", "/tools/0/scale: got 2, expected this key only with a shape that is a mesh"},
      {"[{" + ball + R"(, "frames_per_second": 25}])",
       "/tools/0/frames_per_second: got 25, expected this key only with a shape"},
      {R"([{"shape": {"sequence": "hand"}, "frames_per_second": 0}])",
       "/tools/0/frames_per_second: got 0, expected a number > 0"},
      {R"([{"name": "a\nb", )" + ball + "}]",
       "/tools/0/name: got \"a\\nb\", expected a name of 1 to 100 characters without control characters"},
      {R"([{"name": "a", )" + ball + R"(}, {"name": "a", )" + ball + "}]",
       "/tools/1: got the name \"a\", which /tools/0 has already, expected a different name for every tool"},
  };
  for (const auto& [tools, message] : cases) {
    const std::string got = error(tools);
    EXPECT_NE(got.find(message), std::string::npos) << tools << "\n  " << got << "\n  " << message;
  }
  const std::string one = "[{" + ball + "}]";
  EXPECT_NE(error(one, R"(, "integrator": "textbook")").find("/integrator: got \"textbook\", expected increment"),
            std::string::npos);
  EXPECT_NE(error(one, R"(, "solver": {"type": "static"})").find("/solver: "), std::string::npos);
  (void)parse_scene(with_tools(one, R"(, "relaxation": true)"), "x.json");
  std::string many = "[";
  for (int i = 0; i < 31; ++i) many += (i > 0 ? ", {" : "{") + ball + "}";
  EXPECT_NE(error(many + "]").find("/tools: got 31 tools, expected at most 29"), std::string::npos);
}

TEST(TissueContact, IsReadAndWrittenAgain) {
  const auto scene = [](const std::string& contact) {
    return parse_scene(R"({"format": "pliant-scene/1", )" + contact +
                           R"("bodies": [{"surface": "cube.obj", "lattice": {"nodes": 500},
        "material": {"law": "neo-hookean", "young": 1e4, "poisson": 0.3, "density": 1000}}]})",
                       "scene.json");
  };
  EXPECT_FALSE(scene("").contact);
  EXPECT_FALSE(scene(R"("contact": false, )").contact);
  EXPECT_EQ(scene(R"("contact": true, )").contact->friction, 0);
  const Scene read = scene(R"("contact": {"friction": 0.3}, )");
  EXPECT_EQ(read.contact->friction, 0.3);
  EXPECT_EQ(parse_scene(scene_to_json(read), read.file).contact->friction, 0.3);
  EXPECT_TRUE(scene(R"("contact": true, "relaxation": true, )").relaxation.enabled);
  for (const auto& [text, message] :
       {std::pair{R"("contact": {"friction": -1}, )", "/contact/friction: got -1"},
        std::pair{R"("contact": {"fiction": 1}, )", "the unknown key \"fiction\""},
        std::pair{R"("contact": 3, )", "/contact: got 3"},
        std::pair{R"("contact": true, "integrator": "textbook", )", "expected increment, because the scene has contact"}}) {
    EXPECT_NE(test::error_of([&, t = text] { (void)scene(t); }).find(message), std::string::npos)
        << test::error_of([&, t = text] { (void)scene(t); });
  }
}

TEST(Tools, PosesLieBetweenTheRowsOfThePath) {
  ContactTool tool;
  EXPECT_EQ(tool.at(3), Pose{});
  const double half = std::sqrt(0.5);
  tool.path = {{1, 0, 0, 0, 0, 0, 0, 1},
               {3, 2, 0, 4, 0, 0, -half, -half}};  // 90 degrees about z: the same turn as its opposite
  EXPECT_EQ(tool.at(0).position, Vec3d{});
  EXPECT_EQ(tool.at(9).position, (Vec3d{2, 0, 4}));
  for (const double s : {0.25, 0.5, 0.9}) {
    const Pose pose = tool.at(1 + 2 * s);
    EXPECT_NEAR(pose.position[2], 4 * s, 1e-14);
    const double angle = s * std::numbers::pi / 2;
    const Vec3d x = place(pose, {1, 0, 0.5});
    EXPECT_NEAR(x[0], 2 * s + std::cos(angle), 1e-14);
    EXPECT_NEAR(x[1], std::sin(angle), 1e-14);
    EXPECT_NEAR(x[2], 4 * s + 0.5, 1e-14);
  }
}

}  // namespace
}  // namespace pliant
