// flsm_interface: kernel and twin give the same bits; in double, beta (g - x) with the goal held or extrapolated.
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmInterface : public TwinTest {};

TEST_F(FlsmInterface, TwinGivesTheSameBits) {
  std::uint32_t seed = 4000;
  for (const int extrapolated : {0, 1}) {
    for (const std::size_t count : {16U, 80U, 1040U}) {
      for (const Data data : all_data) {
        expect_same_bits(flsm_interface_case(random_flsm(count, data, seed++), extrapolated), name_of(data));
      }
    }
  }
}

/// Phase k of n substeps: the goal has moved on by k / n of what it moved in the step of shape matching before.
TEST(FlsmInterfaceOracle, PullsToTheGoalOfItsPhase) {
  for (const int substeps : {1, 2, 5}) {
    for (const int begun : {0, 3, 11}) {  // steps before the batch
      for (const int extrapolated : {0, 1}) {
        FlsmData d = random_flsm(48, Data::large, 17);
        d.exact = true;
        d.substeps = substeps;
        d.step_params[6] = begun;
        const Reals load = run_in_double(flsm_interface_case(d, extrapolated), "node_load");
        const double phase = extrapolated != 0 ? static_cast<double>((begun + test_step) % substeps) / substeps : 0;
        Reals expected = d.node_load;
        for (std::size_t i = 0; i < d.count; ++i) {
          const auto slot = static_cast<std::size_t>(d.slot[i + static_cast<std::size_t>(d.region_base)]);
          const Vector3d now = vector_at(d.goals, 8 * i), before = vector_at(d.goals, 8 * i + 4);
          const Vector3d goal = now + phase * (now - before);
          put(expected, 4 * slot,
              vector_at(d.node_load, 4 * slot) +
                  d.beta[i] * (goal - (vector_at(d.node_u, 4 * slot) - vector_at(d.reference, 0))));
        }
        for (std::size_t slot = 0; slot < expected.size() / 4; ++slot) {
          expect_near(vector_at(expected, 4 * slot), load, 4 * slot, 1e-14, "slot " + std::to_string(slot));
        }
      }
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
