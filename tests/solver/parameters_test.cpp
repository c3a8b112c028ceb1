// Parameters that change while a scene runs: the physics of each, equal bits for the scene's changes and the host's, and what
// stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "io/save.h"
#include "pliant/error.h"
#include "simulation/state/compare.h"
#include "solver/scenes.h"
#include "support/temp_folder.h"

namespace pliant::testing {
namespace {

/// A cube of 0.1 m that hangs from its top; `more`: further keys of the scene and of the body.
Scene hanging(const std::string& scene_keys = "", const std::string& body_keys = "") {
  return parse_scene(R"({"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{"name": "cube",
    "surface": "meshes/cube.obj", "lattice": {"spacing": 0.02}, "material": {"young": 60000, "poisson": 0.3, "density": 1000, "damping": 60},
    "fixed": [{"plane": [[0, 0.049, 0], [0, 1, 0]]}])" +
                         body_keys + "}]" + scene_keys + "}",
                     test::source_dir() + "/scenes/hanging.json");
}

/// A cut liver in miniature: a hybrid whose region follows the blade; a tool that presses and tissue that touches, or substeps
/// of shape matching, which allow neither.
Scene rich(const std::string& changes, bool touched = true) {
  const std::string contact = R"(, "contact": {}, "tools": [{"name": "ball", "shape": {"sphere": 0.015}, "friction": 0.4,
    "path": [[0, 0.037, -0.025, 0], [0.1, 0.03, -0.01, 0]]}])";
  return parse_scene(R"({"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{"name": "bar",
    "surface": "meshes/cylinder.obj", "lattice": {"spacing": 0.012}, "material": {"young": 6000, "poisson": 0.4, "density": 1000, "damping": 20},
    "fixed": [{"plane": [[0, -0.045, 0], [0, -1, 0]]}],
    "model": {"type": "hybrid", "ratio": 0.5, "follow": "knife")" +
                         std::string(touched ? "" : R"(, "substeps": 2)") + R"(}}],
    "blades": [{"name": "knife", "path": [[0.01, 0.04, 0.01, -0.06, 0.04, 0.01, 0.06], [0.1, -0.005, 0.01, -0.06, -0.005, 0.01, 0.06]]}])" +
                         (touched ? contact : "") + changes + "}",
                     test::source_dir() + "/scenes/rich.json");
}

double lowest(const Simulation& sim) {
  double y = 0;
  for (const Vec3d& u : sim.displacements(0)) y = std::min(y, u[1]);
  return y;
}

void run_to(Simulation& sim, double time) {
  while (sim.time() < time && !sim.divergence()) sim.advance(sim.next_batch(64));
}

TEST(Parameters, HalfTheModulusSagsTwiceAsFar) {
  const std::string half = R"(, "changes": [{"time": 0.5, "material": {"young": 30000}}])";
  Simulation sim(hanging(half), open_backend("cpu:double"));
  run_to(sim, 0.5);
  const double before = lowest(sim), step = sim.dt();
  run_to(sim, 1.2);
  EXPECT_NEAR(lowest(sim) / before, 2, 0.02);
  EXPECT_NEAR(sim.dt() / step, std::sqrt(2.0), 0.05) << "softer elements take longer steps";
  sim.change(R"({"material": {"young": 240000}})");
  EXPECT_LT(sim.dt(), 0.4 * step * std::sqrt(2.0)) << "and stiffer ones shorter, at once";
  run_to(sim, 1.8);
  EXPECT_NEAR(lowest(sim) / before, 0.25, 0.01);
}

TEST(Parameters, GravityTurnsAndGoes) {
  Simulation sim(hanging(), open_backend("cpu:double"));
  run_to(sim, 0.5);
  const double before = lowest(sim);
  sim.change(R"({"gravity": [0, -4.905, 0]})");
  run_to(sim, 1);
  EXPECT_NEAR(lowest(sim) / before, 0.5, 0.01);
  sim.change(R"({"gravity": [0, 0, 0]})");
  run_to(sim, 1.6);
  EXPECT_LT(std::abs(lowest(sim) / before), 1e-3);
}

