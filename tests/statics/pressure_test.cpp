// Follower pressure: uniform states with closed forms, its derivative, what it does to Newton's method, and what balances it.
#include "statics/pressure.h"

#include "problems.h"
#include "support/error_of.h"

namespace pliant::statics_test::pressure_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kEdge = 0.1;
const Vec3d kCube{kEdge, kEdge, kEdge};

bool on_top(const Vec3d& x) { return on(x[2], kEdge); }

/// A cube on three rollers, sets 0, 1 and 2.
Problem cube(Element element, int cells, const Material& material, double distortion) {
  Problem p;
  p.mesh = distorted_box(element, {cells, cells, cells}, kCube, distortion);
  p.materials = {material};
  for (int c = 0; c < 3; ++c)
    statics::prescribe(
        p, [c](const Vec3d& x) { return on(x[c], 0); }, 1 << c);
  for (statics::Prescribed& entry : p.prescribed) entry.set = entry.axis;
  return p;
}

template <class Body>
void each(const Body& body) {
  for (const Element element : all_elements()) {
    for (const int cells : {1, 2, 4}) {
      SCOPED_TRACE(std::string(statics::to_string(element)) + ", cells " + std::to_string(cells));
      body(element, cells);
    }
  }
}

/// The three sets carry what was applied, here `force` along z.
void expect_balance(const Problem& p, const Solution& s, double force) {
  EXPECT_NEAR(s.applied[2] / force, 1, 1e-9);
  const std::vector<Vec3d> sums = statics::reactions(p, s);
  ASSERT_EQ(sums.size(), 3U);
  EXPECT_NEAR(sums[2][2] / -force, 1, 1e-9);
  for (int c = 0; c < 2; ++c) {
    EXPECT_NEAR(sums[c][c], 0, 1e-9 * std::abs(force));
    EXPECT_NEAR(s.applied[c], 0, 1e-9 * std::abs(force));
    EXPECT_EQ(sums[2][c], 0);
  }
}

TEST(Pressure, PatchIsExactAtSmallStrain) {
  each([](Element element, int cells) {
    const double young = 10000, poisson = 0.3, pressure = 1000;
    Problem p = cube(element, cells, physics::material_young(Law::neo_hookean, young, poisson), 0.2);
    statics::add_pressure(p, on_top, pressure);
    Settings linear;
    linear.linear = true;
    const Solution s = solved(p, linear);
    const double e = pressure / young;
    const auto exact = [&](const Vector3d& x) { return Vector3d(poisson * e * x[0], poisson * e * x[1], -e * x[2]); };
    EXPECT_LE(largest_miss(p, s, exact), 1e-9 * e * kEdge);
    expect_balance(p, s, -pressure * kEdge * kEdge);
  });
}

TEST(Pressure, PatchIsExactAtLargeStrain) {
  each([](Element element, int cells) {
    for (const Law law : all_laws()) {
      SCOPED_TRACE(to_string(law));
      Problem p = cube(element, cells, physics::material(law, 1000, 3000), 0.2);
      const double height = law == Law::saint_venant_kirchhoff ? 0.96 : 0.85;
      const auto f = [&](double side) { return Matrix3d(Vector3d(side, side, height).asDiagonal()); };
      const double side = physics::root(0.9, 1.3, [&](double t) { return physics::first_piola(f(t), p.materials[0])(0, 0); });
      const double nominal = physics::first_piola(f(side), p.materials[0])(2, 2);  // force over the area at rest
      statics::add_pressure(p, on_top, -nominal / (side * side));
      const Solution s = solved(p);
      EXPECT_LE(largest_miss(p, s, [&](const Vector3d& x) { return ((f(side) - Matrix3d::Identity()) * x).eval(); }),
                1e-9 * kEdge);
      expect_balance(p, s, nominal * kEdge * kEdge);
    }
  });
}

