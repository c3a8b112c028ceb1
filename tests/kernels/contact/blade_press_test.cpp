// blade_press: kernel and twin give the same bits; the force takes the gap back up to the limit, and then the front advances.
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class BladePress : public TwinTest {};

constexpr int kBlades = 2;

KernelCase press_case(std::size_t samples, Data data, std::uint32_t seed) {
  Random random(seed);
  const std::size_t nodes = 40;
  constexpr int rows = test_step + 2;
  Reals numbers = random.reals(12 * samples, data, 0.1);
  for (std::size_t i = 0; i < samples; ++i) {
    numbers[12 * i + 6] = random.chance(0.2) ? -1 : random.draw(data, 1);
    numbers[12 * i + 7] = random.chance(0.5) ? 0 : random.uniform(0, 1);
    numbers[12 * i + 8] = random.uniform(0, 1);
    numbers[12 * i + 9] = random.integer(0, kBlades - 1);
  }
  KernelCase test("blade_press", {}, Shape::items, samples);
  test.reals("node_u", random.reals(4 * nodes, data, 0.1))
      .reals("node_w", random.reals(4 * nodes, data, 0.01))
      .ints("blade_node", random.ints(8 * samples, 0, static_cast<int>(nodes) - 1))
      .reals("blade_weight", random.reals(8 * samples, Data::large, 1))
      .reals("blade_share", random.reals(8 * samples, data, 1))
      .reals("blade_data", numbers)
      .reals("blade_pose", random.reals(rows * kBlades * 6, data, 0.1))
      .reals("blade_front", random.reals(2 * samples, data, 0.01))
      .reals("blade_force", Reals(rows * samples * 4))
      .reals("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0})
      .integer(static_cast<std::int32_t>(samples))
      .integer(kBlades)
      .step();
  return test;
}

TEST_F(BladePress, TwinGivesTheSameBits) {
  std::uint32_t seed = 900;
  for (const std::size_t samples : {1U, 37U, 300U}) {
    for (const Data data : all_data) expect_same_bits(press_case(samples, data, seed++), name_of(data));
  }
}

/// One sample whose front point is node 0, at rest at the origin, while the edge is at (0, gap, 0) and n is y.
struct Pressed {
  double force = 0, front = 0, steps = 0, side = 0;
};
Pressed pressed(double gap, double limit, double friction) {
  const double h = 1e-2, inverse_mass = 4, decay = 1;
  KernelCase test("blade_press", {}, Shape::items, 1);
  test.exact("node_u", {0, 0, 0, inverse_mass}).exact("node_w", {1e-3, 0, 0, decay}).ints("blade_node", Ints(8, 0));
  test.exact("blade_weight", {1, 0, 0, 0, 0, 0, 0, 0}).exact("blade_share", {1, 0, 0, 0, 0, 0, 0, 0});
  test.exact("blade_data", {0, 0, 0, 0, 1, 0, limit, friction, 0.5, 0, 0, 0});
  Reals pose;
  for (int row = 0; row < test_step + 2; ++row) pose.insert(pose.end(), {-1, gap, 0, 2, 0, 0});
  test.exact("blade_pose", pose).exact("blade_front", {0.25, 7}).exact("blade_force", Reals((test_step + 1) * 4));
  test.exact("step_params", {h, 0, 0, 0, 0, 0, 0, 0}).integer(1).integer(1).step();
  const Reals force = run_in_double(test, "blade_force"), front = run_in_double(test, "blade_front");
  EXPECT_EQ(force[4 * test_step + 3], force[4 * test_step + 1]);
  return {force[4 * test_step + 1], front[0], front[1], force[4 * test_step]};
}

TEST(BladePressOracle, TheGapIsTakenBackUpToTheLimit) {
  const double w = 4 * 1e-4;  // b / m = h^2 (1 + decay) / 2 / m
  const Pressed apart = pressed(0.2, 1e9, 0), holds = pressed(0.35, 1e9, 0), gives = pressed(0.35, 100, 0);
  EXPECT_EQ(apart.force, 0);
  EXPECT_EQ(apart.steps, 7);
  EXPECT_NEAR(holds.force, 0.1 / w, 1e-9);
  EXPECT_EQ(holds.front, 0.25);
  EXPECT_EQ(holds.steps, 8);
  EXPECT_EQ(gives.force, 100);
  EXPECT_NEAR(gives.front, 0.25 + 0.1 - 100 * w, 1e-12);
}

TEST(BladePressOracle, FrictionOpposesTheSlipAndHasALimit) {
  EXPECT_EQ(pressed(0.35, 100, 0).side, 0);
  EXPECT_NEAR(pressed(0.35, 100, 0.01).side, -1, 1e-12);          // mu f
  EXPECT_NEAR(pressed(0.35, 100, 1).side, -1e-3 / (4e-4), 1e-9);  // what stops the slip
}

}  // namespace
}  // namespace pliant::kernel_test
