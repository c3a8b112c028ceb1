// The stable step: Lanczos iteration against the eigenproblem in Eigen, the measured limit, the element bound, fill, and
// divergence.
#include "physics/harness.h"

namespace pliant::physics {
namespace {

class StableStep : public OnBackend {};

/// K at rest over the free components: a dense generalised eigenproblem with lumped masses gives omega_max, and K solves
/// statics.
struct Linear {
  std::vector<std::pair<std::int32_t, int>> dof;  ///< slot, component
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd mass;
  [[nodiscard]] double omega_max() const {
    const Eigen::VectorXd scale = mass.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd a = scale.asDiagonal() * stiffness * scale.asDiagonal();
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
  }
};

/// From differences of the double twin's forces, which the patch tests compare with the energy.
Linear linearise(const Scene& scene) {
  auto sim = simulate(scene, "cpu:double");
  const Model& model = sim->model();
  Linear out;
  std::vector<int> fixed(model.slots, 0);
  for (const Constraint& c : model.constraints) fixed[c.slot] = c.axes;
  for (std::int32_t s = 0; s < model.slots; ++s) {
    for (int c = 0; c < 3; ++c) {
      if (model.mass[s] > 0 && !(fixed[s] & (1 << c))) out.dof.emplace_back(s, c);
    }
  }
  const auto n = static_cast<Eigen::Index>(out.dof.size());
  out.stiffness.resize(n, n);
  out.mass.resize(n);
  const double h = 1e-6 * model.shortest;
  std::vector<Vec3d> u(model.slots);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto [slot, component] = out.dof[j];
    std::array<std::vector<Vec3d>, 2> f;
    for (const int side : {0, 1}) {
      u[slot][component] = side ? h : -h;
      write_texels(*sim, "node_u", u);
      f[side] = forces(*sim);
    }
    u[slot][component] = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto [row, c] = out.dof[i];
      out.stiffness(i, j) = -(f[1][row][c] - f[0][row][c]) / (2 * h);
    }
    out.mass[j] = model.mass[slot];
  }
  out.stiffness = (0.5 * (out.stiffness + out.stiffness.transpose())).eval();
  return out;
}

Scene clamped(Discretization cut, double poisson) {
  Scene scene;
  Body body = box_body({{3, 2, 2}, 0.02, 0.2, 12}, cut, material_young(Law::neo_hookean, 3000, poisson));
  body.fixed.push_back({face(0, 0), {true, true, true}});
  scene.bodies = {body};
  return scene;
}

TEST_P(StableStep, LanczosAgainstEigen) {
  for (const double poisson : {0.0, 0.3, 0.45}) {
    for (const Discretization cut : all_cuts()) {
      const Scene scene = clamped(cut, poisson);
      const double exact = 2 / linearise(scene).omega_max();
      auto sim = simulate(scene, GetParam());
      const std::string name = std::string(name_of(cut)) + " nu " + std::to_string(poisson).substr(0, 4);
      check_relative(name + " 2 / omega_max [s]", sim->stable_dt(), exact, 0.02);
      EXPECT_LE(sim->stable_dt(), exact) << "an unsafe estimate";
      std::printf("  %-58s %.3f of the exact one\n", (name + " element bound").c_str(), sim->model().element_bound / exact);
      EXPECT_LE(sim->model().element_bound, exact * (1 + 1e-9));
      EXPECT_GT(sim->model().element_bound, 0.3 * exact);
    }
  }
}

/// 0.98 of the exact limit keeps small noise small, 1.05 blows it up.
TEST_P(StableStep, MeasuredLimit) {
  for (const Discretization cut : all_cuts()) {
    Scene scene = clamped(cut, 0.45);
    const double exact = 2 / linearise(scene).omega_max();
    std::array<double, 2> growth{};
    for (const int side : {0, 1}) {
      scene.dt = (side ? 1.05 : 0.98) * exact;
      auto sim = simulate(scene, GetParam());
      std::mt19937 random(5);
      const auto noise = [&] { return (static_cast<double>(random()) / 4294967295.0 - 0.5) * 1e-6; };
      write_texels(*sim, "node_u", displaced(sim->model(), [&](const Vector3d& x) {
        return x[0] < 1e-6 ? Vector3d(0, 0, 0) : Vector3d(noise(), noise(), noise());
      }));
      write_texels(*sim, "node_w", std::vector<Vec3d>(sim->model().slots));
      sim->advance(600);
      growth[side] = sim->divergence() ? HUGE_VAL : largest(sim->displacements(0)) / 1e-6;
    }
    std::printf("  %-40s growth of noise in 600 steps: %.3g at 0.98, %.3g at 1.05 of the limit\n", name_of(cut), growth[0],
                growth[1]);
    EXPECT_LT(growth[0], 20);
    EXPECT_GT(growth[1], 1e3);
  }
}

