// An operational region that follows the tool: nothing jumps when nodes change model, and both backends do it alike.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "io/save.h"
#include "model/contact/contact.h"
#include "simulation/state/compare.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace pliant::testing {
namespace {

/// A free bar 0.2 m long that bends and turns while the tool goes along it.
Scene followed_bar(int substeps) {
  const std::string text = R"({"format": "pliant-scene/1", "focus": {"path": [[0, -0.08, 0, 0], [0.2, 0.08, 0, 0]]},
    "bodies": [{"name": "bar", "surface": "meshes/cylinder.obj", "lattice": {"spacing": 0.01}, "element": "hex8",
      "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000},
      "velocity": [0.1, 0, 0], "angular_velocity": [0, 2, 1],
      "model": {"type": "hybrid", "ratio": 0.3, "follow": "focus", "goals": "extrapolated", "substeps": )" +
                           std::to_string(substeps) + R"(}}]})";
  return parse_scene(text, test::source_dir() + "/scenes/followed_bar.json");
}

Vec3d momentum(const Simulation& sim) {
  const auto v = sim.velocities(0);
  Vec3d p{};
  for (std::size_t n = 0; n < v.size(); ++n) {
    for (int c = 0; c < 3; ++c) p[c] += sim.model().mass[sim.model().bodies[0].slot[n]] * v[n][c];
  }
  return p;
}

TEST(Follow, NothingJumpsWhenTheRegionMoves) {
  for (const int substeps : {1, 2}) {
    Simulation sim(followed_bar(substeps), open_backend("cpu"));
    int moves = 0;
    double jump = 0, change = 0;
    for (int batch = 0; batch < 12; ++batch) {
      sim.advance(sim.next_batch(64));
      const auto before = sim.displacements(0);
      const Vec3d p = momentum(sim);
      const std::vector<MovedRegion> regions = sim.state().regions;
      const std::size_t ballast = sim.state().ballast.size();
      sim.begin_batch(1);  // where it looks at the tool
      // Inertia that elements give back takes its momentum along, and has nothing to do with the region.
      if (sim.state().regions == regions || sim.state().ballast.size() != ballast) continue;
      ++moves;
      EXPECT_NEAR(static_cast<double>(sim.model().bodies[0].operational_nodes + sim.model().bodies[0].interface_nodes) /
                      static_cast<double>(sim.model().nodes()),
                  0.3, 0.02);
      const auto after = sim.displacements(0);
      const Vec3d q = momentum(sim);
      for (std::size_t n = 0; n < after.size(); ++n) {
        for (int c = 0; c < 3; ++c) jump = std::max(jump, std::abs(after[n][c] - before[n][c]));
      }
      for (int c = 0; c < 3; ++c) change = std::max(change, std::abs(q[c] - p[c]) / std::hypot(p[0], p[1], p[2]));
    }
    std::cout << "             substeps " << substeps << ": " << moves << " moves, jump of position " << jump
              << " m (bound 3.8e-9), of momentum " << change << " (bound 1e-6)\n";
    EXPECT_GE(moves, 3);
    // The move itself changes no bit. The body is loose: at the same moment what it has flown, some 0.1 m, may be taken out of
    // node_u, which rounds by half a unit in the last place.
    EXPECT_LE(jump, std::ldexp(1.0, -28));
    EXPECT_LE(change, 1e-6);
  }
}

/// The first line of extrapolated goals after a move has no past: through the origin it would pull by half of the displacement.
TEST(Follow, ExtrapolatedGoalsMoveTheBarAsOneSubstepDoes) {
  const auto place = [](int substeps) {
    Simulation sim(followed_bar(substeps), open_backend("cpu"));
    while (sim.time() < 0.3) sim.advance(sim.next_batch(4));
    EXPECT_FALSE(sim.state().regions.empty());
    double most = 0;
    for (const Vec3d& d : sim.displacements(0)) most = std::max(most, vec::norm(d));
    return most;
  };
  const double alone = place(1);  // 0.061 m
  for (const int substeps : {2, 4}) EXPECT_NEAR(place(substeps) / alone, 1, 0.04) << substeps;
}

/// The region begins in the left end; the tool stands where the right one ends, which is stretched to twice its length.
Scene stretched_bar() {
  return parse_scene(R"({"format": "pliant-scene/1", "focus": {"path": [[0, 0.2, 0, 0]]},
    "bodies": [{"name": "bar", "surface": "meshes/cylinder.obj", "lattice": {"spacing": 0.01}, "element": "hex8",
      "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000, "damping": 30},
      "initial": [{"box": [[0, -1, -1], [1, 1, 1]], "displacement": {"linear": [[1, 0, 0], [0, 0, 0], [0, 0, 0]]}}],
      "model": {"type": "hybrid", "ratio": 0.3, "seed": [-0.1, 0, 0], "follow": "focus"}}]})",
                     test::source_dir() + "/scenes/stretched_bar.json");
}

TEST(Follow, CellsThatAreStretchedFarKeepTheirModelUntilTheyAreNot) {
  Simulation sim(stretched_bar(), open_backend("cpu"));
  const auto share = [&] {
    const ModelBody& body = sim.model().bodies[0];
    return static_cast<double>(body.operational_nodes + body.interface_nodes) / static_cast<double>(body.rest.size());
  };
  EXPECT_NEAR(share(), 0.3, 0.02);
  sim.begin_batch(1);
  ASSERT_EQ(sim.state().regions.size(), 1u);
  EXPECT_TRUE(sim.state().regions[0].waits);
  EXPECT_LT(share(), 0.05) << "the left end is slack and goes; the right end is not, and waits";
  while (sim.time() < 1.5) sim.advance(sim.next_batch(64));
  ASSERT_FALSE(sim.divergence());
  EXPECT_NEAR(share(), 0.3, 0.02) << "nothing is stretched any more";
}

TEST(Follow, BothBackendsMoveItAlike) {
  if (!has_opencl()) GTEST_SKIP() << "no OpenCL device";
  const Scene scene = followed_bar(2);
  Simulation a(scene, open_backend("cpu")), b(scene, a.shared_model(), open_backend("opencl:0"));
  const std::shared_ptr<const Model> first = a.shared_model();
  CompareOptions options;
  options.steps = 300;
  const ComparisonResult result = compare(a, b, options);
  EXPECT_TRUE(result.identical);
  EXPECT_NE(a.shared_model(), first) << "the region must have moved";
}

TEST(Follow, AResumedRunGivesTheSameBits) {
  const test::TempFolder folder;
  const auto file = folder.path() / "bar.pckpt";
  Simulation whole(followed_bar(1), open_backend("cpu"));
  whole.advance(150);
  write_checkpoint(file, take_checkpoint(whole));
  whole.advance(150);
  Simulation resumed(followed_bar(1), open_backend("cpu"));
  restore_checkpoint(resumed, read_checkpoint(file), file);
  resumed.advance(150);
  EXPECT_EQ(resumed.hash(), whole.hash());
  EXPECT_EQ(resumed.step(), whole.step());
}

/// A bar that is cut by a blade, or pressed by a tool, that its region follows.
Scene instrumented_bar(const std::string& follow, const std::string& instruments) {
  return parse_scene(R"({"format": "pliant-scene/1", )" + instruments + R"(
    "bodies": [{"name": "bar", "surface": "meshes/cylinder.obj", "lattice": {"spacing": 0.01}, "element": "hex8",
      "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000, "damping": 20},
      "fixed": [{"plane": [[0, -0.045, 0], [0, -1, 0]]}, {"plane": [[0, 0.045, 0], [0, 1, 0]]}],
      "model": {"type": "hybrid", "ratio": 0.3, "seed": [0, -0.04, 0], "follow": ")" +
                         follow + R"("}}]})",
                     test::source_dir() + "/scenes/instrumented_bar.json");
}
const char* const kScalpel = R"("blades": [{"name": "scalpel",
  "path": [[0, 0.03, -0.04, -0.05, 0.03, -0.04, 0.05], [1.6, 0.005, 0.04, -0.05, 0.005, 0.04, 0.05]]}],)";
