// Golden hashes: the bits of every shipped scene, the same for every compiler, flag, backend and machine. A change that is
// meant to alter results writes tests/golden/hashes.json again (PLIANT_WRITE_GOLDEN=1, backend cpu) and says in its message and
// in CHANGELOG.md under "Bits" why.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "program/hash.h"
#include "simulation/edits/edited_bodies.h"
#include "solver/scenes.h"

namespace pliant::golden_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::int64_t kSteps = 200;
const std::string kFile = test::source_dir() + "/tests/golden/hashes.json";

/// Scenes with steps: what is static has none.
std::vector<std::string> scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(test::source_dir() + "/scenes")) {
    const std::string name = entry.path().stem();
    if (entry.path().extension() != ".json" || name == "schema" || load_scene(entry.path()).solver.enabled) continue;
    names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A run that remembers what has happened in it.
class SceneRun {
 public:
  SceneRun(const std::string& scene, const std::string& backend)
      : simulation_(load_scene(test::source_dir() + "/scenes/" + scene + ".json"), open_backend(backend)) {}

  void advance(std::int64_t to) {
    while (simulation_.step() < to) {
      if (simulation_.advance(simulation_.next_batch(to - simulation_.step())) == 0) return;
      for (const ToolHistory& tool : simulation_.report().tools) {
        if (tool.touched > 0) touched_.insert(static_cast<std::size_t>(&tool - simulation_.report().tools.data()));
      }
      met_ = met_ || simulation_.report().tissue.points > 0;
    }
  }

  /// Whether what makes this scene worth recording has happened: it was cut, tools touched it, tissue touched tissue,
  /// parameters changed, joins broke.
  [[nodiscard]] bool eventful() const {
    const Scene& scene = simulation_.scene();
    const bool edited = scene.blades.empty() || simulation_.topology_version() > 0;
    const bool torn = !EditedBodies::tears(scene) || simulation_.topology_version() > 0;
    const bool changed = scene.changes.empty() || simulation_.state().changed.done > 0;
    const auto breaks = [](const Join& j) { return j.break_stretch > 0 || j.break_force > 0; };
    const bool joined = std::none_of(scene.joins.begin(), scene.joins.end(), breaks) || !simulation_.state().broken.empty();
    return edited && torn && changed && joined && touched_.size() == scene.tools.size() && (!scene.contact || met_);
  }

  /// Past 200 steps and the first of each event, on a multiple of 100 steps.
  void advance_to_events() {
    advance(kSteps);
    while (!eventful() && !simulation_.divergence() && simulation_.time() < simulation_.scene().duration)
      advance(simulation_.step() + kSteps / 2);
  }

  [[nodiscard]] Json result() const {
    return {
        {"steps", simulation_.step()}, {"state", hash_text(simulation_.hash())}, {"deep", hash_text(simulation_.deep_hash())}};
  }

 private:
  Simulation simulation_;
  std::set<std::size_t> touched_;  ///< numbers of tools
  bool met_ = false;
};

/// The entries of all scenes, from runs on the CPU.
Json recorded() {
  Json golden;
  for (const std::string& scene : scenes()) {
    SceneRun run(scene, "cpu");
    run.advance_to_events();
    golden[scene] = run.result();
  }
  return golden;
}

class Golden : public ::testing::TestWithParam<const char*> {};

TEST_P(Golden, ScenesGiveTheRecordedBits) {
  const std::string backend = GetParam();
  if (backend == "opencl:0" && !testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  if (backend == "cpu" && std::getenv("PLIANT_WRITE_GOLDEN") != nullptr) std::ofstream(kFile) << recorded().dump(2) << '\n';
  const Json golden = Json::parse(std::ifstream(kFile));
  for (const std::string& scene : scenes()) {
    SCOPED_TRACE("scenes/" + scene + ".json on " + backend);
    ASSERT_TRUE(golden.contains(scene)) << "it has no entry in tests/golden/hashes.json";
    SceneRun run(scene, backend);
    run.advance(std::max(kSteps, golden.at(scene).at("steps").get<std::int64_t>()));  // one that diverges has gone back
    EXPECT_EQ(run.result(), golden.at(scene));
    EXPECT_TRUE(run.eventful()) << "it is recorded before its first cut or touch";
  }
}

TEST(GoldenFile, HoldsShippedScenesOnly) {
  const std::vector<std::string> shipped = scenes();
  const Json golden = Json::parse(std::ifstream(kFile));
  EXPECT_EQ(golden.size(), shipped.size());
  for (const auto& entry : golden.items())
    EXPECT_TRUE(std::binary_search(shipped.begin(), shipped.end(), entry.key())) << entry.key();
}

std::string label(const ::testing::TestParamInfo<const char*>& backend) {
  return std::string(backend.param) == "cpu" ? "cpu" : "opencl";
}
INSTANTIATE_TEST_SUITE_P(On, Golden, ::testing::Values("cpu", "opencl:0"), label);

}  // namespace
}  // namespace pliant::golden_test
