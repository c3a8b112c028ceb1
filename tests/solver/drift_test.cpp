// Free bodies far from their places at rest: node_u leaves out how far they have flown, and everything that reads places knows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "model/contact/contact.h"
#include "schedule/program_layout.h"
#include "solver/scenes.h"

namespace pliant {
namespace {

class Drifts : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == "opencl:0" && !testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
};
INSTANTIATE_TEST_SUITE_P(On, Drifts, ::testing::Values("cpu", "opencl:0"),
                         [](const auto& test) { return std::string(test.param) == "cpu" ? "cpu" : "opencl"; });

/// A cube of 0.1 m that flies along x at 20 m/s and spins slowly, beside one that is held at the bottom.
Scene flying_cube() {
  const std::string body = R"("surface": "meshes/cube.obj", "lattice": {"spacing": 0.02}, "element": "hex8",
    "material": {"young": 3000, "poisson": 0.4, "density": 1000})";
  const std::string text = R"({"format": "pliant-scene/1", "bodies": [
    {"name": "flies", )" + body +
                           R"(, "velocity": [20, 0, 0], "angular_velocity": [0, 0, 2]},
    {"name": "stays", )" + body +
                           R"(, "translate": [0, 1, 0], "fixed": [{"plane": [[0, 0.951, 0], [0, -1, 0]]}]}]})";
  return parse_scene(text, test::source_dir() + "/scenes/flying_cube.json");
}

double mean(const std::vector<Vec3d>& values, std::size_t first, std::size_t count, std::size_t c) {
  double sum = 0;
  for (std::size_t i = first; i < first + count; ++i) sum += values[i][c];
  return sum / static_cast<double>(count);
}

/// Displacements and the surface are those of a body that flies, although node_u holds less.
void expect_places(Simulation& s) {
  const std::vector<Vec3d> u = s.displacements(0), surface = s.surface_positions();
  EXPECT_NEAR(mean(u, 0, u.size(), 0), 20 * s.time(), 0.01);
  const ModelBody &flies = s.model().bodies[0], &stays = s.model().bodies[1];
  EXPECT_NEAR(mean(surface, static_cast<std::size_t>(flies.first_vertex), static_cast<std::size_t>(flies.vertices), 0),
              20 * s.time(), 0.02);
  EXPECT_NEAR(mean(surface, static_cast<std::size_t>(stays.first_vertex), static_cast<std::size_t>(stays.vertices), 0), 0,
              0.01);
  const std::vector<double> held = s.backend().read_reals(s.program().find("node_u"));
  double most = 0;
  for (const std::int32_t slot : flies.slot) most = std::max(most, std::abs(held[4 * static_cast<std::size_t>(slot)]));
  EXPECT_LT(most, 10) << "of " << 20 * s.time() << " m";
}

TEST_P(Drifts, AreCutAndResumedWhereTheyAre) {
  const Scene scene = flying_cube();
  const auto fly_and_cut = [&](Simulation& s) {
    s.advance(3000);
    expect_places(s);
    const double x = mean(s.displacements(0), 0, s.displacements(0).size(), 0);
    const CutReport cut = s.cut(std::vector<SweepTriangle>{{{{x + 0.003, -2, -2}, {x + 0.003, 4, 0}, {x + 0.003, -2, 2}}}});
    EXPECT_EQ(cut.edges > 0, true) << "nothing was met at x = " << x;
    EXPECT_FALSE(s.state().offset.empty());
    expect_places(s);
  };
  Simulation whole(scene, open_backend(GetParam())), part(scene, open_backend(GetParam())),
      resumed(scene, open_backend(GetParam()));
  fly_and_cut(whole);
  EXPECT_EQ(whole.cut_topology(0)->pieces(), 2);
  EXPECT_EQ(whole.cut_topology(1) == nullptr ? 1 : whole.cut_topology(1)->pieces(), 1);
  whole.advance(700);
  expect_places(whole);
  fly_and_cut(part);
  part.advance(100);
  resumed.restore(part.snapshot());
  expect_places(resumed);
  EXPECT_EQ(resumed.deep_hash(), part.deep_hash());
  resumed.advance(600);
  EXPECT_EQ(resumed.deep_hash(), whole.deep_hash());
  if (std::string(GetParam()) != "cpu") {
    Simulation twin(scene, open_backend("cpu"));
    fly_and_cut(twin);
    twin.advance(700);
    EXPECT_EQ(whole.hash(), twin.hash());
    EXPECT_EQ(write_state(whole.state()), write_state(twin.state()));
  }
}

/// A piece that is held where it has flown to keeps its offset, and its points of contact know where their held nodes are.
TEST_P(Drifts, HeldNodesOfContactAreWhereTheyAre) {
  Scene scene = flying_cube();
  ContactTool far;
  far.name = "far";
  far.radius = 0.01;
  far.path = {{0, 0, -5, 0, 0, 0, 0, 1}};
  scene.tools = {far};
  Simulation s(scene, open_backend(GetParam()));
  s.advance(3000);
  ASSERT_FALSE(s.state().offset.empty());
  s.change(R"({"body": "flies", "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}]})");
  s.advance(64);
  ASSERT_FALSE(s.state().offset.empty());
  const ContactPoints& points = *s.model().contact;
  const std::vector<double> held = s.backend().read_reals(s.program().find("contact_held")),
                            share = s.backend().read_reals(s.program().find("contact_share")),
                            u = s.backend().read_reals(s.program().find("node_u"));
  std::vector<Vec3d> place(static_cast<std::size_t>(s.model().slots));
  for (std::size_t b = 0; b < 2; ++b) {
    const std::vector<Vec3d> moved = s.displacements(b);
    for (std::size_t n = 0; n < moved.size(); ++n)
      place[static_cast<std::size_t>(s.model().bodies[b].slot[n])] = vec::add(s.model().bodies[b].rest[n], moved[n]);
  }
  double most = 0, far_off = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(held[tile_base(i, 4) + std::size_t{3} * PLIANT_TILE] > 0)) continue;
    Vec3d sum{}, known{};
    for (std::size_t a = 0; a < 8; ++a) {
      if (share[tile_base(i, 8) + a * PLIANT_TILE] > 0) continue;
      const auto slot = static_cast<std::size_t>(points.nodes[i][a]);
      const double weight = double(points.weights[i][a]) / contact_weight_unit;
      sum = vec::add(sum, vec::mul(place[slot], weight));
      known = vec::add(known, vec::mul(Vec3d{u[4 * slot], u[4 * slot + 1], u[4 * slot + 2]}, weight));
    }
    for (std::size_t c = 0; c < 3; ++c) known[c] += held[tile_base(i, 4) + c * PLIANT_TILE];
    most = std::max(most, vec::norm(vec::sub(sum, known)));
    far_off = std::max(far_off, vec::norm(sum));
  }
  EXPECT_GT(far_off, 10);
  EXPECT_LT(most, 1e-4);
}

/// What holds a body anywhere, holds it to its place at rest.
TEST_P(Drifts, BodiesThatAreHeldKeepTheirDisplacement) {
  Simulation s(testing::pressed_cube(0.04), open_backend(GetParam()));
  s.advance(400);
  EXPECT_TRUE(s.state().offset.empty());
}

}  // namespace
}  // namespace pliant