const char* const kRod =
    R"("contact": true, "tools": [{"name": "rod", "shape": {"capsule": [[0, 0, -0.05], [0, 0, 0.05], 0.005]},
  "path": [[0, 0.03, -0.04, 0], [0.3, 0.022, -0.04, 0], [1.9, 0.022, 0.04, 0]]}],)";

/// Where the finite elements are along the bar [m].
double middle_of_region(const Simulation& sim) { return sim.state().regions.at(0).seed[1]; }

TEST(Follow, TheRegionGoesWithABladeAToolAndABladeOfTheHost) {
  Simulation cut(instrumented_bar("scalpel", kScalpel), open_backend("cpu"));
  for (const double at : {0.8, 1.4}) {
    while (cut.time() < at) cut.advance(cut.next_batch(64));
    EXPECT_NEAR(middle_of_region(cut), -0.04 + 0.05 * cut.time(), 0.025);
  }
  EXPECT_FALSE(cut.state().cuts.empty());
  Simulation pressed(instrumented_bar("rod", kRod), open_backend("cpu"));
  while (pressed.time() < 1.5) pressed.advance(pressed.next_batch(64));
  EXPECT_NEAR(middle_of_region(pressed), -0.04 + 0.05 * (pressed.time() - 0.3), 0.025);
  Simulation host(instrumented_bar("host/knife", ""), open_backend("cpu"));
  host.advance(host.next_batch(64));
  EXPECT_TRUE(host.state().regions.empty()) << "there is no knife yet";
  for (int k = 0; k <= 10; ++k) {
    const double y = -0.04 + 0.008 * k;
    host.move_blade("knife", {Vec3d{0.015, y, -0.05}, Vec3d{0.015, y, 0.05}});
    for (int i = 0; i < 2; ++i) host.advance(host.next_batch(64));
  }
  EXPECT_NEAR(middle_of_region(host), 0.04, 0.02);
}

