// Resumed equals uninterrupted, for every shipped scene: automatic and fixed step, checkpoints before, between and after every
// edit and every change of the step, on both backends, judged by the deep hash.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "io/save.h"
#include "pliant/error.h"
#include "solver/scenes.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// With PLIANT_RESUME_MATRIX=full more steps and events, and fixed steps on both backends.
bool full() { return std::getenv("PLIANT_RESUME_MATRIX") != nullptr; }
std::int64_t most_steps() { return full() ? 700 : 300; }  ///< of a scene in which nothing but the body changes
std::size_t most_events() { return full() ? 8 : 2; }
constexpr std::int64_t kMostStepsEdited = 6000;  ///< of one that is cut, tears or follows a tool

struct Case {
  std::string scene, backend;
  bool automatic = true;
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.scene << " " << c.backend; }
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const auto& entry : fs::directory_iterator(test::source_dir() + "/scenes")) {
    const std::string name = entry.path().stem();
    if (entry.path().extension() != ".json" || name == "schema") continue;
    if (load_scene(entry.path()).solver.enabled) continue;  // static: there are no steps
    for (const char* backend : {"cpu", "opencl:0"}) {
      for (const bool automatic : {true, false}) {
        if (automatic || backend == std::string("cpu") || full()) cases.push_back({name, backend, automatic});
      }
    }
  }
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) {
    return std::tie(a.scene, a.backend, a.automatic) < std::tie(b.scene, b.backend, b.automatic);
  });
  return cases;
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  std::string name = info.param.scene + (info.param.backend == "cpu" ? "_cpu" : "_opencl");
  name += info.param.automatic ? "_automatic" : "_fixed";
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

/// What an event changes.
auto signature(const Simulation& s) {
  return std::tuple(s.topology_version(), s.dt(), s.state().regions, s.state().limit.dt_backoff, s.state().cuts.size());
}

class ResumeMatrix : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (GetParam().backend == "opencl:0" && !testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
    scene_ = load_scene(fs::path(test::source_dir()) / "scenes" / (GetParam().scene + ".json"));
    for (const Body& b : scene_.bodies) {
      const fs::path& file = b.mesh.empty() ? b.surface : b.mesh;
      if (!fs::exists(file)) GTEST_SKIP() << "there is no " << file;
    }
    model_ = std::make_shared<const Model>(build_model(scene_));
    if (!GetParam().automatic && scene_.dt <= 0) scene_.dt = make()->dt();
  }
  std::unique_ptr<Simulation> make() const {
    return std::make_unique<Simulation>(scene_, model_, open_backend(GetParam().backend));
  }
  bool edited() const {
    return !scene_.blades.empty() || EditedBodies::tears(scene_) ||
           std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& b) { return !b.model.follow.empty(); });
  }

  /// Steps to take checkpoints at: around each event, between events, and off the grid of batches.
  std::set<std::int64_t> checkpoints(Simulation& probe, std::int64_t most) const {
    std::set<std::int64_t> steps{0, 1, 37};
    std::size_t events = 0;
    auto before = signature(probe);
    std::int64_t last_event = 0;
    while (probe.step() < most && events < most_events()) {
      const std::int64_t start = probe.step();
      const std::int64_t n = probe.advance(probe.next_batch(most - start));
      if (n == 0) break;
      const auto now = signature(probe);
      if (now == before) continue;
      ++events;
      before = now;
      steps.insert({start, probe.step(), probe.step() + 1});
      if (full()) steps.insert({(last_event + start) / 2, start + 1});
      last_event = probe.step();
    }
    const std::int64_t end = std::min(most, probe.step() + 100);
    if (end > probe.step()) probe.advance(end - probe.step());
    steps.insert(probe.step());
    steps.erase(steps.upper_bound(probe.step()), steps.end());
    return steps;
  }

  Scene scene_;
  std::shared_ptr<const Model> model_;
  test::TempFolder folder_;
};

TEST_P(ResumeMatrix, ResumedEqualsUninterrupted) {
  const auto probe = make();
  const std::set<std::int64_t> steps = checkpoints(*probe, edited() ? kMostStepsEdited : most_steps());
  // The same run with a checkpoint at each of these steps: taking one, or cutting a run into pieces, changes nothing.
  const auto whole = make();
  std::vector<fs::path> files;
  std::vector<std::int64_t> at;
  std::vector<std::uint64_t> deep;
  for (const std::int64_t step : steps) {
    if (step > whole->step()) whole->advance(step - whole->step());
    if (whole->step() != step) break;  // diverged or at equilibrium
    files.push_back(folder_.path() / (std::to_string(step) + ".pckpt"));
    write_checkpoint(files.back(), take_checkpoint(*whole));
    at.push_back(step);
    deep.push_back(whole->deep_hash());
  }
  if (probe->divergence()) whole->advance(1000);
  EXPECT_EQ(whole->divergence().has_value(), probe->divergence().has_value());
  ASSERT_EQ(whole->step(), probe->step());
  EXPECT_EQ(whole->deep_hash(), probe->deep_hash()) << "checkpoints on the way change the run";
  // A simulation that has just begun, and the one that was used for the checkpoint before: both go on alike, over three
  // checkpoints each and at last to the end.
  const auto used = make();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const bool fresh = i % 3 == 1;
    const auto own = fresh ? make() : nullptr;
    Simulation& resumed = fresh ? *own : *used;
    restore_checkpoint(resumed, read_checkpoint(files[i]), files[i]);
    EXPECT_EQ(resumed.deep_hash(), deep[i]) << "checkpoint of step " << at[i];
    const std::size_t last = i + 4 >= files.size() ? files.size() : i + 4;
    for (std::size_t k = i + 1; k < last; ++k) {
      resumed.advance(at[k] - resumed.step());
      ASSERT_EQ(resumed.step(), at[k]);
      ASSERT_EQ(resumed.deep_hash(), deep[k]) << "resumed at step " << at[i] << ", compared at step " << at[k];
      ASSERT_EQ(resumed.stable_dt(), resumed.state().limit.stable_dt);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ResumeMatrix, ::testing::ValuesIn(all_cases()), name_of);

}  // namespace
}  // namespace pliant