/// A bent, curved surface: the derivative of its loads by central differences.
TEST(Pressure, DerivativeIsThatOfTheForces) {
  const auto wave = [](const Vec3d& x) {
    return Vector3d(0.03 * std::sin(20 * x[1]), 0.02 * std::cos(25 * x[2] + x[0]), 0.03 * std::sin(30 * x[0] * x[1] + 1));
  };
  const auto check = [&](const Problem& p) {
    Eigen::VectorXd u(3 * p.mesh.nodes.size()), d(u.size());
    for (std::size_t n = 0; n < p.mesh.nodes.size(); ++n) {
      u.segment<3>(static_cast<Eigen::Index>(3 * n)) = wave(p.mesh.nodes[n]);
      d.segment<3>(static_cast<Eigen::Index>(3 * n)) = wave(plain(eigen(p.mesh.nodes[n]) * 1.7));
    }
    const auto patches = statics::pressure_patches(p);
    ASSERT_FALSE(patches.empty());
    for (const statics::PressurePatch& patch : patches) {
      const Matrix3Xd at = patch.of(u), change = patch.of(d);
      const double step = 1e-3;  // the forces are of second degree: central differences are exact
      const Matrix3Xd slope = (patch.forces(at + step * change) - patch.forces(at - step * change)) / (2 * step);
      const Eigen::MatrixXd k = patch.stiffness(at);
      EXPECT_LE((k - k.transpose()).norm(), 1e-12 * k.norm());
      const Eigen::VectorXd symmetric = k * Eigen::VectorXd(change.reshaped());
      const Matrix3Xd product = symmetric.reshaped(3, change.cols()) + patch.skew_product(at, change);
      EXPECT_LE((product + slope).norm(), 1e-9 * slope.norm());
    }
  };
  for (const Element element : all_elements()) {
    SCOPED_TRACE(statics::to_string(element));
    Problem p = cube(element, 1, physics::material(Law::neo_hookean, 1000, 3000), 0);
    statics::add_pressure(p, on_top, 700);
    check(p);
  }
  Problem embedded = cube(Element::hex8full, 1, physics::material(Law::neo_hookean, 1000, 3000), 0);
  for (const double x : {0.02, 0.07, 0.05}) {
    statics::SurfacePoint point{{x, 30 * x * x, 1.5 * x}, {}, {}};
    for (int a = 0; a < 8; ++a) {
      point.nodes[a] = a;
      point.weights[a] = 0.05 + 0.4 * x * a * (a % 3);
    }
    embedded.surface.push_back(point);
  }
  embedded.pressures.push_back({{0, 1, 2}, 700});
  check(embedded);
}

