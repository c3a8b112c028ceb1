// Every law of host/material: stress against differences of the energy, tangent against differences of the stress, small strain
// without cancellation, and its table against what it does.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "kernels/laws/law_oracle.h"
#include "material/response.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;

const Matrix3d kLarge = (Matrix3d() << 0.3, -0.2, 0.1, 0.25, -0.15, 0.2, -0.1, 0.05, 0.4).finished();
/// F = diag(-0.5, 1.1, 0.9) and a little shear.
const Matrix3d kInverted = (Matrix3d() << -1.5, 0.05, 0.1, 0.02, 0.1, -0.03, 0.04, 0.06, -0.1).finished();

/// F = diag(0.5, 0.6, 0.7) and a little shear: J = 0.2.
const Matrix3d kSquashed = (Matrix3d() << -0.5, 0.05, 0.1, 0.02, -0.4, -0.03, 0.04, 0.06, -0.3).finished();

Material material(Law law, double low = 0) {
  Material m = make_material(law, Moduli::from_bulk(1000, 9000));
  m.low = low;
  return m;
}

/// Five-point differences of the energy and of the stress, whose error is of order delta^4.
void expect_consistent(Law law, const Matrix3d& h, double low = 0) {
  const Material m = material(law, low);
  Response at;
  ASSERT_TRUE(respond(m, h, true, at));
  for (int c = 0; c < 9; ++c) {
    constexpr double delta = 1e-4;
    const auto moved = [&](double by) {
      Matrix3d there = h;
      there(c / 3, c % 3) += by;
      Response out;
      EXPECT_TRUE(respond(m, there, false, out));
      return out;
    };
    const Response p1 = moved(delta), p2 = moved(2 * delta), m1 = moved(-delta), m2 = moved(-2 * delta);
    const double slope = (8 * (p1.energy - m1.energy) - (p2.energy - m2.energy)) / (12 * delta);
    EXPECT_NEAR(at.stress(c / 3, c % 3), slope, 1e-7 * m.moduli.kappa + 1e-9 * at.stress.norm())
        << to_string(law) << " component " << c;
    const Matrix3d change = (8 * (p1.stress - m1.stress) - (p2.stress - m2.stress)) / (12 * delta);
    for (int r = 0; r < 9; ++r) {
      EXPECT_NEAR(at.tangent(r, c), change(r / 3, r % 3), 1e-7 * m.moduli.kappa + 1e-9 * at.tangent.norm())
          << to_string(law) << " entry " << r << ", " << c;
    }
  }
  EXPECT_LE((at.tangent - at.tangent.transpose()).norm(), 1e-12 * at.tangent.norm()) << to_string(law);
  const Matrix3d f = Matrix3d::Identity() + h;
  EXPECT_LE((at.stress - kernel_test::piola_stress(law, f, m.parameters)).norm(), 1e-12 * at.stress.norm()) << to_string(law);
  const double energy =
      kernel_test::energy_density(law, f, m.parameters) - kernel_test::energy_density(law, Matrix3d::Identity(), m.parameters);
  EXPECT_NEAR(at.energy, energy, 1e-12 * m.moduli.kappa) << to_string(law);
}

TEST(Law, StressIsTheDerivativeOfTheEnergyAndTheTangentThatOfTheStress) {
  for (const Law law : all_laws()) {
    expect_consistent(law, kLarge);
    if (law_info(law).invertible) expect_consistent(law, kInverted);
    for (const Matrix3d& h :
         {kLarge, kSquashed, kInverted, Matrix3d(-Matrix3d::Identity()), Matrix3d(-2 * Matrix3d::Identity())}) {
      expect_consistent(law, h, low_volume);
    }
  }
}

TEST(Law, AgreesWithLinearElasticityAtRestToTheLastDigits) {
  for (const Law law : all_laws()) {
    const Material m = material(law);
    Response at, linear;
    ASSERT_TRUE(respond(m, Matrix3d::Zero(), true, at));
    respond_linear(m, 1e-9 * kLarge, linear);
    EXPECT_EQ(at.energy, 0) << to_string(law);
    EXPECT_EQ(at.stress, Matrix3d::Zero()) << to_string(law);
    EXPECT_LE((at.tangent - linear.tangent).norm(), 1e-14 * linear.tangent.norm()) << to_string(law);
    ASSERT_TRUE(respond(m, 1e-9 * kLarge, true, at));
    EXPECT_LE((at.stress - linear.stress).norm(), 1e-8 * linear.stress.norm()) << to_string(law);
    EXPECT_NEAR(at.energy / linear.energy, 1, 1e-7) << to_string(law);
  }
}

