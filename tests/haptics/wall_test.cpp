// The stiffest virtual wall per rate: simulated, by the eigenvalues of the sampled system, and by K = 2 b / T.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "haptics/hand.h"

namespace pliant::haptics::wall_test {
namespace {

constexpr double kMass = 0.08, kDamping = 0.5;

/// Whether the swing about the wall's surface has grown after 40 000 ticks. The wall is on both sides, so that all is linear.
bool grows(double rate, double stiffness) {
  HandOptions options;
  options.translation = {kMass, kDamping, 0, 0};
  SimulatedHand hand(options);
  hand.place({{1e-3, 0, 0}});
  constexpr int kTicks = 40000;
  double early = 0, late = 0;
  for (int k = 0; k < kTicks; ++k) {
    const double x = hand.read().position[0];
    if (k < kTicks / 2) {
      early = std::max(early, std::abs(x));
    } else {
      late = std::max(late, std::abs(x));
    }
    if (std::abs(x) > 1) return true;
    hand.write({{-stiffness * x, 0, 0}, {}, 0, 0});
    hand.advance(1 / rate);
  }
  return late > early;
}

double largest_eigenvalue(double rate, double stiffness) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  a(0, 1) = 1;
  a(1, 1) = -kDamping / kMass;
  a(1, 2) = 1 / kMass;
  const Eigen::Matrix3d e = (a / rate).exp();
  Eigen::Matrix2d loop = e.topLeftCorner<2, 2>();
  loop.col(0) -= stiffness * e.topRightCorner<2, 1>();
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}

template <class Fails>
double bisected(double low, double high, const Fails& fails) {
  for (int k = 0; k < 14; ++k) {
    const double middle = (low + high) / 2;
    (fails(middle) ? high : low) = middle;
  }
  return low;
}

TEST(Wall, TheStiffestFollowsColgate) {
  for (const double rate : {300.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0}) {
    const double colgate = 2 * kDamping * rate;
    const double simulated = bisected(0, 4 * colgate, [&](double k) { return grows(rate, k); });
    const double exact = bisected(0, 4 * colgate, [&](double k) { return largest_eigenvalue(rate, k) >= 1; });
    std::printf("%6.0f Hz: simulated %7.1f, exact %7.1f, 2 b / T = %7.1f N/m\n", rate, simulated, exact, colgate);
    EXPECT_NEAR(simulated / exact, 1, 0.01) << rate;
    EXPECT_NEAR(simulated / colgate, 1, 0.03) << rate;
  }
}

}  // namespace
}  // namespace pliant::haptics::wall_test
