// Changes of the step and of the damping of dynamic relaxation while a run goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cutting/cut_scenes.h"
#include "solver/scenes.h"

namespace pliant {
namespace {

using namespace cut_test;

/// A body that flies through empty space, with half of its automatic step.
class HalvedStep : public ::testing::Test {
 protected:
  HalvedStep() : full(s.dt()) {
    Snapshot halved = s.snapshot();
    halved.state.clock.dt = 0.5 * full;  // the increments stay: twice the velocity
    s.restore(halved);
  }
  static Scene flying() {
    Body body = box_body("box", {0.03, 0.02, 0.02});
    body.velocity = {0.1, -0.05, 0.15};
    return scene_with(body);
  }
  Simulation s{flying(), open_backend("cpu:double")};
  double full;
};

TEST_F(HalvedStep, GrowsAgainAndTheVelocityStays) {
  EXPECT_EQ(s.dt(), 0.5 * full);
  const Vec3d velocity{0.2, -0.1, 0.3};
  const auto expect_velocity = [&] {
    for (const Vec3d& v : s.velocities(0)) {
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(v[c], velocity[c], 1e-10);
    }
  };
  expect_velocity();
  const double x = s.displacements(0)[0][0];
  s.advance(300);
  EXPECT_GT(s.dt(), 0.9 * full) << "nothing keeps the step small";
  expect_velocity();
  EXPECT_NEAR(s.displacements(0)[0][0] - x, velocity[0] * s.time(), 1e-10);
}

/// Loads come on after the start: the step is looked at after 64 and 128 steps, then every 256.
TEST_F(HalvedStep, IsLookedAtAfter64Steps) {
  s.advance(64);
  EXPECT_EQ(s.dt(), 0.5 * full);
  s.advance(1);
  EXPECT_GT(s.dt(), 0.9 * full);
}

/// Every 32 steps the damping becomes twice the root of the Rayleigh quotient of what has moved since the last change.
TEST(Relaxation, DampsWhatHasMovedSinceTheLastChange) {
  const Scene scene = testing::pressed_cube(0.01, R"("relaxation": {"tolerance": 1e-9, "max_steps": 1000},)");
  Simulation s(scene, open_backend("cpu:double"));
  const Model& model = s.model();
  std::vector<bool> free(3 * model.mass.size(), true);
  for (const Constraint& c : model.constraints) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((c.axes >> axis & 1) != 0) free[3 * static_cast<std::size_t>(c.slot) + axis] = false;
    }
  }
  const double material = *std::max_element(model.damping.begin(), model.damping.end());
  s.advance(32);
  for (int change = 0; change < 4; ++change) {
    const RelaxationState before = s.state().relaxation;
    s.advance(32);
    const RelaxationState& now = s.state().relaxation;
    EXPECT_EQ(now.u, s.backend().read_reals(s.program().find("node_u")));
    double stiffness = 0, inertia = 0;
    for (std::size_t slot = 0; slot < model.mass.size(); ++slot) {
      for (std::size_t c = 0; c < 3 && model.mass[slot] > 0; ++c) {
        if (!free[3 * slot + c]) continue;
        const double du = now.u[4 * slot + c] - before.u[4 * slot + c];
        stiffness -= du * (now.force[4 * slot + c] - before.force[4 * slot + c]);
        inertia += model.mass[slot] * du * du;
      }
    }
    ASSERT_GT(stiffness, 0);
    EXPECT_NEAR(now.damping, std::max(0.0, 2 * std::sqrt(stiffness / inertia) - material), 1e-9 * now.damping) << change;
  }
}

}  // namespace
}  // namespace pliant
