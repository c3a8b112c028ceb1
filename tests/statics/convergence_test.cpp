// Orders of convergence against a manufactured solution, quadratic convergence of Newton's method, a slender cantilever.
#include "problems.h"

namespace pliant::statics_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vec3d kUnit{1, 1, 1};

Vector3d wave(const Vector3d& x) {
  return 0.1 * Vector3d(std::sin(2 * x[1]) * x[0], std::sin(2 * x[2] + x[0]), std::cos(2 * x[0]) * x[1]);
}

Matrix3d wave_gradient(const Vector3d& x) {
  Matrix3d h;
  h << std::sin(2 * x[1]), 2 * std::cos(2 * x[1]) * x[0], 0,        //
      std::cos(2 * x[2] + x[0]), 0, 2 * std::cos(2 * x[2] + x[0]),  //
      -2 * std::sin(2 * x[0]) * x[1], std::cos(2 * x[0]), 0;
  return 0.1 * h;
}

/// L2 error of the solution whose exact displacement is `wave`.
double wave_error(Element element, int cells, Law law) {
  Problem p;
  p.mesh = statics::box_mesh(element, {cells, cells, cells}, kUnit);
  p.materials = {physics::material(law, 1000, 3000)};
  const Material m = p.materials[0];
  p.body_force = [m](const Vec3d& at) {
    Vector3d force = Vector3d::Zero();
    constexpr double delta = 1e-4;
    for (int j = 0; j < 3; ++j) {
      const auto stress = [&](double by) {
        return physics::first_piola(Matrix3d::Identity() + wave_gradient(eigen(at) + by * Vector3d::Unit(j)), m).col(j).eval();
      };
      force -= (8 * (stress(delta) - stress(-delta)) - (stress(2 * delta) - stress(-2 * delta))) / (12 * delta);
    }
    return plain(force);
  };
  for (std::size_t n = 0; n < p.mesh.nodes.size(); ++n) {
    const Vector3d u = wave(eigen(p.mesh.nodes[n]));
    for (int c = 0; on_boundary(p.mesh.nodes[n], kUnit) && c < 3; ++c)
      p.prescribed.push_back({static_cast<std::int32_t>(n), c, u[c]});
  }
  const Solution s = solved(p);
  const statics::Field field(p.mesh);
  double error = 0;
  for (const statics::Sample& sample : statics::samples(p.mesh))
    error += sample.weight * (eigen(field.value(sample.place, s.displacement)) - wave(eigen(sample.rest))).squaredNorm();
  return std::sqrt(error);
}

TEST(Convergence, OrdersInL2) {
  const auto order = [](Element element, int coarse, Law law) {
    const double first = wave_error(element, coarse, law), second = wave_error(element, 2 * coarse, law);
    std::printf("  %-9s %s errors %.3e %.3e order %.3f\n", statics::to_string(element), to_string(law), first, second,
                std::log2(first / second));
    return std::log2(first / second);
  };
  for (const Law law : all_laws()) EXPECT_NEAR(order(Element::tet10, 3, law), 3, 0.15);
  EXPECT_NEAR(order(Element::hex8full, 6, Law::neo_hookean), 2, 0.1);
  EXPECT_NEAR(order(Element::tet4, 6, Law::neo_hookean), 2, 0.2);
}

TEST(Convergence, NewtonIsQuadraticAtLargeDeflection) {
  const auto bend = [](Element element, Law law) {
    Problem p;
    p.mesh = statics::box_mesh(element, {8, 2, 2}, {0.4, 0.1, 0.1});
    p.materials = {physics::material_young(law, 10000, 0.45)};
    statics::prescribe(
        p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
    // Saint-Venant-Kirchhoff material gives way when it is pressed together: its elements turn inside out under more.
    p.gravity = {0, law == Law::saint_venant_kirchhoff ? -0.9 : -9.81, 0};
    const Solution s = solved(p);
    ASSERT_EQ(s.steps.size(), 1U);
    const std::vector<double>& r = s.steps[0].residuals;
    ASSERT_GE(r.size(), 4U);
    // The last decrease that stays above rounding: an exponent near two, as ln r(n+1) / ln r(n).
    double best = 0;
    for (std::size_t i = 1; i + 1 < r.size(); ++i) {
      if (r[i] < 1e-2 && r[i + 1] > 1e-13) best = std::max(best, std::log(r[i + 1]) / std::log(r[i]));
    }
    std::printf("  %-9s %-24s residuals", statics::to_string(element), to_string(law));
    for (const double residual : r) std::printf(" %.1e", residual);
    std::printf("  order %.2f\n", best);
    EXPECT_GT(best, 1.7) << statics::to_string(element) << ' ' << to_string(law);
    EXPECT_LT(r.back(), 1e-10);
  };
  for (const Element element : all_elements()) {
    for (const Law law : all_laws()) bend(element, law);
  }
}

TEST(Convergence, SlenderCantileverBendsAsTimoshenkoSays) {
  // A square bar of nu = 0 has no anticlastic bending: w = F L^3 / (3 E I) + F L / (k G A), k = 5/6 (nu = 0).
  const double length = 1, side = 0.1, young = 1e5, force = 0.01;
  for (const Element element : {Element::tet10, Element::hex8full}) {
    const bool hex = element == Element::hex8full;
    Problem p;
    p.mesh = statics::box_mesh(element, {hex ? 80 : 16, 2, hex ? 4 : 2}, {length, side, side});
    p.materials = {physics::material_young(Law::neo_hookean, young, 0)};
    statics::prescribe(
        p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
    statics::add_traction(p, [&](const Vec3d& x) { return on(x[0], length); }, {0, 0, -force / (side * side)});
    const double inertia = std::pow(side, 4) / 12;
    const double exact = -force * (std::pow(length, 3) / (3 * young * inertia) + length / (5.0 / 6 * young / 2 * side * side));
    Settings linear;
    linear.linear = true;
    for (const Solution& s : {solved(p, linear), solved(p)}) {
      double tip = 0, count = 0;
      for (const std::int32_t n : statics::nodes_where(p.mesh, [&](const Vec3d& x) { return on(x[0], length); })) {
        tip += s.displacement[n][2];
        ++count;
      }
      physics::check_relative(statics::to_string(element), tip / count, exact, hex ? 0.01 : 0.005);
    }
  }
}

}  // namespace
}  // namespace pliant::statics_test
