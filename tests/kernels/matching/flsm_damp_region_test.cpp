// flsm_damp_region: kernel and twin give the same bits; in double, the rigid motion nearest to the increments of a region's
// nodes by least squares.
#include <algorithm>

#include "kernels/matching/flsm_damp_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmDampRegion : public FlsmTwinTest {};

TEST_F(FlsmDampRegion, TwinGivesTheSameBits) { compare(flsm_damp_region_case, 5200); }

std::vector<Matrix3d> random_turns(Random& random, const FlsmLattice& lattice) {
  std::vector<Matrix3d> turns;
  for (int i = 0; i < lattice.nodes(); ++i) turns.push_back(random_turn(random));
  return turns;
}

void expect_rate(const RigidRate& expected, const Matrix3d& r, const Reals& rates, int i, double tolerance) {
  const std::size_t at = PLIANT_FLSM_RECORD * static_cast<std::size_t>(i);
  const std::string what = "region " + std::to_string(i);
  expect_near(expected.v, rates, at, tolerance, what + ", at the centre");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    expect_near(expected.omega.cross(r.col(static_cast<Eigen::Index>(axis))), rates, at + 4 * axis + 4, tolerance,
                what + ", along axis " + std::to_string(axis));
  }
}

TEST(FlsmDampRegionOracle, IsTheNearestRigidMotion) {
  Random random(31);
  std::vector<FlsmLattice> all = lattices(random);
  all.emplace_back(random, Offset{7, 6, 1}, 0, 2);    // a sheet
  all.emplace_back(random, Offset{7, 6, 4}, 0.6, 1);  // few nodes to a region
  all.emplace_back(random, Offset{1, 9, 1}, 0, 2);    // a line
  int turning = 0, straight = 0;
  for (FlsmLattice& lattice : all) {
    lattice.set_u([&](const Vector3d&) { return Vector3d::NullaryExpr([&] { return random.uniform(-1, 1); }); });
    const std::vector<Matrix3d> r = random_turns(random, lattice);
    const FlsmData d = damp_region_data(lattice, r);
    const Reals rates = run_in_double(flsm_damp_region_case(d, lattice.width()), "flsm_rates");
    for (int i = 0; i < lattice.nodes(); ++i) {
      const RigidRate expected = nearest_rate(lattice, i, r[static_cast<std::size_t>(i)]);
      ++(expected.turns ? turning : straight);
      expect_rate(expected, r[static_cast<std::size_t>(i)], rates, i, 1e-12);
    }
    for (std::size_t k = 0; k < rates.size(); ++k) {
      const bool absent = k >= PLIANT_FLSM_RECORD * static_cast<std::size_t>(lattice.nodes());
      if (absent || k % 4 == 3) {
        EXPECT_EQ(rates[k], 0) << "number " << k;
      }
    }
  }
  EXPECT_GT(turning, 1000);
  EXPECT_GT(straight, 5) << "no region along a line";
}

/// In float the sums of a region keep about six digits of its largest increment.
TEST(FlsmDampRegionOracle, ReturnsARigidFieldExactly) {
  Random random(32);
  double single = 0;
  for (FlsmLattice& lattice : lattices(random)) {
    const RigidField field = random_field(random);
    lattice.set_u(field);
    FlsmData d = damp_region_data(lattice, std::vector<Matrix3d>(static_cast<std::size_t>(lattice.nodes()), field.turn));
    const KernelCase exact = flsm_damp_region_case(d, lattice.width());
    d.exact = false;
    const Reals rates = run_in_double(exact, "flsm_rates"),
                in_float = run_in_float(flsm_damp_region_case(d, lattice.width()), "flsm_rates");
    double largest = 0;
    for (int i = 0; i < lattice.nodes(); ++i) largest = std::max(largest, lattice.u(i).norm());
    for (int i = 0; i < lattice.nodes(); ++i) {
      const RigidRate expected{lattice.u(i), FlsmLattice::spacing * field.omega};
      expect_rate(expected, field.turn, rates, i, 1e-15);
      expect_rate(expected, field.turn, in_float, i, 2e-6 * largest);
      for (std::size_t k = 0; k < PLIANT_FLSM_RECORD; ++k) {
        const std::size_t at = PLIANT_FLSM_RECORD * static_cast<std::size_t>(i) + k;
        single = std::max(single, std::abs(in_float[at] - rates[at]) / largest);
      }
    }
  }
  std::printf("             float: largest error %.1e of the largest increment\n", single);
}

TEST(FlsmDampRegionOracle, IsATranslationWithoutInertia) {
  Random random(33);
  for (const FlsmLattice& lattice : lattices(random)) {
    FlsmData d = damp_region_data(lattice, random_turns(random, lattice));
    d.spin.assign(d.spin.size(), 0);
    const Reals rates = run_in_double(flsm_damp_region_case(d, lattice.width()), "flsm_rates");
    for (int i = 0; i < lattice.nodes(); ++i) {
      double mass = 0;
      Vector3d mean = Vector3d::Zero();
      for_region(lattice, i, [&](int node, double m, const Vector3d&) {
        mass += m;
        mean += m * lattice.u(node);
      });
      expect_rate({mean / mass, Vector3d::Zero()}, Matrix3d::Identity(), rates, i, 1e-14);
      for (std::size_t k = 4; k < PLIANT_FLSM_RECORD; ++k) {
        EXPECT_EQ(rates[PLIANT_FLSM_RECORD * static_cast<std::size_t>(i) + k], 0) << "region " << i;
      }
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
