// Every integrator, and viscous stress: the same bits on every backend, with a cut where it allows one, and nothing undefined
// read.
#include <gtest/gtest.h>

#include <set>

#include "solver/scenes.h"

namespace pliant {
namespace {

using testing::pressed_cube;

struct NamedScene {
  std::string name;
  Scene scene;
};

std::vector<NamedScene> runs() {
  std::vector<NamedScene> all;
  const std::string blade =
      R"("blades": [{"path": [[0, -0.08, 0.01, -0.1, -0.08, 0.01, 0.1], [0.04, 0.08, 0.01, -0.1, 0.08, 0.01, 0.1]]}],)";
  for (const Integrator integrator : all_integrators()) {
    const IntegratorInfo& info = integrator_info(integrator);
    const std::string word = std::string(R"("dt": 0.0005, "integrator": ")") + info.word + "\",";
    all.push_back({info.word, pressed_cube(0.01, word)});
    if (info.edits) all.push_back({std::string(info.word) + ", cut", pressed_cube(0.01, word + blade)});
    const std::size_t plain = all.size();
    for (std::size_t i = 0; i < plain && info.keeps_increment; ++i) {
      if (all[i].scene.integrator != integrator) continue;
      all.push_back(all[i]);
      all.back().name += ", viscous";
      all.back().scene.bodies[0].material.viscosity = 1;
      all.back().scene.bodies[0].material.bulk_viscosity = 2;
    }
  }
  for (NamedScene& run : all) run.scene.bodies[0].material.damping = 100;  // so that explicit Euler is stable
  return all;
}

TEST(EveryIntegrator, GivesTheSameBitsOnEveryBackend) {
  std::set<std::uint64_t> seen;
  for (const NamedScene& run : runs()) {
    Simulation cpu(run.scene, open_backend("cpu"));
    const std::size_t nodes = cpu.model().bodies[0].slot.size();
    ASSERT_EQ(cpu.advance(150), 150) << run.name;
    ASSERT_FALSE(cpu.divergence()) << run.name;
    EXPECT_EQ(cpu.model().bodies[0].slot.size() > nodes, !run.scene.blades.empty()) << run.name << " is cut";
    EXPECT_TRUE(seen.insert(cpu.hash()).second) << run.name << " is no other run";
    if (!testing::has_opencl()) continue;
    Simulation device(run.scene, open_backend("opencl:0"));
    device.advance(150);
    EXPECT_EQ(device.hash(), cpu.hash()) << run.name;
    EXPECT_EQ(device.deep_hash(), cpu.deep_hash()) << run.name;
  }
}

TEST(EveryIntegrator, ReadsNothingThatWasNotWritten) {
  for (const NamedScene& run : runs()) {
    Simulation checked(run.scene, open_backend("cpu:check"));
    EXPECT_EQ(checked.advance(20), 20) << run.name;
  }
}

}  // namespace
}  // namespace pliant
