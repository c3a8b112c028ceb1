// The force on a blade that cuts by force, as World gives it.
#include <gtest/gtest.h>

#include "pliant/error.h"
#include "pliant/world.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

TEST(BladeForce, IsTracedStepByStep) {
  WorldOptions options;
  options.backend = "cpu";
  World world = World::open(test::source_dir() + "/scenes/incise.json", options);
  EXPECT_TRUE(world.force_trace("scalpel").empty());
  EXPECT_THROW(static_cast<void>(world.force_trace("knife")), Error);
  world.step(150);
  const std::vector<ForceSample> trace = world.force_trace("scalpel");
  ASSERT_GT(trace.size(), 50U);
  EXPECT_GT(trace.back().force[1], 1);
  for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_EQ(trace[i].step, trace[i - 1].step + 1);
}

}  // namespace
}  // namespace pliant
