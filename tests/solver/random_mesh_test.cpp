// Whole steps on random distorted meshes, every element and law: OpenCL and the float twins hold the same bits after every
// pass, and every work-group size, number of lanes and number of threads gives the same state.
#include <gtest/gtest.h>

#include "backends/opencl/opencl_backend.h"
#include "backends/twins/ref_backend.h"
#include "physics/harness.h"
#include "program/hash.h"
#include "simulation/state/compare.h"
#include "solver/scenes.h"

namespace pliant::physics {
namespace {

/// A distorted block that falls on its fixed end, is pulled at the other, and starts with a spin.
Scene random_scene(Discretization cut, Law law, unsigned seed) {
  std::mt19937 random(seed);
  const auto count = [&] { return 2 + static_cast<int>(random() % 4); };
  Box box{{count(), count(), count()}, 0.01};
  if (!is_lattice(cut)) box.distortion = 0.15;
  box.seed = seed;
  Scene scene;
  scene.gravity = {0.5, -9.81, 1};
  scene.bodies = {box_body(box, cut, material_young(law, 3000, 0.4))};
  Body& body = scene.bodies[0];
  body.material.damping = 3;
  body.angular_velocity = {1, 2, -3};
  Fixed fixed;
  fixed.where = face(0, 0);
  body.fixed = {fixed};
  body.prescribed = {pull(0, box.cells[0] * box.edge, 0.002, smooth(0.02))};
  scene.safety = 0.5;
  return scene;
}

bool has_law(Discretization cut, Law law) { return cut != Discretization::tet4anp || law_info(law).volumetric; }

TEST(RandomMeshes, LockstepOnOpenclAndTwins) {
  if (!testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  unsigned seed = 1;
  for (const Discretization cut : all_cuts()) {
    for (const Law law : all_laws()) {
      if (!has_law(cut, law)) continue;
      const Scene scene = random_scene(cut, law, seed++);
      Simulation a(scene, open_backend("opencl:0"));
      Simulation b(scene, a.shared_model(), open_backend("cpu"));
      CompareOptions options;
      options.steps = 40;
      const ComparisonResult result = compare(a, b, options);
      EXPECT_TRUE(result.identical) << name_of(cut) << ' ' << to_string(law) << ": "
                                    << (result.first_difference ? result.first_difference->message() : "");
      EXPECT_EQ(result.steps, 40) << name_of(cut);
    }
  }
}

/// Calls f(backend, its name) for the twins on several threads and OpenCL with several lanes and groups.
template <class F>
void for_all_splits(const F& f) {
  for (const int threads : {1, 2, 3}) {
    RefOptions options;
    options.threads = threads;
    f(make_ref_backend(options), std::to_string(threads) + " threads");
  }
  if (!testing::has_opencl()) return;
  for (const int lanes : {1, 16}) {
    for (const int local : {0, 1, 4}) {
      OpenclOptions options;
      options.lanes = lanes;
      options.local_size = local;
      f(make_opencl_backend(0, options), std::to_string(lanes) + " lanes, groups of " + std::to_string(local));
    }
  }
}

/// The state after `steps` is that of the twins.
void expect_one_state(const Scene& scene, std::int64_t steps, const std::string& name) {
  Simulation first(scene, open_backend("cpu"));
  first.advance(steps);
  for_all_splits([&](std::unique_ptr<Backend> backend, const std::string& what) {
    Simulation other(scene, first.shared_model(), std::move(backend));
    other.advance(steps);
    EXPECT_EQ(other.hash(), first.hash()) << name << " with " << what;
  });
}

TEST(RandomMeshes, SameStateWhateverLanesGroupsAndThreads) {
  unsigned seed = 100;
  for (const Discretization cut : all_cuts()) expect_one_state(random_scene(cut, Law::neo_hookean, seed++), 30, name_of(cut));
}

/// Devices with one lane read other lists of contact than those with sixteen. A needle with edges, and bodies that touch.
TEST(ContactOnAllSplits, SameStateWhateverLanesGroupsAndThreads) {
  for (const char* name : {"needle", "stack"})
    expect_one_state(load_scene(test::source_dir() + "/scenes/" + name + ".json"), 200, name);
}

}  // namespace
}  // namespace pliant::physics
