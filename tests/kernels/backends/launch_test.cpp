// How passes are split into work-items and work-groups.
#include "backends/interface/launch.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

Pass bricks(int count) {
  Pass pass;
  pass.shape = Shape::bricks;
  pass.count = count;
  return pass;
}

LaunchRules gpu() {
  LaunchRules rules;
  rules.lanes = 1;
  rules.largest = 256;
  return rules;
}

TEST(PlanLaunches, FourBricksAreAGroupOnAGpu) {
  for (const int count : {1, 3, 4, 9, 64, 4099}) {
    std::size_t next = 0;
    for (const Launch& launch : plan_launches(bricks(count), gpu())) {
      EXPECT_EQ(launch.offset, next) << count;
      EXPECT_EQ(launch.global % launch.local, 0U) << count;
      EXPECT_EQ(launch.local % 16, 0U) << count;  // a row stays in one group
      EXPECT_TRUE(launch.local == 64 || launch.global < 64) << count;
      next = launch.offset + launch.global;
    }
    EXPECT_EQ(next, 16U * static_cast<unsigned>(count));
  }
}

TEST(PlanLaunches, ABrickIsAGroupOnAProcessorAndWhereGroupsAreSmall) {
  LaunchRules processor = gpu(), small = gpu();
  processor.cpu = true;
  small.largest = 32;
  for (const LaunchRules& rules : {processor, small}) {
    const std::vector<Launch> launches = plan_launches(bricks(9), rules);
    ASSERT_EQ(launches.size(), 1U);
    EXPECT_EQ(launches[0].global, 144U);
    EXPECT_EQ(launches[0].local, 16U);
  }
}

TEST(PlanLaunches, ATileIsAWorkItemWhateverTheLanes) {
  for (const int lanes : {1, 16}) {
    for (const bool cpu : {false, true}) {
      for (const int count : {1, 3, 64, 403, 4099}) {
        Pass pass;
        pass.shape = Shape::tiles;
        pass.count = count;
        LaunchRules rules = gpu();
        rules.lanes = lanes;
        rules.cpu = cpu;
        std::size_t next = 0;
        for (const Launch& launch : plan_launches(pass, rules)) {
          EXPECT_EQ(launch.offset, next) << count;
          EXPECT_EQ(launch.global % launch.local, 0U) << count;
          next = launch.offset + launch.global;
        }
        EXPECT_EQ(next, static_cast<std::size_t>(count));
      }
    }
  }
}

}  // namespace
}  // namespace pliant
