// What the probes of a scene say in a World, in C++ and in C.
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstring>

#include "pliant/c/pliant.h"
#include "scenes.h"

namespace pliant {
namespace {

using test::code_of;
using test::message_of;
using test::on;

/// A block of 10 x 8 x 6 cm under gravity that stands on its lower face; `probes` is the list of its probes.
std::string scene_with(const std::string& probes) {
  return R"({"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{"name": "block",
    "surface": "memory:0", "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45, "damping": 5},
    "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}]}], "probes": [)" +
         probes + "]}";
}

const char* const kProbes = R"({"name": "corner", "point": [0.1, 0.08, 0.06]},
  {"name": "inside", "point": [0.05, 0.03, 0.03], "quantities": ["stress", "position"]},
  {"name": "all", "all": true, "quantities": ["energy", "force", "velocity"]},
  {"name": "floor", "plane": [[0, 0.001, 0], [0, -1, 0]], "quantities": ["reaction"]})";

World block_with(const std::string& probes) {
  return World::parse(scene_with(probes), "", on("cpu"), {box_surface({0, 0, 0}, {0.1, 0.08, 0.06})});
}

std::vector<double> find(const std::vector<ProbeValue>& values, const std::string& probe, const std::string& quantity) {
  for (const ProbeValue& v : values) {
    if (v.probe == probe && v.quantity == quantity) return v.numbers;
  }
  ADD_FAILURE() << probe << " has no " << quantity;
  return std::vector<double>(6);
}

TEST(Probes, AreNamedInTheOrderOfTheScene) {
  const World world = block_with(kProbes);
  std::vector<std::string> names;
  for (const ProbeValue& v : world.probes()) {
    names.push_back(v.probe + " " + v.quantity);
    EXPECT_EQ(v.numbers.size(), v.quantity == "stress" ? 6U : v.quantity == "energy" ? 2U : 3U) << v.quantity;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"corner position", "corner displacement", "corner velocity", "inside stress",
                                             "inside position", "all energy", "all force", "all velocity", "floor reaction"}));
  EXPECT_TRUE(World(test::block(), on("cpu")).probes().empty());
}

/// Against what the World says of its nodes.
TEST(Probes, SayWhatTheNodesSay) {
  World world = block_with(kProbes);
  const double mass = world.info().bodies[0].mass;
  EXPECT_EQ(find(world.probes(), "all", "energy")[1], 0);
  world.advance(2);
  const std::vector<ProbeValue> now = world.probes();
  const auto x = world.rest_positions(0), u = world.displacements(0), v = world.velocities(0);
  std::size_t corner = x.size();
  Vec3d mean{};
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (std::abs(x[n][0] - 0.1) + std::abs(x[n][1] - 0.08) + std::abs(x[n][2] - 0.06) < 1e-9) corner = n;
    for (std::size_t c = 0; c < 3; ++c) mean[c] += v[n][c] / static_cast<double>(x.size());
  }
  ASSERT_LT(corner, x.size());
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(find(now, "corner", "displacement")[c], u[corner][c], 1e-12);
    EXPECT_NEAR(find(now, "corner", "position")[c], x[corner][c] + u[corner][c], 1e-12);
    EXPECT_NEAR(find(now, "corner", "velocity")[c], v[corner][c], 1e-12);
    EXPECT_NEAR(find(now, "all", "velocity")[c], mean[c], 1e-12);
    EXPECT_NEAR(find(now, "all", "force")[c], c == 1 ? -9.81 * mass : 0, 1e-9 * mass);
  }
  EXPECT_LT(u[corner][1], -1e-4);
  EXPECT_NEAR(find(now, "inside", "stress")[1], -490, 100)
      << "it carries the 5 cm that stand on it, in the middle a little more";
  EXPECT_NEAR(find(now, "floor", "reaction")[1], 9.81 * mass, 0.05 * 9.81 * mass) << "it has come to rest";
  EXPECT_GT(find(now, "all", "energy")[0], 0);
  EXPECT_GT(find(now, "all", "energy")[1], 0);
}

/// Of a field u = L X at the start, of which F = I + L is known: for every element, at any point.
TEST(Probes, StrainsOfALinearField) {
  SceneSpec spec = test::block(0);
  BodySpec& body = spec.bodies[0];
  body.fixed.clear();
  FieldSpec field;
  field.linear = {{{0.1, 0.2, 0}, {-0.05, 0, 0.3}, {0, 0.02, -0.1}}};
  body.initial.emplace_back().displacement = field;
  ProbeSpec& probe = spec.probes.emplace_back();
  probe.name = "p";
  probe.point = Vec3d{0.033, 0.021, 0.047};
  probe.quantities = {"green_strain", "almansi_strain"};
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) f(r, c) += field.linear[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  }
  const Eigen::Matrix3d green = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d almansi = 0.5 * (Eigen::Matrix3d::Identity() - (f * f.transpose()).inverse());
  for (const char* const element : {"hex8", "tet4"}) {
    body.element = element;
    const std::vector<ProbeValue> now = World(spec, on("cpu:double")).probes();
    ASSERT_EQ(now.size(), 2U);
    const auto expect = [](const std::vector<double>& found, const Eigen::Matrix3d& t) {
      const std::array<double, 6> expected{t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(1, 2), t(2, 0)};
      ASSERT_EQ(found.size(), 6U);
      for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(found[k], expected[k], 1e-12) << k;
    };
    expect(now[0].numbers, green);
    expect(now[1].numbers, almansi);
  }
}

