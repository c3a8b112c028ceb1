// What tools and bodies have in common, in C++ and in C, against closed forms: of bodies that are held, so that nothing gives
// way.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pliant/c/pliant.h"
#include "scenes.h"

namespace pliant::interpenetration_test {

using test::code_of;
using test::on;

/// A body of 10 x 8 x 6 cm, or of another height, from `low` on that is held as a whole.
BodySpec held(const std::string& name, const Vec3d& low = {0, 0, 0}, double height = 0.08) {
  BodySpec body;
  body.name = name;
  body.surface = box_surface(low, {low[0] + 0.1, low[1] + height, low[2] + 0.06});
  body.lattice_spacing = 0.02;
  body.material.young = 3000;
  body.fixed.push_back({RegionSpec{}});
  return body;
}

/// A tool that comes down from above to a place, where it is after 0.1 s.
ToolSpec coming(const std::string& name, const std::string& shape, const Vec3d& to, double radius = 0.02) {
  ToolSpec tool;
  tool.name = name;
  tool.shape = shape;
  tool.radius = radius;
  tool.path = {{0, to[0], to[1] + 0.3, to[2], 0, 0, 0, 1}, {0.1, to[0], to[1], to[2], 0, 0, 0, 1}};
  return tool;
}

const Interpenetration& between(const std::vector<Interpenetration>& all, const std::string& first, const std::string& second) {
  static const Interpenetration none;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& i) { return i.first == first && i.second == second; });
  if (found == all.end()) ADD_FAILURE() << first << " and " << second << " have nothing in common";
  return found == all.end() ? none : *found;
}

void expect_near(const Vec3d& a, const Vec3d& b, double within) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], within) << c;
}

/// A ball, a rod, a box and a table, all in one block.
SceneSpec four_tools() {
  SceneSpec scene;
  scene.dt = 0.001;
  scene.bodies.push_back(held("block"));
  scene.tools.push_back(coming("ball", "sphere", {0.05, 0.09, 0.03}));
  ToolSpec rod = coming("rod", "capsule", {0.05, 0.04, 0.03}, 0.004);
  rod.first = {-0.2, 0, 0}, rod.second = {0.2, 0, 0};
  scene.tools.push_back(rod);
  ToolSpec box = coming("box", "box", {0.02, 0.02, 0.06});
  box.size = {0.01, 0.02, 0.03};
  scene.tools.push_back(box);
  ToolSpec table = coming("table", "half_space", {0, 0.01, 0});
  table.second = {0, -1, 0};
  for (auto& row : table.path) row[1] = 0;
  table.path[0][2] = 0.2, table.path[1][2] = 0.055;  // its inside is above
  scene.tools.push_back(table);
  return scene;
}

TEST(Interpenetration, ToolsInClosedForm) {
  World world(four_tools(), on("cpu:double"));
  EXPECT_TRUE(world.interpenetrations().empty());
  world.advance(0.12);
  const std::vector<Interpenetration> all = world.interpenetrations();
  ASSERT_EQ(all.size(), 4U);
  const double pi = std::numbers::pi, h = 0.01, r = 0.02;
  const Interpenetration& ball = between(all, "ball", "block");
  const double cap = pi * h * h * (3 * r - h) / 3, below = 3 * (2 * r - h) * (2 * r - h) / (4 * (3 * r - h));
  EXPECT_TRUE(ball.tool);
  EXPECT_NEAR(ball.volume / cap, 1, 1e-3);
  expect_near(ball.centroid, {0.05, 0.09 - below, 0.03}, 1e-6);
  EXPECT_NEAR(ball.area[0] / (2 * pi * r * h), 1, 1e-3);
  EXPECT_NEAR(ball.area[1] / (pi * h * (2 * r - h)), 1, 1e-3);
  EXPECT_NEAR(ball.depth, h, 1e-5);
  expect_near(ball.deepest, {0.05, 0.07, 0.03}, 1e-3);

  const Interpenetration& rod = between(all, "rod", "block");
  EXPECT_NEAR(rod.volume / (pi * 0.004 * 0.004 * 0.1), 1, 1e-3);
  EXPECT_NEAR(rod.area[0] / (2 * pi * 0.004 * 0.1), 1, 1e-3);
  expect_near(rod.centroid, {0.05, 0.04, 0.03}, 1e-9);

  const Interpenetration& box = between(all, "box", "block");
  EXPECT_NEAR(box.volume, 0.01 * 0.02 * 0.015, 1e-15);
  EXPECT_NEAR(box.area[0], 0.01 * 0.02 + 2 * 0.015 * 0.03, 1e-12);
  EXPECT_NEAR(box.area[1], 0.01 * 0.02, 1e-12);
  EXPECT_NEAR(box.depth, 0.015, 1e-12) << "its upper inner corners";
  expect_near(box.centroid, {0.02, 0.02, 0.0525}, 1e-12);

  const Interpenetration& table = between(all, "table", "block");
  EXPECT_NEAR(table.volume, 0.1 * 0.06 * 0.025, 1e-14);
  EXPECT_NEAR(table.area[0], 0.1 * 0.06, 1e-12);
  EXPECT_NEAR(table.area[1], 0.1 * 0.06 + 2 * (0.1 + 0.06) * 0.025, 1e-12);
  EXPECT_NEAR(table.depth, 0.025, 1e-12);

  world.park_tool("rod");
  EXPECT_EQ(world.interpenetrations().size(), 3U);
}

