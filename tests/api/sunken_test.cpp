// Tools that stand below the surface of tissue: what is found, and who is told.
#include <cmath>
#include <map>
#include <random>

#include "api/scenes.h"
#include "api/tool_block.h"
#include "geometry/vec.h"
#include "scene/spec.h"
#include "simulation/contact/sunken_tool.h"
#include "simulation/measure/run_remarks.h"

namespace pliant::sunken_test {
namespace {

using namespace test;

constexpr double kCell = 0.01;  // of bare_block()

ToolForm form(ToolShape shape, double radius, const Vec3d& first = {}, const Vec3d& second = {}) {
  ToolForm made;
  made.shape = shape;
  made.radius = radius;
  made.first = first;
  made.second = second;
  return made;
}

/// bare_block() with triangles of half a cell: each of the two of a face divided into 4^4.
SceneSpec fine_block() {
  SceneSpec scene = bare_block();
  SurfaceSpec& s = scene.bodies[0].surface;
  for (int round = 0; round < 4; ++round) {
    SurfaceSpec finer{s.vertices, {}};
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, added] = middles.try_emplace(std::minmax(a, b), static_cast<int>(finer.vertices.size()));
      if (added) {
        const auto i = static_cast<std::size_t>(a), k = static_cast<std::size_t>(b);
        finer.vertices.push_back(vec::mul(vec::add(s.vertices[i], s.vertices[k]), 0.5));
      }
      return found->second;
    };
    for (const auto& t : s.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.triangles.insert(finer.triangles.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    s = finer;
  }
  return scene;
}

/// The block at rest, [-0.04, 0.04] in x and y, [-0.04, 0] in z.
class AtRest : public testing::Test {
 protected:
  [[nodiscard]] SunkenTool deepest(const ToolForm& tool, const Pose& at) const {
    const Simulation& s = simulation_;
    return BodySurfaces(s.model(), std::vector<double>(4 * s.model().mass.size(), 0.0)).deepest(tool, at, 1.5);
  }
  Simulation simulation_{scene_of(fine_block()), open_backend("cpu")};
};

TEST_F(AtRest, IsAsDeepAsTheExactDistance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(-0.06, 0.06);
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3d x{along(random), along(random), along(random)};
    const double exact = std::min({0.04 - std::abs(x[0]), 0.04 - std::abs(x[1]), -x[2], x[2] + 0.04});
    const SunkenTool found = deepest(form(ToolShape::sphere, 0.003), {x, {0, 0, 0, 1}});
    if (exact > 0) {
      ++inside;
      EXPECT_NEAR(found.depth, exact + 0.003, 1e-12) << x[0] << " " << x[1] << " " << x[2];
      EXPECT_EQ(found.where, x);
      EXPECT_EQ(found.body, 0);
      EXPECT_EQ(found.time, 1.5);
    } else {
      EXPECT_EQ(found.depth, 0) << x[0] << " " << x[1] << " " << x[2];
    }
  }
  EXPECT_GT(inside, 20);
}

TEST_F(AtRest, FindsTheDeepestPartOfAShape) {
  const double half = std::sqrt(0.5);
  const Pose lying{{0, 0, -0.005}, {0, half, 0, half}};  // z of the tool is x of the scene
  EXPECT_NEAR(deepest(form(ToolShape::capsule, 0.002, {0, 0, 0}, {0, 0, 0.2}), lying).depth, 0.005 + 0.002, 1e-12);
  const ToolForm standing = form(ToolShape::capsule, 0.002, {0, 0, 0}, {0, 0, 0.2});
  EXPECT_NEAR(deepest(standing, {{0, 0, -0.012}, {0, 0, 0, 1}}).depth, 0.012 + 0.002, 1e-12);
  EXPECT_EQ(deepest(standing, {{0, 0, 0.001}, {0, 0, 0, 1}}).depth, 0) << "it is not inside with less than its axis";
  const ToolForm box = form(ToolShape::box, 0, {}, {0.03, 0.002, 0.01});
  EXPECT_NEAR(deepest(box, {{0, 0, 0.005}, {0, 0, 0, 1}}).depth, 0.005, 1e-12) << "its lower corners and edges";
  const ToolForm rod = form(ToolShape::capsule, 0.002, {-0.5, 0, 0}, {0.5, 0, 0}),
                 plate = form(ToolShape::box, 0, {}, {0.5, 0.4, 0.001});
  EXPECT_NEAR(deepest(rod, {{0.02, 0, -0.02}, {0, 0, 0, 1}}).depth, 0.02 + 0.002, 1e-12)
      << "a meter long, with both ends outside";
  EXPECT_NEAR(deepest(plate, {{0.02, 0.03, -0.018}, {0, 0, 0, 1}}).depth, 0.019, 1e-12) << "a plate that divides the block";
  ToolForm peg = form(ToolShape::mesh, 0);
  peg.surface = {{{-0.003, -0.003, -0.06}, {0.003, -0.003, -0.06}, {0, 0.003, -0.06}, {0, 0, 0.06}},
                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_NEAR(deepest(peg, {{0, 0, -0.02}, {0, 0, 0, 1}}).depth, 0.02, 0.004) << "no vertex of it is inside";
  EXPECT_EQ(deepest(form(ToolShape::half_space, 0, {}, {0, 0, 1}), {{0, 0, -0.02}, {0, 0, 0, 1}}).depth, 0);
}

/// Below a face of it are points in its box that are not in it.
TEST(Sunken, BesideABlockThatStandsOnItsEdgeIsNotInIt) {
  SceneSpec scene = fine_block();
  scene.bodies[0].fixed.clear();
  const double half = std::sqrt(0.5);
  for (Vec3d& x : scene.bodies[0].surface.vertices) x = {half * (x[0] - x[2]), x[1], half * (x[0] + x[2])};
  const Simulation s(scene_of(scene), open_backend("cpu"));
  const BodySurfaces surfaces(s.model(), std::vector<double>(4 * s.model().mass.size(), 0.0));
  const auto depth = [&](double along, double down) {  // in the block's own directions
    const Vec3d x{half * (along - down), 0.0, half * (along + down)};
    return surfaces.deepest(form(ToolShape::sphere, 0.003), {x, {0, 0, 0, 1}}, 0).depth;
  };
  EXPECT_NEAR(depth(0.02, -0.015), 0.015 + 0.003, 1e-12);
  EXPECT_EQ(depth(-0.041, -0.02), 0);
  EXPECT_EQ(depth(0.02, -0.041), 0);
  EXPECT_EQ(depth(0.041, -0.02), 0);
  EXPECT_EQ(depth(0.02, 0.001), 0);
}

/// A needle that is pressed between the points of contact.
ToolSpec needle() {
  ToolSpec tool = ball("needle", {0, 0, 0.01}, 0.001);
  tool.path.push_back({0.3, 0, 0, -0.02, 0, 0, 0, 1});
  return tool;
}

TEST(Sunken, AWorldTellsThatATissueWasPassed) {
  for (const bool edges : {false, true}) {
    ToolSpec tool = needle();
    tool.edges = edges;
    if (edges) tool.path.back()[3] = -0.003;
    World world(block_with({tool}), on("cpu"));
    std::vector<Event> told;
    for (int i = 0; i < 60; ++i) {
      world.advance(0.01);
      for (Event& e : world.events()) {
        if (e.kind == "passed") told.push_back(e);
      }
    }
    if (edges) {
      EXPECT_TRUE(told.empty()) << "a tool that tissue holds has passed nothing";
      continue;
    }
    ASSERT_EQ(told.size(), 1U) << "once for as long as it lasts";
    EXPECT_EQ(told[0].subject, "needle");
    EXPECT_NE(told[0].text.find("below the surface of body 'block'"), std::string::npos) << told[0].text;
    EXPECT_TRUE(told[0].placed);
    EXPECT_LT(told[0].time, 0.3 + sunken_look_every + 0.02);
    EXPECT_GT(told[0].amount, sunken_cells);
  }
}

/// Of the coarse block the triangles show no dent; the points of contact do.
TEST(Sunken, APunchThatIsHeldHasPassedNothing) {
  for (const SceneSpec& block : {bare_block(), fine_block()}) {
    SceneSpec scene = block;
    ToolSpec tool = ball("punch", {0, 0, 0.021});
    tool.shape = "box";
    tool.size = {0.04, 0.04, 0.04};
    tool.path.push_back({0.5, 0, 0, 0.007, 0, 0, 0, 1});  // 13 mm deep
    scene.tools = {tool};
    Simulation simulation(scene_of(scene), open_backend("cpu"));
    while (simulation.time() < 0.8) simulation.advance(64);
    EXPECT_GT(simulation.report().tools[0].now.force[2], 0.5);
    EXPECT_LT(simulation.report().tools[0].deepest.cells(), 0.5) << "of 1.3 below the surface at rest";
  }
}

TEST(Sunken, ARunSaysSoAtItsEnd) {
  Simulation simulation(scene_of(block_with({needle()})), open_backend("cpu"));
  while (simulation.time() < 0.6) simulation.advance(64);
  const SunkenTool& deepest = simulation.report().tools[0].deepest;
  EXPECT_NEAR(deepest.depth, 0.02 + 0.001, 0.2 * kCell) << "tissue that let it through lies almost as at rest";
  EXPECT_NEAR(deepest.where[2], -0.02, 1e-9);
  const std::vector<std::string> remarks = run_remarks(simulation);
  Simulation early(scene_of(block_with({needle()})), open_backend("cpu"));
  while (early.time() < 0.24) early.advance(1);
  EXPECT_EQ(early.report().tools[0].deepest.depth, 0) << "before the first look";
  const std::vector<std::string> at_end = run_remarks(early);
  EXPECT_TRUE(std::any_of(at_end.begin(), at_end.end(),
                          [](const std::string& r) { return r.starts_with("tool 'needle' stood 0.01"); }));
  EXPECT_TRUE(std::any_of(remarks.begin(), remarks.end(), [](const std::string& r) {
    return r.starts_with("tool 'needle' stood 0.02") && r.find("have let it through") != std::string::npos;
  }));
}

}  // namespace
}  // namespace pliant::sunken_test