TEST(Parameters, DampingChangesHowFastItRests) {
  const auto swing = [](const char* damping) {
    Simulation sim(hanging("", R"(, "velocity": [0.3, 0, 0])"), open_backend("cpu"));
    sim.change(std::string(R"({"gravity": [0, 0, 0], "material": {"damping": )") + damping + "}}");
    run_to(sim, 0.3);
    double most = 0;
    for (const Vec3d& v : sim.velocities(0)) most = std::max(most, vec::norm(v));
    return most;
  };
  EXPECT_LT(swing("60"), 0.02 * swing("0"));
}

/// What is held is held where it is, and springs back when it is let go.
TEST(Parameters, NodesAreHeldWhereTheyAreAndLetGo) {
  for (const char* backend : {"cpu", "cpu:double"}) {
    Simulation sim(hanging(), open_backend(backend));
    run_to(sim, 0.5);
    const std::vector<Vec3d> sagged = sim.displacements(0);
    const std::vector<Vec3d> rest = sim.model().bodies[0].rest;
    sim.change(R"({"fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}], "gravity": [0, 0, 0]})");
    const std::vector<Vec3d> held = sim.displacements(0);
    for (std::size_t n = 0; n < rest.size(); ++n) EXPECT_EQ(held[n], sagged[n]) << "a change moves nothing";
    run_to(sim, 1.2);
    const std::vector<Vec3d> now = sim.displacements(0);
    double top = 0;
    for (std::size_t n = 0; n < rest.size(); ++n) {
      if (rest[n][1] < -0.049) {
        EXPECT_EQ(now[n], sagged[n]) << "the bottom is held where it hung";
      }
      if (rest[n][1] > 0.049) top = std::min(top, now[n][1]);
    }
    EXPECT_LT(top, 0.5 * lowest(sim)) << "the top was let go, and follows";
  }
}

TEST(Parameters, AChangeToTheSameValueChangesNoBit) {
  Simulation with(rich(""), open_backend("cpu")), without(rich(""), open_backend("cpu"));
  for (Simulation* sim : {&with, &without}) run_to(*sim, 0.09);
  ASSERT_EQ(with.hash(), without.hash());
  ASSERT_EQ(with.state().clock.step % 2, 0);
  with.change(R"({"material": {"damping": 20}})");
  EXPECT_EQ(with.hash(), without.hash());
  // Every buffer that the next step reads, apart from those that the next search for contact writes first.
  const Simulation fresh(rich(""), open_backend("cpu"));
  const auto first = take_checkpoint(fresh).snapshot.buffers, kept = take_checkpoint(with).snapshot.buffers,
             before = take_checkpoint(without).snapshot.buffers;
  std::vector<std::string> carried;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i].name == "contact_near") continue;
    EXPECT_EQ(kept[i].bytes, before[i].bytes) << kept[i].name;
    if (before[i].bytes != first[i].bytes) carried.push_back(kept[i].name);
  }
  std::sort(carried.begin(), carried.end());
  for (const char* name : {"contact_anchor", "contact_yield", "flsm_goals/0", "touch_pair", "touch_depth"})
    EXPECT_TRUE(std::binary_search(carried.begin(), carried.end(), name))
        << name << " is in its first state, which shows nothing";
  for (Simulation* sim : {&with, &without}) sim->advance(128);
  EXPECT_EQ(with.hash(), without.hash()) << "contact, friction and shape matching go on";
}

/// Five changes; `substeps`: also of that.
Scene changing(bool touched) {
  return rich(R"(, "changes": [
    {"time": 0.02, "material": {"young": 4000}}, {"time": 0.04, "gravity": [0, -3, 1]},
    {"time": 0.05, "model": {"ratio": 0.3, "alpha": 0.3}}, {"time": 0.07, "material": {"damping": 9})" +
                  std::string(touched ? "" : R"(, "model": {"substeps": 3})") + R"(},
    {"time": 0.09, "fixed": [{"plane": [[0, 0.045, 0], [0, 1, 0]]}]}])",
              touched);
}