SceneSpec two_blocks() {
  SceneSpec scene;
  scene.dt = 0.001;
  scene.bodies = {held("left"), held("right", {0.09, 0.03, 0.05}, 0.04), held("far", {0.5, 0, 0})};
  scene.tools.push_back(coming("ball", "sphere", {0.095, 0.07, 0.055}, 0.05));
  return scene;
}

TEST(Interpenetration, PairsOfBodies) {
  for (const char* const backend : {"cpu", "cpu:double"}) {
    World world(two_blocks(), on(backend));
    const std::vector<Interpenetration> all = world.interpenetrations();
    ASSERT_EQ(all.size(), 1U);
    const Interpenetration& pair = between(all, "left", "right");
    EXPECT_FALSE(pair.tool);
    EXPECT_NEAR(pair.volume / 4e-6, 1, 1e-5);
    expect_near(pair.centroid, {0.095, 0.05, 0.055}, 1e-7);
    EXPECT_NEAR(pair.area[0] / 8e-4, 1, 1e-5);
    EXPECT_NEAR(pair.area[1] / 1e-3, 1, 1e-5);
    EXPECT_NEAR(pair.depth, 0.01, 1e-6);
    const std::uint64_t hash = world.hash();
    world.advance(0.12);
    EXPECT_EQ(world.interpenetrations().size(), 3U);
    EXPECT_EQ(world.hash(), hash) << "these bodies do not move";
  }
}

/// The surface along a cut closes both sides, so that what is in them stays the same in sum.
TEST(Interpenetration, OfACutBody) {
  SceneSpec scene = four_tools();
  World world(scene, on("cpu:double"));
  world.advance(0.12);
  const std::vector<Interpenetration> before = world.interpenetrations();
  ASSERT_TRUE(world.cut({{Vec3d{0.047, -1, -1}, {0.047, 3, -1}, {0.051, -1, 3}}}).changed);
  const std::vector<Interpenetration> after = world.interpenetrations();
  ASSERT_EQ(after.size(), before.size());
  for (const Interpenetration& now : after) {
    const Interpenetration& was = between(before, now.first, now.second);
    EXPECT_NEAR(now.volume / was.volume, 1, 1e-6) << now.first;
    EXPECT_NEAR(now.area[0] / was.area[0], 1, 1e-6) << now.first;
  }
}

TEST(Interpenetration, OpenSurfacesAreLeftOut) {
  SceneSpec scene = two_blocks();
  scene.bodies[1].surface.triangles.pop_back();
  World world(scene, on("cpu"));
  EXPECT_TRUE(world.interpenetrations().empty());
}