TEST(Probes, OfASceneInCodeAreThoseOfTheText) {
  SceneSpec spec = test::block(0);
  ProbeSpec corner, all;
  corner.name = "corner";
  corner.point = Vec3d{0.1, 0.08, 0.06};
  all.name = "all";
  all.quantities = {"energy", "force", "velocity"};
  spec.probes = {corner, all};
  World code(spec, on("cpu")), text = block_with(kProbes);
  code.step(60);
  text.step(60);
  for (const ProbeValue& v : code.probes()) EXPECT_EQ(v.numbers, find(text.probes(), v.probe, v.quantity)) << v.probe;
  EXPECT_EQ(code.probes().size(), 6U);
}

TEST(Probes, AreOfTheNewestStateAndChangeNothing) {
  World asked = block_with(kProbes), plain = block_with("");
  for (int k = 0; k < 4; ++k) {
    ASSERT_TRUE(asked.step_async(25));
    const double seen = find(asked.probes(), "corner", "position")[1];
    EXPECT_EQ(asked.step_number(), 25 * (k + 1)) << "it waited for the worker";
    EXPECT_NEAR(seen, 0.08 + find(asked.probes(), "corner", "displacement")[1], 1e-12);
  }
  plain.step(100);
  EXPECT_EQ(asked.hash(), plain.hash());
  // What is cut off goes on being followed.
  asked.cut({{{{-1, 0.045, -1}, {-1, 0.045, 3}, {3, 0.045, -1}}}});
  ASSERT_EQ(asked.pieces(0), 2);
  EXPECT_EQ(asked.probes().size(), 9U);
  asked.reset();
  EXPECT_EQ(find(asked.probes(), "corner", "displacement"), (std::vector<double>{0, 0, 0}));
}

TEST(Probes, InNoBodyAreInput) {
  const auto outside = [] { block_with(R"({"name": "far", "point": [1, 0, 0]})"); };
  EXPECT_EQ(code_of(outside), ErrorCode::input);
  EXPECT_NE(message_of(outside).find("/probes/0: [1, 0, 0] m is in no body"), std::string::npos) << message_of(outside);
}

TEST(Probes, SayTheSameInC) {
  World other = block_with(kProbes);
  const SurfaceSpec box = box_surface({0, 0, 0}, {0.1, 0.08, 0.06});
  const pliant_surface surface{sizeof(pliant_surface), box.vertices[0].data(), box.vertices.size(), box.triangles[0].data(),
                               box.triangles.size()};
  pliant_options options = PLIANT_OPTIONS_INIT;
  options.backend = "cpu";
  pliant_world world{0};
  ASSERT_EQ(pliant_world_parse(scene_with(kProbes).c_str(), nullptr, &surface, 1, &options, &world), PLIANT_OK);
  other.step(50);
  ASSERT_EQ(pliant_world_step(world, 50, nullptr), PLIANT_OK);
  const std::vector<ProbeValue> expected = other.probes();
  std::size_t needed = 0;
  ASSERT_EQ(pliant_world_probes(world, nullptr, 0, &needed), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(needed, expected.size());
  /// A later version's struct is longer; there is room for one more than there are.
  struct Later {
    pliant_probe_value known = PLIANT_PROBE_VALUE_INIT;
    double more[2]{7, 7};
  };
  std::vector<Later> values(needed + 1);
  for (Later& v : values) v.known.size = sizeof(Later);
  ASSERT_EQ(pliant_world_probes(world, &values[0].known, values.size(), nullptr), PLIANT_OK) << pliant_last_error();
  for (std::size_t i = 0; i < needed; ++i) {
    const pliant_probe_value& v = values[i].known;
    EXPECT_EQ(v.probe, expected[i].probe);
    EXPECT_EQ(v.quantity, expected[i].quantity);
    EXPECT_EQ(std::vector<double>(v.numbers, v.numbers + v.number_count), expected[i].numbers);
    EXPECT_EQ(values[i].more[1], 0);
  }
  EXPECT_EQ(values[needed].known.probe, nullptr);
  values[0].known.size = sizeof(pliant_probe_value);
  EXPECT_EQ(pliant_world_probes(world, &values[0].known, 2, nullptr), PLIANT_USAGE) << "two sizes in one array";
  EXPECT_NE(std::string(pliant_last_error()).find("in out[1]"), std::string::npos) << pliant_last_error();
  EXPECT_EQ(pliant_world_probes(world, nullptr, 1, &needed), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_destroy(world), PLIANT_OK);
}

}  // namespace
}  // namespace pliant
