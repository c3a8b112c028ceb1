// Blades that cut by force: a scene and a blade that are turned together, a run that is resumed, a blade that comes again.
#include "physics/harness.h"
#include "physics/turned_tetrahedra.h"
#include "support/error_of.h"

namespace pliant::physics {
namespace {

class ScalpelRuns : public OnBackend {};

/// A block of tetrahedra, held at its bottom, cut by a blade from above that is drawn along a little; `turn` is applied to all.
Scene turned_block(const Matrix3d& turn) {
  Scene scene = turned_tetrahedra(turn, {6, 5, 6}, 4e4);
  Blade blade;
  blade.name = "scalpel";
  blade.cuts = BladeCuts::by_force;
  blade.edge = 5e-4;
  const auto row = [&](double time, double y) {
    const Vector3d a = turn * Vector3d(0.0233, y, -0.003), b = turn * Vector3d(0.0241, y, 0.064);
    return std::array<double, 7>{time, a[0], a[1], a[2], b[0], b[1], b[2]};
  };
  blade.path = {row(0, 0.051), row(0.6, 0.021)};
  scene.blades = {blade};
  return scene;
}

struct Outcome {
  std::vector<double> force;        ///< on the blade along the turned y, every 32 steps [N]
  std::vector<std::int64_t> edges;  ///< cut by then
  double first = 0;                 ///< time at which tissue gave way [s]
};

Outcome outcome(const Matrix3d& turn, const char* backend) {
  const Scene scene = turned_block(turn);
  auto sim = simulate(scene, backend, {.dt = 2e-4});
  Outcome out;
  for (int k = 0; k < 90; ++k) {
    sim->advance(32);
    out.force.push_back((turn.transpose() * eigen(sim->press().last_force(0).force))[1]);
    std::int64_t edges = 0;
    for (const CutRecord& cut : sim->state().cuts) edges += static_cast<std::int64_t>(cut.edges.size());
    out.edges.push_back(edges);
  }
  out.first = sim->state().pressed.at("scalpel").first;
  return out;
}

/// Turning body and blade together changes no decision.
TEST_P(ScalpelRuns, DoNotDependOnDirections) {
  const Outcome one = outcome(Matrix3d::Identity(), GetParam());
  const Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Outcome other = outcome(turn, GetParam());
  EXPECT_EQ(one.first, other.first);
  EXPECT_GT(one.first, 0);
  EXPECT_GT(one.edges.back(), 20);
  const double most = *std::max_element(one.force.begin(), one.force.end());
  double worst = 0;
  std::int64_t edges = 0;
  for (std::size_t k = 0; k < one.force.size(); ++k) {
    worst = std::max(worst, std::abs(one.force[k] - other.force[k]) / most);
    edges = std::max(edges, std::abs(one.edges[k] - other.edges[k]));
  }
  check("force of a turned blade", worst, bound(0.02, 1e-6));
  check("edges that only one of them cuts", static_cast<double>(edges), bound(8, 0));
}

/// A run that goes on from a checkpoint, between two updates and with tissue that gives way, has the bits of the whole run.
TEST_P(ScalpelRuns, GoOnFromACheckpoint) {
  const Scene scene = turned_block(Matrix3d::Identity());
  auto whole = simulate(scene, GetParam());
  auto begun = simulate(scene, GetParam());
  while (whole->state().pressed.empty() || whole->state().pressed.at("scalpel").first < 0) whole->advance(64);
  whole->advance(3);
  begun->advance(whole->step());
  auto resumed = simulate(scene, GetParam());
  resumed->restore(begun->snapshot());
  EXPECT_EQ(resumed->deep_hash(), whole->deep_hash());
  whole->advance(500);
  resumed->advance(500);
  EXPECT_EQ(resumed->deep_hash(), whole->deep_hash());
  EXPECT_GT(whole->state().cuts.size(), 1U);
}

/// A blade that is drawn out of its cut and comes again meets tissue where the cut ends.
TEST_P(ScalpelRuns, ABladeComesBackIntoItsCut) {
  Scene scene = turned_block(Matrix3d::Identity());
  auto path = scene.blades[0].path;
  for (const std::size_t from : {0U, 1U}) {
    path.push_back(path[from]);
    path.back()[0] = from == 0 ? 0.9 : 1.5;
  }
  path.push_back(path[1]);
  path.back()[0] = 1.8;
  scene.blades[0].path = path;
  auto sim = simulate(scene, GetParam());
  double depth = 0, again = 0;
  while (sim->time() < 1.8 && sim->advance(16) > 0) {
    const PressedBlade& blade = sim->state().pressed.at("scalpel");
    const double force = sim->press().last_force(0).force[1];
    if (sim->time() < 0.6) depth = blade.fracture;
    if (sim->time() > 0.85 && sim->time() < 1.3) again = std::max(again, std::abs(force));
    if (sim->time() > 0.65) {
      EXPECT_LT(blade.fracture, 1.25 * depth) << sim->time();
    }
  }
  EXPECT_GT(depth, 0);
  check("force on the way through its own cut [N]", again, 0.05);
}

TEST(ScalpelMistakes, AnEdgeIsNotWiderThanTheBody) {
  Scene scene = turned_block(Matrix3d::Identity());
  scene.blades[0].edge = 0.04;
  EXPECT_NE(test::error_of([&] {
              static_cast<void>(simulate(scene, "cpu"));
            }).find("blade 'scalpel': got an \"edge\" of radius 0.04 m; allowed is up to half of the thickness"),
            std::string::npos);
}

PLIANT_ON_BACKENDS(ScalpelRuns);

}  // namespace
}  // namespace pliant::physics