/// A probe between two gives what World::interpenetrations() gives; alone, a name is for the sum of all.
TEST(Interpenetration, ProbesAndC) {
  SceneSpec scene = two_blocks();
  const auto probe = [&](const std::string& name, const std::vector<std::string>& between) {
    ProbeSpec& p = scene.probes.emplace_back();
    p.name = name;
    p.between = between;
  };
  probe("pair", {"right", "left"});
  probe("ball", {"ball", "left"});
  probe("all", {"ball"});
  probe("none", {"ball", "far"});
  World world(scene, on("cpu"));
  world.advance(0.12);
  const std::vector<Interpenetration> all = world.interpenetrations();
  const std::vector<ProbeValue> values = world.probes();
  ASSERT_EQ(values.size(), 4U);
  for (const ProbeValue& v : values) {
    EXPECT_EQ(v.quantity, "interpenetration");
    ASSERT_EQ(v.numbers.size(), 10U);
  }
  const Interpenetration &pair = between(all, "left", "right"), &left = between(all, "ball", "left");
  const Interpenetration& right = between(all, "ball", "right");
  EXPECT_EQ(values[0].numbers[0], pair.volume);
  EXPECT_EQ(values[0].numbers[4], pair.area[1]) << "the first of the probe is the second of the scene";
  EXPECT_EQ(values[0].numbers[5], pair.area[0]);
  EXPECT_EQ(values[1].numbers[0], left.volume);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(values[1].numbers[1 + c], left.centroid[c], 1e-15);
    EXPECT_EQ(values[1].numbers[7 + c], left.deepest[c]);
    const double moment = left.volume * left.centroid[c] + right.volume * right.centroid[c];
    EXPECT_NEAR(values[2].numbers[1 + c], moment / (left.volume + right.volume), 1e-15);
  }
  EXPECT_EQ(values[1].numbers[6], left.depth);
  EXPECT_DOUBLE_EQ(values[2].numbers[0], left.volume + right.volume);
  EXPECT_EQ(values[2].numbers[6], std::max(left.depth, right.depth));
  EXPECT_EQ(values[3].numbers[0], 0);
  EXPECT_TRUE(std::isnan(values[3].numbers[1])) << "no volume has no centroid";
}

TEST(Interpenetration, InC) {
  const BodySpec left = held("left");
  std::vector<double> vertices;
  for (const Vec3d& v : left.surface.vertices) vertices.insert(vertices.end(), v.begin(), v.end());
  pliant_surface surface = PLIANT_SURFACE_INIT;
  surface.vertices = vertices.data(), surface.vertex_count = 8;
  surface.triangles = left.surface.triangles[0].data(), surface.triangle_count = 12;
  const char* const body =
      R"(, "surface": "memory:0", "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45},
    "fixed": [{"all": true}])";
  const std::string text = std::string(R"({"format": "pliant-scene/1", "dt": 0.001, "bodies": [{"name": "a")") + body +
                           R"(}, {"name": "b")" + body + "}]}";
  pliant_options options = PLIANT_OPTIONS_INIT;
  options.backend = "cpu";
  pliant_world world{};
  ASSERT_EQ(pliant_world_parse(text.c_str(), "", &surface, 1, &options, &world), PLIANT_OK) << pliant_last_error();
  std::size_t needed = 0;
  ASSERT_EQ(pliant_world_interpenetrations(world, nullptr, 0, &needed), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(needed, 1U);
  pliant_interpenetration found = PLIANT_INTERPENETRATION_INIT;
  ASSERT_EQ(pliant_world_interpenetrations(world, &found, 1, nullptr), PLIANT_OK);
  EXPECT_STREQ(found.first, "a");
  EXPECT_STREQ(found.second, "b");
  EXPECT_NEAR(found.volume / (0.1 * 0.08 * 0.06), 1, 1e-6) << "two in one place";
  EXPECT_NEAR(found.area[0] / 0.0188, 1, 1e-6) << "surface in surface counts half";
  EXPECT_NEAR(found.centroid[1], 0.04, 1e-8);
  EXPECT_EQ(found.tool, 0);
  found.size = 8;
  EXPECT_EQ(pliant_world_interpenetrations(world, &found, 1, nullptr), PLIANT_USAGE);
  pliant_world_destroy(world);
}

}  // namespace pliant::interpenetration_test