/// Points of contact are not looked for again when the region moves: they are those that would be found.
TEST(Follow, PointsOfContactMoveWithTheirNodes) {
  Simulation sim(instrumented_bar("scalpel", std::string(kScalpel) + kRod), open_backend("cpu"));
  int moves = 0, renumbered = 0;
  while (sim.time() < 1.4) {
    sim.advance(sim.next_batch(64));
    const std::vector<MovedRegion> regions = sim.state().regions;
    const auto before = sim.shared_model();
    sim.begin_batch(1);  // where it looks at the blade
    if (sim.state().regions == regions) continue;
    ++moves;
    renumbered += sim.model().bodies[0].slot != before->bodies[0].slot ? 1 : 0;
    const ContactPoints &now = *sim.model().contact, fresh = contact_points(sim.model(), false);
    EXPECT_EQ(now.rest, fresh.rest);
    EXPECT_EQ(now.nodes, fresh.nodes);
    EXPECT_EQ(now.weights, fresh.weights);
    EXPECT_EQ(now.area, fresh.area);
    EXPECT_EQ(now.normal, fresh.normal);
  }
  EXPECT_GE(moves, 3);
  EXPECT_GE(renumbered, 3);
  EXPECT_FALSE(sim.state().cuts.empty());
}

TEST(Follow, ACutThatTheRegionFollowsIsTheSameOnBothBackendsAndAfterAResume) {
  for (const auto& [follow, instruments] : {std::pair("scalpel", kScalpel), std::pair("rod", kRod)}) {
    const Scene scene = instrumented_bar(follow, instruments);
    const test::TempFolder folder;
    const auto file = folder.path() / "bar.pckpt";
    Simulation whole(scene, open_backend("cpu"));
    whole.advance(150);
    write_checkpoint(file, take_checkpoint(whole));
    whole.advance(150);
    Simulation resumed(scene, open_backend("cpu"));
    restore_checkpoint(resumed, read_checkpoint(file), file);
    resumed.advance(150);
    EXPECT_EQ(resumed.hash(), whole.hash()) << follow;
    if (!has_opencl()) continue;
    Simulation a(scene, open_backend("cpu")), b(scene, a.shared_model(), open_backend("opencl:0"));
    CompareOptions options;
    options.steps = 300;
    EXPECT_TRUE(compare(a, b, options).identical) << follow;
  }
}

TEST(Follow, ACheckpointOfAnotherInstrumentIsRefused) {
  const std::string both = std::string(kScalpel) + kRod;
  const test::TempFolder folder;
  const auto file = folder.path() / "bar.pckpt";
  Simulation first(instrumented_bar("scalpel", both), open_backend("cpu"));
  write_checkpoint(file, take_checkpoint(first));
  Simulation other(instrumented_bar("rod", both), open_backend("cpu"));
  const std::string message = test::error_of([&] { restore_checkpoint(other, read_checkpoint(file), file); });
  EXPECT_NE(message.find("not the same: focus"), std::string::npos) << message;
}

}  // namespace
}  // namespace pliant::testing