/// The load on a surface with a rim has an unsymmetric derivative, and the tangent is symmetric.
TEST(Pressure, NewtonStaysQuadraticUnderAnOpenSurface) {
  for (const Element element : all_elements()) {
    Problem p;
    p.mesh = statics::box_mesh(element, {8, 2, 2}, {0.4, 0.1, 0.1});
    p.materials = {physics::material_young(Law::neo_hookean, 10000, 0.45)};
    statics::prescribe(
        p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
    statics::add_pressure(
        p, [](const Vec3d& x) { return on(x[2], 0.1); }, 40);
    const Solution s = solved(p);
    ASSERT_EQ(s.steps.size(), 1U);
    const std::vector<double>& r = s.steps[0].residuals;
    double best = 0, tip = 0;
    for (std::size_t i = 1; i + 1 < r.size(); ++i) {
      if (r[i] < 1e-2 && r[i + 1] > 1e-14) best = std::max(best, std::log(r[i + 1]) / std::log(r[i]));
    }
    for (const Vec3d& u : s.displacement) tip = std::max(tip, vec::norm(u));
    std::printf("  %-9s tip %.3f residuals", statics::to_string(element), tip);
    for (const double residual : r) std::printf(" %.1e", residual);
    std::printf("  order %.2f\n", best);
    EXPECT_GT(best, 1.7) << statics::to_string(element);
    EXPECT_LE(r.size(), 12U);
    EXPECT_GT(tip, 0.05);
  }
}

/// What a scene asks for, on volume meshes and with quadratic elements.
TEST(Pressure, OfASceneIsUniformOnEveryVolumeMesh) {
  using physics::Discretization;
  for (const auto& [cut, quadratic] :
       {std::pair{Discretization::tet4, false}, {Discretization::tet4, true}, {Discretization::hex8full, false}}) {
    SCOPED_TRACE(std::string(physics::name_of(cut)) + (quadratic ? ", order 2" : ""));
    for (const int cells : {2, 4}) {
      Scene scene;
      Body body = physics::box_body({{cells, cells, cells}, kEdge / cells, 0.2, 5}, cut,
                                    physics::material_young(Law::neo_hookean, 10000, 0.3));
      for (int c = 0; c < 3; ++c) body.fixed.push_back(physics::roller(c));
      Pressure pressure;
      pressure.where = physics::face(2, kEdge);
      pressure.pressure = 1000;
      body.pressures.push_back(pressure);
      scene.bodies.push_back(body);
      const Problem p = statics::problem_of(scene, build_model(scene), 0, quadratic);
      Settings linear;
      linear.linear = true;
      const Solution s = solved(p, linear);
      const auto exact = [](const Vector3d& x) { return Vector3d(0.03 * x[0], 0.03 * x[1], -0.1 * x[2]); };
      EXPECT_LE(largest_miss(p, s, exact), 1e-9 * 0.1 * kEdge);
      expect_balance(p, s, -10);
    }
  }
}

/// In a lattice the surface lies somewhere in the cells: with quadratic elements it moves as these do, mid-edge nodes included.
TEST(Pressure, EmbeddedSurfaceMovesWithQuadraticElements) {
  Scene scene;
  Body body = physics::box_body({{3, 3, 3}, kEdge / 3, 0, 5}, physics::Discretization::hex8full_lattice,
                                physics::material_young(Law::neo_hookean, 10000, 0.3));
  body.element = ElementKind::tet4;
  body.fixed.push_back({physics::face(2, 0)});
  Pressure pressure;
  pressure.where = physics::face(2, kEdge);
  pressure.pressure = 1000;
  body.pressures.push_back(pressure);
  scene.bodies.push_back(body);
  const Problem p = statics::problem_of(scene, build_model(scene), 0, true);
  const auto bent = [](const Vec3d& x) { return Vec3d{x[0] * x[1], x[2] * x[2] - x[0], 3 * x[0] * x[2]}; };
  for (const statics::SurfacePoint& point : p.surface) {
    Vec3d moved{};
    for (std::size_t a = 0; a < point.nodes.size(); ++a)
      moved = vec::add(moved, vec::mul(bent(p.mesh.nodes[point.nodes[a]]), point.weights[a]));
    EXPECT_LE(vec::norm(vec::sub(moved, bent(point.rest))), 1e-12);
  }
  Settings linear;
  linear.linear = true;
  const Solution s = solved(p, linear);
  EXPECT_NEAR(s.applied[2], -10, 1e-6);  // the file of the surface is in float
  EXPECT_NEAR(statics::reactions(p, s).at(0)[2] / s.applied[2], -1, 1e-9);
}

TEST(Pressure, OfNoElementIsRefused) {
  Problem p = cube(Element::tet4, 1, physics::material(Law::neo_hookean, 1000, 3000), 0);
  p.face_pressures.push_back({6, {0, 1, 2}, 1});
  EXPECT_NE(test::error_of([&] { statics::solve(p); }).find("a pressure names element 6, allowed are 0 to 5"),
            std::string::npos);
  p.face_pressures[0] = {5, {0, 1, 4}, 1};
  EXPECT_NE(test::error_of([&] { statics::solve(p); }).find("a pressure names corner 4, allowed are 0 to 3"),
            std::string::npos);
}

/// The last entry for a component holds it; the middle of an edge between two sets belongs to the later.
TEST(Reactions, AddUpOverEveryNodeThatASetHolds) {
  for (const Element element : all_elements()) {
    SCOPED_TRACE(statics::to_string(element));
    Problem p;
    p.mesh = distorted_box(element, {3, 2, 2}, {0.2, 0.1, 0.1}, 0.2);
    p.materials = {physics::material(Law::neo_hookean, 1000, 3000)};
    statics::prescribe(
        p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
    const std::size_t first = p.prescribed.size();
    statics::prescribe(p, [](const Vec3d& x) { return on(x[0], 0.2); }, 7, {0.02, 0.01, 0});
    for (std::size_t i = first; i < p.prescribed.size(); ++i) p.prescribed[i].set = 1;
    const Solution s = solved(p);
    const std::vector<Vec3d> sums = statics::reactions(p, s);
    ASSERT_EQ(sums.size(), 2U);
    EXPECT_GT(sums[1][0], 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sums[0][c], -sums[1][c], 1e-9 * sums[1][0]);
    p.prescribed.push_back(p.prescribed.front());  // the same component again, in another set
    p.prescribed.back().set = 2;
    const std::vector<Vec3d> more = statics::reactions(p, s);
    const int axis = p.prescribed.back().axis;
    EXPECT_EQ(more.at(2)[axis], s.reaction[p.prescribed.back().node][axis]);
    EXPECT_NEAR(more[0][axis] + more[2][axis], sums[0][axis], 1e-12);
  }
}

}  // namespace
}  // namespace pliant::statics_test::pressure_test
