// States that may leave a run as results: settled ones, moments that wait, and the look ahead at the end.
#include <gtest/gtest.h>

#include "backends/choice/backends.h"
#include "solver/scenes.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

TEST(Settled, ABatchThatIsMadeAgainHasToldNothing) {
  Simulation simulation(testing::thrown_cube(), open_backend("cpu"));
  EXPECT_TRUE(simulation.settled());
  simulation.advance(12);
  EXPECT_FALSE(simulation.settled());
  const double before = simulation.report().tools[0].max_force;
  ASSERT_GT(before, 50) << "the steps are too long, and the table throws the cube";
  EXPECT_FALSE(simulation.confirm());
  EXPECT_EQ(simulation.step(), 0);
  EXPECT_EQ(simulation.report().tools[0].max_force, 0);
  EXPECT_EQ(simulation.report().tools[0].touched, 0);
  EXPECT_EQ(simulation.report().inversions.batches, 0);
  do {
    simulation.advance(12 - simulation.step());
  } while (!simulation.confirm());
  EXPECT_EQ(simulation.step(), 12);
  EXPECT_LT(simulation.report().tools[0].max_force, before);
}

TEST(Settled, LookingAheadLeavesNoTrace) {
  Simulation looks(testing::thrown_cube(), open_backend("cpu")), goes(testing::thrown_cube(), open_backend("cpu"));
  looks.advance(12);
  while (!looks.confirm()) looks.advance(12 - looks.step());
  goes.advance(64);
  while (goes.step() < 76) goes.advance(76 - goes.step());
  const std::uint64_t there = looks.hash();
  const double force = looks.report().tools[0].max_force;
  EXPECT_TRUE(looks.confirm());
  EXPECT_EQ(looks.hash(), there);
  EXPECT_EQ(looks.report().tools[0].max_force, force);
  while (looks.step() < 76) looks.advance(76 - looks.step());
  EXPECT_EQ(looks.deep_hash(), goes.deep_hash());
}

/// Of a hybrid, whose shape matching depends on the step: the safety goes in the first 200 steps, when nothing is settled.
TEST(Settled, LookingAheadToAShorterStepLeavesNoTrace) {
  const Scene scene = load_scene(test::source_dir() + "/scenes/liver_follow.json");
  Simulation looks(scene, open_backend("cpu")), goes(scene, open_backend("cpu"));
  const double first = goes.dt();
  bool shorter = false;
  while (looks.step() < 200) {
    looks.advance(looks.next_batch(30));
    looks.confirm();
  }
  while (goes.step() < 200) {
    goes.advance(goes.next_batch(30));
    shorter = shorter || goes.dt() < 0.95 * first;
  }
  EXPECT_TRUE(shorter);
  EXPECT_EQ(goes.report().made_again, 0);
  EXPECT_EQ(looks.deep_hash(), goes.deep_hash());
}

TEST(Settled, AMomentIsLookedAtAndLeft) {
  Simulation simulation(testing::thrown_cube(), open_backend("cpu"));
  while (simulation.step() < 70) simulation.advance(70 - simulation.step());
  const Moment moment = simulation.moment();
  const std::uint64_t then = simulation.hash();
  const double time = simulation.time();
  const Vec3d force = simulation.report().tools[0].now.force;
  simulation.advance(20);
  const std::uint64_t deep = simulation.deep_hash();
  simulation.look_at(moment, [&] {
    EXPECT_EQ(simulation.hash(), then);
    EXPECT_EQ(simulation.time(), time);
    EXPECT_EQ(simulation.report().tools[0].now.force, force);
    (void)simulation.residual_forces(0);
  });
  EXPECT_EQ(simulation.deep_hash(), deep);
  EXPECT_THROW(simulation.look_at(moment, [] { throw 1; }), int);
  EXPECT_EQ(simulation.deep_hash(), deep);
}

}  // namespace
}  // namespace pliant
