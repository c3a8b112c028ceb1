// blade_apply: kernel and twin give the same bits; nodes get the weighted sum of the forces of their samples.
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class BladeApply : public TwinTest {};

KernelCase apply_case(std::size_t samples, Data data, std::uint32_t seed) {
  Random random(seed);
  const std::size_t nodes = 8 * samples, slots = nodes + 5;
  Ints slot = random.distinct(nodes, slots), first{0};
  for (std::size_t i = 0; i < nodes; ++i) {
    if (random.chance(0.3)) slot[i] = -1;
    first.push_back(std::min(first.back() + random.integer(0, 2), static_cast<std::int32_t>(nodes)));
  }
  KernelCase test("blade_apply", {}, Shape::items, nodes);
  test.reals("node_u", random.reals(4 * slots, data, 0.1))
      .reals("node_w", random.reals(4 * slots, data, 0.01))
      .ints("blade_slot", slot)
      .ints("blade_free", random.ints(nodes, 0, 7))
      .ints("blade_first", first)
      .ints("blade_entry", random.ints(nodes, 0, static_cast<int>(nodes) - 1))
      .reals("blade_weight", random.reals(nodes, Data::large, 1))
      .reals("blade_force", random.reals((test_step + 1) * samples * 4, data, 1))
      .reals("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0})
      .integer(static_cast<std::int32_t>(samples))
      .step();
  return test;
}

TEST_F(BladeApply, TwinGivesTheSameBits) {
  std::uint32_t seed = 950;
  for (const std::size_t samples : {1U, 13U, 100U}) {
    for (const Data data : all_data) expect_same_bits(apply_case(samples, data, seed++), name_of(data));
  }
}

TEST(BladeApplyOracle, MovesFreeComponentsByTheWeightedForces) {
  const std::int32_t samples = 2;
  KernelCase test("blade_apply", {}, Shape::items, 2);
  test.exact("node_u", {0, 0, 0, 9, 1, 2, 3, 4}).exact("node_w", {0, 0, 0, 1, 1, 1, 1, 1}).ints("blade_slot", {1, -1});
  test.ints("blade_free", {1 + 2, 7}).ints("blade_first", {0, 2, 2}).ints("blade_entry", {3, 8});
  Reals weight(16), force(std::size_t{4} * samples * (test_step + 1));
  weight[3] = 0.25;
  weight[8] = 0.5;
  const std::size_t at = std::size_t{4} * samples * test_step;
  force[at] = 8, force[at + 1] = 4, force[at + 2] = 2;
  force[at + 4] = 2, force[at + 5] = 6, force[at + 6] = 2;
  test.exact("blade_weight", weight).exact("blade_force", force).exact("step_params", {0.5, 0, 0, 0, 0, 0, 0, 0});
  test.integer(samples).step();
  const double bm = 0.25 * 4;  // h^2 (1 + 1) / 2 / m
  EXPECT_EQ(run_in_double(test, "node_u"), (Reals{0, 0, 0, 9, 1 + 3 * bm, 2 + 4 * bm, 3, 4}));
  EXPECT_EQ(run_in_double(test, "node_w"), (Reals{0, 0, 0, 1, 1 + 3 * bm, 1 + 4 * bm, 1, 1}));
}

}  // namespace
}  // namespace pliant::kernel_test
