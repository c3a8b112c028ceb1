// The shipped scenes with blades: what every one of their edits has to keep, and the same bits on both backends.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>

#include "backends/choice/backends.h"
#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "simulation/state/compare.h"
#include "solver/scenes.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using namespace cut_test;

constexpr const char* kBunny = "/usr/share/glmark2/models/bunny.obj";

class CutScene : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == "cut_bunny" && !std::filesystem::exists(kBunny)) GTEST_SKIP() << "no " << kBunny;
  }
  [[nodiscard]] static Scene scene() { return load_scene(test::source_dir() + "/scenes/" + GetParam() + ".json"); }
};
INSTANTIATE_TEST_SUITE_P(Cutting, CutScene, ::testing::Values("cut_liver", "cut_bunny", "cut_block_progressive", "slice_many"),
                         [](const auto& name) { return std::string(name.param); });

/// Each edge of the surface belongs to exactly two triangles, which pass it in opposite directions.
void expect_closed(const ModelSurface& surface) {
  std::map<std::array<std::int32_t, 2>, std::array<int, 2>> edges;
  for (const auto& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
    }
  }
  int open = 0;
  for (const auto& [edge, count] : edges) open += count[0] == 1 && count[1] == 1 ? 0 : 1;
  EXPECT_EQ(open, 0) << "of " << edges.size() << " edges";
}

double rest_volume(const ModelSurface& surface) {
  double six = 0;
  for (const auto& t : surface.triangles) {
    six += vec::dot(surface.rest[t[0]], vec::cross(surface.rest[t[1]], surface.rest[t[2]]));
  }
  return six / 6;
}

TEST_P(CutScene, EveryEditKeepsMassVolumeAndAClosedSurface) {
  Simulation s(scene(), open_backend("cpu"));
  const double mass = mass_of(s), volume = rest_volume(s.model().surface), bound = s.model().element_bound;
  double end = 0;
  for (const Blade& b : s.scene().blades) end = std::max(end, b.path.back()[0]);
  std::int64_t seen = 0;
  double gone = 0;  // largest share of the volume
  while (s.time() < end + 0.03 && !HasFailure()) {
    s.advance(s.next_batch(1000));
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    if (s.topology_version() == seen) continue;
    seen = s.topology_version();
    EXPECT_NEAR(mass_of(s), mass, 1e-6 * mass);
    const double now = rest_volume(s.model().surface);
    EXPECT_NEAR(now, volume, 1e-3 * volume);
    gone = std::max(gone, std::abs(now - volume) / volume);
    expect_closed(s.model().surface);
    EXPECT_EQ(s.model().element_bound, bound) << "the stable step";
    const ModelSurface& surface = s.model().surface;
    EXPECT_EQ(surface.triangle_cut.size(), surface.triangles.size());
    for (const std::int32_t n : surface.nodes.back()) EXPECT_LT(n, s.model().slots);
  }
  EXPECT_GE(seen, 3) << "edits";
  std::printf("%s: %lld edits, %d pieces, volume to %.1e\n", GetParam(), static_cast<long long>(seen),
              s.cut_topology(0)->pieces(), gone);
}

TEST_P(CutScene, BothBackendsAgreeAcrossCuts) {
  if (!testing::has_opencl()) GTEST_SKIP() << "no OpenCL device";
  Simulation a(scene(), open_backend("cpu")), b(scene(), open_backend("opencl:0"));
  while (a.topology_version() == 0 && a.time() < a.scene().duration) a.advance(a.next_batch(1000));
  b.advance(a.step());
  ASSERT_EQ(a.hash(), b.hash());
  const std::int64_t before = a.topology_version();
  CompareOptions options;
  options.steps = 150;
  options.every_pass = false;
  const ComparisonResult result = compare(a, b, options);
  EXPECT_TRUE(result.identical) << (result.first_difference ? result.first_difference->message() : "");
  EXPECT_GT(a.topology_version(), before);
  EXPECT_EQ(a.topology_version(), b.topology_version());
}

}  // namespace
}  // namespace pliant