/// Cells with little material scale mass and stiffness alike: slivers do not cost a step.
TEST_P(StableStep, IndependentOfFill) {
  const Material m = material_young(Law::neo_hookean, 3000, 0.45);
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::hex8full_lattice}) {
    std::array<double, 2> dt{}, fill{1, 1};
    for (const int sliver : {0, 1}) {
      Body body = box_body({{5, 5, 5}, 0.02}, cut, m);
      if (sliver) {  // the tips and edges of an octahedron fill their cells little
        const double r = 0.0525;
        body.surface =
            save(TriangleMesh{{{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
                              {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}});
      }
      Scene scene;
      scene.bodies = {body};
      auto sim = simulate(scene, GetParam());
      dt[sliver] = sim->stable_dt();
      for (const double f : sim->model().brick_fill) fill[sliver] = f > 0 ? std::min(fill[sliver], f) : fill[sliver];
      for (const ElementBatch& b : sim->model().batches) {
        for (const double f : b.share) fill[sliver] = std::min(fill[sliver], f);
      }
    }
    std::printf("  %-20s smallest fill %.3g and %.3g, stable step %.6g and %.6g s\n", name_of(cut), fill[0], fill[1], dt[0],
                dt[1]);
    EXPECT_LT(fill[1], 0.1);
    EXPECT_GT(dt[1], 0.9 * dt[0]);
  }
}

/// Many cells have many modes near the highest: the estimate of the start must still be safe.
TEST_P(StableStep, SafeOnALargerLattice) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    Scene scene;
    scene.bodies = {box_body({{30, 12, 12}, 0.01}, cut, material_young(Law::neo_hookean, 3000, 0.45))};
    auto sim = simulate(scene, GetParam());
    const double first = sim->stable_dt();
    const double converged = sim->estimate_stable_dt(1000);
    check_relative(std::string(name_of(cut)) + " estimate against 1000 further iterations", first, converged, 0.02);
    EXPECT_LE(first, converged);
  }
}

TEST_P(StableStep, RelaxationAgainstLinearStatics) {
  for (const Discretization cut : all_cuts()) {
    Scene scene = clamped(cut, 0.3);
    Force force;
    force.where = face(0, 0.06);
    force.force = {1e-6, -2e-6, 1e-6};  // strains of a hundred-thousandth: linear
    scene.bodies[0].forces = {force};
    const Linear linear = linearise(scene);  // differences: the constant load drops out
    scene.relaxation.enabled = true;
    scene.relaxation.tolerance = bound(1e-5, 1e-9);
    auto sim = simulate(scene, GetParam());
    settle(*sim);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(linear.dof.size())), found = load;
    const auto u = read_texels(*sim, "node_u");
    for (std::size_t i = 0; i < linear.dof.size(); ++i) {
      const auto [slot, component] = linear.dof[i];
      found[i] = u[slot][component];
      for (const NodeForce& f : sim->model().forces) load[i] += f.slot == slot ? f.force[component] : 0;
    }
    const Eigen::VectorXd exact = linear.stiffness.ldlt().solve(load);
    check(std::string(name_of(cut)) + " displacement against K u = R", (found - exact).norm() / exact.norm(),
          bound(2e-4, 1e-4));
    std::printf("  %-58s %lld steps\n", "", static_cast<long long>(sim->step()));
  }
}

TEST_P(StableStep, DivergenceIsReported) {
  for (const Discretization cut : all_cuts()) {
    Scene scene = clamped(cut, 0.45);
    scene.gravity = {0, -9.81, 0};
    auto probe = simulate(scene, GetParam());
    scene.dt = 1.5 * probe->stable_dt();
    auto sim = simulate(scene, GetParam());
    const std::int64_t done = sim->advance(5000);
    ASSERT_TRUE(sim->divergence().has_value()) << name_of(cut);
    const Divergence& d = *sim->divergence();
    std::printf("  %s\n", d.message().c_str());
    EXPECT_LT(done, 5000);
    EXPECT_EQ(d.body, name_of(cut));
    EXPECT_GE(d.element, 0);
    EXPECT_LT(d.element, sim->model().bodies[0].elements());
    EXPECT_EQ(d.last_good_step, sim->step());
    EXPECT_GT(d.step, d.last_good_step);
    EXPECT_LE(d.step, d.last_good_step + 64);
    EXPECT_NEAR(d.dt / d.stable_dt, 1.5, 0.05);
    for (const Vec3d& u : sim->displacements(0)) ASSERT_TRUE(std::isfinite(u[0]) && std::isfinite(u[1]) && std::isfinite(u[2]));
    // The step and the element are those that a run step by step finds.
    auto again = simulate(scene, GetParam(), {0, 1, true});
    again->advance(5000);
    ASSERT_TRUE(again->divergence().has_value());
    EXPECT_EQ(again->divergence()->step, d.step);
    EXPECT_EQ(again->divergence()->element, d.element);
  }
}

PLIANT_ON_BACKENDS(StableStep);

}  // namespace
}  // namespace pliant::physics