TEST(Law, AnswersAnInvertedStateOnlyIfItSaysSo) {
  Response out;
  for (const Law law : all_laws()) {
    const Material m = material(law);
    for (const Matrix3d& h : {Matrix3d(-2 * Matrix3d::Identity()), Matrix3d(-Matrix3d::Identity()), kInverted}) {
      EXPECT_TRUE(respond(material(law, low_volume), h, true, out)) << to_string(law);
      EXPECT_TRUE(out.stress.allFinite() && out.tangent.allFinite()) << to_string(law);
      EXPECT_EQ(respond(m, h, true, out), law_info(law).invertible) << to_string(law);
      const bool finite = !law_info(law).invertible || (out.stress.allFinite() && out.tangent.allFinite());
      EXPECT_TRUE(finite) << to_string(law);
      EXPECT_FALSE(cauchy_stress(m, h)) << to_string(law);
    }
    EXPECT_FALSE(respond(m, Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()), true, out)) << to_string(law);
    EXPECT_FALSE(respond(m, 1e200 * Matrix3d::Identity(), true, out)) << to_string(law);
  }
}

/// Stress and tangent have no jump where the continuation begins.
TEST(Law, IsContinuedWithItsSlope) {
  for (const Law law : all_laws()) {
    const Material m = material(law, low_volume);
    Matrix3d f = Matrix3d::Identity() + kSquashed;
    f *= std::cbrt(low_volume / f.determinant());
    Response above, below;
    ASSERT_TRUE(respond(m, (1 + 1e-9) * f - Matrix3d::Identity(), true, above));
    ASSERT_TRUE(respond(m, (1 - 1e-9) * f - Matrix3d::Identity(), true, below));
    EXPECT_NEAR(above.energy, below.energy, 1e-7 * std::fabs(above.energy)) << to_string(law);
    EXPECT_LE((above.stress - below.stress).norm(), 1e-6 * above.stress.norm()) << to_string(law);
    EXPECT_LE((above.tangent - below.tangent).norm(), 1e-6 * above.tangent.norm()) << to_string(law);
  }
}

/// An element that is pressed through itself, F = diag(x, s, s) with x < 0, is pushed back whatever its sides are.
TEST(Law, DrivesAnInvertedElementBack) {
  for (const Law law : all_laws()) {
    const Material m = material(law, low_volume);
    for (const double side : {0.6, 0.8, 1.0, 1.3, 2.0}) {
      for (double x = -3; x < -0.02; x += 0.05) {
        Response at;
        ASSERT_TRUE(respond(m, Eigen::Vector3d(x - 1, side - 1, side - 1).asDiagonal().toDenseMatrix(), false, at));
        EXPECT_LT(at.stress(0, 0), 0) << to_string(law) << " x " << x << " side " << side;
      }
    }
  }
}

TEST(Law, HasModuliAtRestAndAVolumetricPartAsItsTableSays) {
  std::set<std::string> words;
  for (const Law law : all_laws()) {
    const LawInfo& info = law_info(law);
    EXPECT_TRUE(words.insert(info.word).second) << info.word;
    const Moduli wanted = Moduli::from_bulk(1052, 52249);
    Material m = make_material(law, wanted);
    ASSERT_EQ(m.parameters.size(), info.parameters.size()) << info.word;
    for (std::size_t i = 0; i < m.parameters.size(); ++i) {
      EXPECT_GE(m.parameters[i], info.parameters[i].lower) << info.word;
      EXPECT_LE(m.parameters[i], info.parameters[i].upper) << info.word;
      EXPECT_NE(m.parameters[i], 0) << info.word << ": a test would not notice this parameter";
    }
    m.set_parameters(law, std::vector<double>(m.parameters));
    EXPECT_NEAR(m.moduli.mu, wanted.mu, 1e-12 * wanted.mu) << info.word;
    EXPECT_NEAR(m.moduli.kappa, wanted.kappa, 1e-12 * wanted.kappa) << info.word;
    EXPECT_NEAR(m.moduli.lambda, m.moduli.kappa - 2 * m.moduli.mu / 3, 1e-9) << info.word;
    EXPECT_EQ(volume_modulus(m) > 0, info.volumetric) << info.word;
    EXPECT_FALSE(law_constants(m).empty()) << info.word;
    m.parameters.push_back(1);
    EXPECT_ANY_THROW(law_constants(m)) << info.word;
  }
}

}  // namespace
}  // namespace pliant
