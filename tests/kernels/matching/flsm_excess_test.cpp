// flsm_excess: kernel and twin give the same bits; in double, what the springs move an interface node less what shape matching
// would.
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmExcess : public TwinTest {};

TEST_F(FlsmExcess, TwinGivesTheSameBits) {
  std::uint32_t seed = 6200;
  for (const int substeps : {1, 3}) {
    for (const std::size_t count : {16U, 80U, 1040U}) {
      for (const Data data : all_data) {
        FlsmData d = random_flsm(count, data, seed++);
        d.substeps = substeps;
        expect_same_bits(flsm_excess_case(d), name_of(data));
      }
    }
  }
}

std::size_t slot_of(const FlsmData& d, std::size_t i) {
  return static_cast<std::size_t>(d.slot[i + static_cast<std::size_t>(d.region_base)]);
}

/// The pull beta (g - x) over the time H of a step of shape matching moves the node by H^2 / m of it.
TEST(FlsmExcessOracle, IsTheIncrementOfTheSpringsLessThatOfShapeMatching) {
  for (const int substeps : {1, 3}) {
    FlsmData d = random_flsm(96, Data::large, 40 + static_cast<std::uint32_t>(substeps));
    d.exact = true;
    d.substeps = substeps;
    d.step_params[0] = 2e-3;
    const Reals excess = run_in_double(flsm_excess_case(d), "flsm_excess");
    const double time = 2e-3 * substeps;
    std::vector<bool> written(excess.size() / 4, false);
    for (std::size_t i = 0; i < d.count; ++i) {
      const std::size_t slot = slot_of(d, i);
      const Vector3d way = vector_at(d.goals, 8 * i) - (vector_at(d.node_u, 4 * slot) - vector_at(d.reference, 0));
      const Vector3d springs = time * time * d.node_u[4 * slot + 3] * (d.beta[i] * way);
      const Vector3d matching = d.alpha[static_cast<std::size_t>(d.batch)] * way;
      expect_near(springs - matching, excess, 4 * slot, 1e-15, "slot " + std::to_string(slot));
      EXPECT_GT((springs - matching).norm(), 1e-9);
      EXPECT_EQ(excess[4 * slot + 3], 0);
      written[slot] = true;
    }
    for (std::size_t k = 0; k < excess.size(); ++k) {
      if (!written[k / 4]) {
        EXPECT_EQ(excess[k], d.excess[k]) << "slot " << k / 4 << " is not of the interface";
      }
    }
  }
}

/// beta = alpha m / H^2: exactly nothing where these are powers of two, otherwise to rounding.
TEST(FlsmExcessOracle, IsNothingWhereTheSpringsAreThoseOfShapeMatching) {
  for (const int substeps : {1, 2, 3}) {
    for (const bool powers_of_two : {true, false}) {
      if (powers_of_two && substeps == 3) continue;
      FlsmData d = random_flsm(96, Data::large, 44);
      d.exact = !powers_of_two;
      d.substeps = substeps;
      d.step_params[0] = powers_of_two ? std::ldexp(1.0, -10) : 1e-3;
      const double time = d.step_params[0] * substeps, alpha = powers_of_two ? 0.5 : 0.7;
      d.alpha = {0.1, alpha, 0.9};
      for (std::size_t i = 0; i < d.count; ++i) {
        double& inverse_mass = d.node_u[4 * slot_of(d, i) + 3];
        inverse_mass = powers_of_two ? std::ldexp(1.0, static_cast<int>(i % 12)) : 10 + static_cast<double>(i);
        d.beta[i] = alpha / (inverse_mass * time * time);
      }
      const Reals excess = run_in_twin(flsm_excess_case(d), "flsm_excess", !powers_of_two);
      for (std::size_t i = 0; i < d.count; ++i) {
        expect_near(Vector3d::Zero(), excess, 4 * slot_of(d, i), powers_of_two ? 0 : 1e-17, "node " + std::to_string(i));
      }
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
