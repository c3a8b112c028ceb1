// Prepared cuts: what is compiled beforehand is what the first cut needs.
#include <gtest/gtest.h>

#include <set>

#include "backends/choice/backends.h"
#include "schedule/build_program.h"
#include "simulation/edits/edited_bodies.h"
#include "simulation/simulation.h"
#include "solver/scenes.h"

namespace pliant {
namespace {

using Kernel = std::pair<std::string, std::vector<std::pair<std::string, int>>>;

std::set<Kernel> kernels_of(const Program& program) {
  std::set<Kernel> kernels;
  for (const Pass& pass : program.step) kernels.insert({pass.kernel, pass.defines});
  return kernels;
}

class Trial : public ::testing::TestWithParam<const char*> {};

TEST_P(Trial, HasEveryKernelOfTheFirstCut) {
  Scene scene = load_scene(test::source_dir() + "/scenes/" + GetParam() + ".json");
  scene.cuttable = true;
  Blade blade;  // straight down, near the middle
  blade.name = "scalpel";
  blade.path = {{0, 0.012, 0.09, -0.09, 0.012, 0.09, 0.09}, {0.01, 0.022, 0.01, -0.09, 0.022, 0.01, 0.09}};
  Scene cut = scene;
  cut.blades = {blade};
  Simulation s(cut, open_backend("cpu"));
  while (s.topology_version() == 0 && s.time() < 0.1) s.advance(1);
  ASSERT_GT(s.topology_version(), 0) << "nothing was cut";
  std::set<Kernel> known = kernels_of(build_program(EditedBodies(scene).trial_model(), {scene.integrator, 64}));
  for (const Kernel& kernel : kernels_of(s.program())) {
    EXPECT_TRUE(known.count(kernel) > 0) << kernel.first;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Trial, ::testing::Values("liver", "liver_hybrid"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace pliant