TEST(Parameters, BothBackendsChangeAlike) {
  if (!has_opencl()) GTEST_SKIP() << "no OpenCL device";
  for (const bool touched : {true, false}) {
    const Scene scene = changing(touched);
    Simulation a(scene, open_backend("cpu")), b(scene, a.shared_model(), open_backend("opencl:0"));
    CompareOptions options;
    options.steps = 400;
    const ComparisonResult result = compare(a, b, options);
    EXPECT_TRUE(result.identical);
    EXPECT_EQ(a.state().changed.done, 5);
    EXPECT_GT(a.topology_version(), 0) << "it is cut as well";
  }
}

TEST(Parameters, TheHostsChangesGiveTheBitsOfTheScenes) {
  const Scene with = changing(true);
  Simulation scene(with, open_backend("cpu")), host(rich(""), open_backend("cpu"));
  for (const SceneChange& change : with.changes) {
    while (!scene.divergence() && scene.state().changed.done <= &change - with.changes.data()) {
      const std::int64_t n = scene.next_batch(64);
      // The batch in which the scene's change is made begins with it.
      const std::int64_t done = scene.state().changed.done;
      scene.begin_batch(static_cast<std::int32_t>(n));
      if (scene.state().changed.done > done) {
        ASSERT_EQ(host.step(), scene.step());
        host.change(change.text);
      }
      scene.run_steps(0, static_cast<std::int32_t>(n));
      scene.end_batch(static_cast<std::int32_t>(n));
      host.begin_batch(static_cast<std::int32_t>(n));
      host.run_steps(0, static_cast<std::int32_t>(n));
      host.end_batch(static_cast<std::int32_t>(n));
    }
  }
  ASSERT_EQ(scene.state().changed.done, 5);
  EXPECT_EQ(host.state().changed.parameters, scene.state().changed.parameters);
  EXPECT_EQ(host.step(), scene.step());
  EXPECT_EQ(host.hash(), scene.hash());
}

TEST(Parameters, AResumedRunGivesTheSameBits) {
  const test::TempFolder folder;
  for (const bool touched : {true, false}) {
    Simulation whole(changing(touched), open_backend("cpu"));
    std::vector<std::filesystem::path> files;
    std::vector<std::int64_t> steps;
    std::vector<std::uint64_t> deep;
    while (whole.time() < 0.12) {
      whole.advance(files.empty() ? 5 : 23);
      files.push_back(folder.path() / (std::to_string(whole.step()) + ".pckpt"));
      steps.push_back(whole.step());
      deep.push_back(whole.deep_hash());
      write_checkpoint(files.back(), take_checkpoint(whole));
    }
    ASSERT_FALSE(whole.divergence());
    ASSERT_EQ(whole.state().changed.done, 5);
    for (std::size_t i = 0; i < files.size(); ++i) {
      Simulation resumed(changing(touched), open_backend("cpu"));
      restore_checkpoint(resumed, read_checkpoint(files[i]), files[i]);
      EXPECT_EQ(resumed.deep_hash(), deep[i]) << "at step " << steps[i];
      for (std::size_t k = i + 1; k < files.size(); ++k) {
        resumed.advance(steps[k] - resumed.step());
        ASSERT_EQ(resumed.deep_hash(), deep[k])
            << "from step " << steps[i] << " at step " << steps[k] << ", " << resumed.state().changed.done;
      }
    }
    // Back in time: what had changed is as it was.
    restore_checkpoint(whole, read_checkpoint(files[0]), files[0]);
    EXPECT_NEAR(whole.scene().bodies[0].material.moduli.young(), 6000, 1e-9);
  }
}

TEST(Parameters, AChangeThatIsRefusedChangesNothing) {
  Simulation sim(hanging(), open_backend("cpu"));
  sim.advance(100);
  const std::uint64_t before = sim.deep_hash();
  EXPECT_THROW(sim.change(R"({"material": {"young": -1}})"), Error);
  EXPECT_THROW(sim.change(R"({"fixed": [{"box": [[5, 5, 5], [6, 6, 6]]}]})"), Error) << "no node is there";
  EXPECT_EQ(sim.deep_hash(), before);
  sim.advance(100);
  EXPECT_FALSE(sim.divergence());
}

}  // namespace
}  // namespace pliant::testing
