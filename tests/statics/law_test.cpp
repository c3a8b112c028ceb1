// Stress against differences of the energy, tangent against differences of the stress, and small strain without cancellation.
#include "statics/law.h"

#include "problems.h"

namespace pliant::statics_test {
namespace {

using Eigen::Matrix3d;
using statics::respond;
using statics::Response;

const Matrix3d kLarge = (Matrix3d() << 0.3, -0.2, 0.1, 0.25, -0.15, 0.2, -0.1, 0.05, 0.4).finished();

TEST(Law, StressIsTheDerivativeOfTheEnergyAndTheTangentThatOfTheStress) {
  for (const Law law : all_laws()) {
    const Material m = physics::material(law, 1000, 9000);
    Response at;
    ASSERT_TRUE(respond(m, kLarge, true, at));
    for (int c = 0; c < 9; ++c) {
      constexpr double delta = 1e-4;
      const auto moved = [&](double by) {
        Matrix3d h = kLarge;
        h(c / 3, c % 3) += by;
        Response out;
        EXPECT_TRUE(respond(m, h, false, out));
        return out;
      };
      // Five-point differences: error of order delta^4.
      const Response p1 = moved(delta), p2 = moved(2 * delta), m1 = moved(-delta), m2 = moved(-2 * delta);
      const double slope = (8 * (p1.energy - m1.energy) - (p2.energy - m2.energy)) / (12 * delta);
      EXPECT_NEAR(at.stress(c / 3, c % 3), slope, 1e-7 * m.kappa) << to_string(law) << " component " << c;
      const Matrix3d change = (8 * (p1.stress - m1.stress) - (p2.stress - m2.stress)) / (12 * delta);
      for (int r = 0; r < 9; ++r)
        EXPECT_NEAR(at.tangent(r, c), change(r / 3, r % 3), 1e-7 * m.kappa) << to_string(law) << " entry " << r << ", " << c;
    }
    EXPECT_LE((at.stress - physics::first_piola(Matrix3d::Identity() + kLarge, m)).norm(), 1e-12 * at.stress.norm());
  }
}

TEST(Law, AgreesWithLinearElasticityAtRestToTheLastDigits) {
  for (const Law law : all_laws()) {
    const Material m = physics::material(law, 1000, 9000);
    Response at, linear;
    ASSERT_TRUE(respond(m, Matrix3d::Zero(), true, at));
    respond_linear(m, 1e-9 * kLarge, linear);
    EXPECT_EQ(at.stress, Matrix3d::Zero());
    EXPECT_LE((at.tangent - linear.tangent).norm(), 1e-14 * linear.tangent.norm()) << to_string(law);
    ASSERT_TRUE(respond(m, 1e-9 * kLarge, true, at));
    EXPECT_LE((at.stress - linear.stress).norm(), 1e-8 * linear.stress.norm()) << to_string(law);
  }
}

TEST(Law, RefusesAnInvertedOrInfiniteState) {
  Response out;
  EXPECT_FALSE(respond(physics::material(Law::neo_hookean, 1, 1), -2 * Matrix3d::Identity(), true, out));
  EXPECT_FALSE(respond(physics::material(Law::neo_hookean, 1, 1), -Matrix3d::Identity(), true, out));
  EXPECT_FALSE(respond(physics::material(Law::neo_hookean, 1, 1), Matrix3d::Constant(NAN), true, out));
}

}  // namespace
}  // namespace pliant::statics_test
