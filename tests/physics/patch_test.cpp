// Patch tests on distorted meshes, rigid motions, nodal forces against the energy's differences, and the single hexahedron's
// modes.
#include "physics/harness.h"

namespace pliant::physics {
namespace {

class Patch : public OnBackend {};

Matrix3d gradient() { return (Matrix3d() << 0.10, 0.05, -0.02, 0.03, -0.08, 0.04, -0.01, 0.06, 0.07).finished(); }

/// Every boundary node moves affinely; the inner nodes find their places by themselves.
TEST_P(Patch, InnerNodesFollowAffineBoundary) {
  const Box box{{3, 3, 3}, 1.0 / 3, 0.25, 3};
  const Matrix3d h = gradient();
  for (const Law law : all_laws()) {
    for (const Discretization cut : all_cuts()) {
      const Material m = material_young(law, 3000, 0.45);
      Body body = box_body(box, cut, m);
      Scene scene;
      scene.safety = 0.5;
      scene.relaxation.enabled = true;
      scene.relaxation.tolerance = bound(3e-6, 1e-10);
      scene.bodies = {body};
      const Model free = build_model(scene);
      for (std::size_t n = 0; n < free.bodies[0].rest.size(); ++n) {
        const Vector3d x = eigen(free.bodies[0].rest[n]);
        if (x.minCoeff() > 0.01 && x.maxCoeff() < 0.99) continue;
        Prescribed p;
        p.where.kind = Selection::Kind::nodes;
        p.where.nodes = {static_cast<std::int64_t>(n)};
        for (int c = 0; c < 3; ++c) p.displacement[c] = (h * x)[c];
        p.curve = smooth(1);
        scene.bodies[0].prescribed.push_back(p);
      }
      auto sim = simulate(scene, GetParam());
      settle(*sim);
      const auto u = sim->displacements(0);
      double error = 0;
      for (std::size_t n = 0; n < u.size(); ++n)
        error = std::max(error, (eigen(u[n]) - h * eigen(free.bodies[0].rest[n])).norm());
      const std::string name = std::string(name_of(cut)) + " " + to_string(law);
      check(name + " displacement of inner nodes / size", error, bound(2e-6, 1e-9));
      const Matrix3d p = mean_stress(sim->model(), forces(*sim), 1), exact = first_piola(Matrix3d::Identity() + h, m);
      check(name + " mean stress", (p - exact).norm() / exact.norm(), bound(2e-5, 1e-8));
      // Uniform stress: the energy is that of the affine field, which is the least for these boundary values.
      const auto zero = std::vector<Vec3d>(sim->model().slots);
      const Energies found = energies(sim->model(), read_texels(*sim, "node_u"), zero);
      const Energies affine =
          energies(sim->model(), displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(h * x); }), zero);
      check(name + " energy above the affine field's", (found.strain + found.hourglass) / affine.strain - 1,
            bound(1e-6, 1e-12));
    }
  }
}

TEST_P(Patch, RigidMotionIsForceFree) {
  const Box box{{3, 2, 2}, 0.5, 0.2, 5};
  for (const Law law : all_laws()) {
    for (const Discretization cut : all_cuts()) {
      Scene scene;
      scene.bodies = {box_body(box, cut, material(law, 1000, 9000))};
      auto sim = simulate(scene, GetParam());
      double worst = 0;
      for (const double angle : {0.3, 1.5707963267948966, 2.9, 3.141592653589793}) {
        const Matrix3d r = Eigen::AngleAxisd(angle, Vector3d(0.3, -1, 0.7).normalized()).toRotationMatrix();
        write_texels(*sim, "node_u",
                     displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(r * x - x + Vector3d(2, -3, 1)); }));
        worst = std::max(worst, largest(forces(*sim)));
      }
      const std::string name = std::string(name_of(cut)) + " " + to_string(law);
      // Scale: modulus times the area of a cell's face.
      check(name + " force / (modulus d^2), large rotations", worst / (9000 * 0.25), bound(5e-5, 1e-13));
      write_texels(*sim, "node_u", displaced(sim->model(), [&](const Vector3d&) { return Vector3d(0, 0, 0); }));
      check(name + " force at rest (exactly zero)", largest(forces(*sim)), 0);
    }
  }
}

/// -dW/du of the independent energy equals the backend's force, one node and component at a time.
TEST_P(Patch, ForceIsTheEnergysGradient) {
  const Box box{{2, 2, 2}, 0.5, 0.2, 9};
  for (const Law law : all_laws()) {
    for (const Discretization cut : all_cuts()) {
      Scene scene;
      Material soft = material(law, 1000, 9000), stiff = material(law, 4000, 20000);
      scene.bodies = {box_body(box, cut, soft)};
      Selection half = face(0, 1, 0.5);  // a second batch: elements with their centre at x > 0.5
      scene.bodies[0].inclusions = {{half, stiff}};
      auto sim = simulate(scene, GetParam());
      std::mt19937 random(11);
      const auto noise = [&] { return (static_cast<double>(random()) / 4294967295.0 - 0.5) * 0.12; };
      auto u = displaced(sim->model(),
                         [&](const Vector3d& x) { return Vector3d(gradient() * x + Vector3d(noise(), noise(), noise())); });
      write_texels(*sim, "node_u", u);
      u = read_texels(*sim, "node_u");
      const auto f = forces(*sim);
      const auto zero = std::vector<Vec3d>(sim->model().slots);
      double worst = 0;
      for (const std::int32_t slot : sim->model().bodies[0].slot) {
        for (int c = 0; c < 3; ++c) {
          const double h = 1e-5, at = u[slot][c];
          double w[2];
          for (const int side : {0, 1}) {
            u[slot][c] = at + (side ? h : -h);
            const Energies e = energies(sim->model(), u, zero);
            w[side] = e.strain + e.hourglass;
          }
          u[slot][c] = at;
          worst = std::max(worst, std::abs(f[slot][c] + (w[1] - w[0]) / (2 * h)));
        }
      }
      check(std::string(name_of(cut)) + " " + to_string(law) + " force against differences of energy", worst / largest(f),
            bound(5e-6, 2e-7));
    }
  }
}

PLIANT_ON_BACKENDS(Patch);

/// Stiffness of one element at rest by central differences of the backend's forces [N/m].
Eigen::MatrixXd element_stiffness(Simulation& sim, double size) {
  const auto& slots = sim.model().bodies[0].slot;
  const auto n = static_cast<Eigen::Index>(3 * slots.size());
  Eigen::MatrixXd k(n, n);
  std::vector<Vec3d> u(sim.model().slots);
  for (Eigen::Index j = 0; j < n; ++j) {
    std::array<std::vector<Vec3d>, 2> f;
    for (const int side : {0, 1}) {
      u[slots[j / 3]][j % 3] = (side ? 1e-5 : -1e-5) * size;
      write_texels(sim, "node_u", u);
      f[side] = forces(sim);
    }
    u[slots[j / 3]][j % 3] = 0;
    for (Eigen::Index i = 0; i < n; ++i) k(i, j) = -(f[1][slots[i / 3]][i % 3] - f[0][slots[i / 3]][i % 3]) / (2e-5 * size);
  }
  return 0.5 * (k + k.transpose());
}

/// 24 modes: 6 rigid without energy, 18 with; without hourglass control twelve more have none, and they are hourglass fields.
TEST(SingleHexahedron, Modes) {
  for (const Discretization cut : {Discretization::hex8, Discretization::hex8full, Discretization::hex8_bricks}) {
    for (const double distortion : {0.0, 0.2}) {
      if (distortion > 0 && cut == Discretization::hex8_bricks) continue;
      std::array<Eigen::VectorXd, 2> values;
      for (const int with : {0, 1}) {
        Material m = material_young(Law::neo_hookean, 3000, 0.3);
        m.hourglass = with;
        Scene scene;
        VolumeMesh mesh = make_mesh({{1, 1, 1}, 0.1}, false);
        std::mt19937 random(2);
        for (Vec3d& x : mesh.vertices) {
          for (double& c : x) c += (static_cast<double>(random()) / 4294967295.0 - 0.5) * 0.1 * distortion;
        }
        Body body = box_body({{1, 1, 1}, 0.1}, cut, m);
        if (!is_lattice(cut)) body.mesh = save(mesh);
        scene.bodies = {body};
        auto sim = simulate(scene, "cpu:double");
        values[with] = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(element_stiffness(*sim, 0.1)).eigenvalues();
      }
      const double scale = values[1][23];
      const std::string name = std::string(name_of(cut)) + (distortion > 0 ? " distorted" : "");
      check(name + " largest of the 6 rigid modes", values[1].head(6).cwiseAbs().maxCoeff() / scale, 1e-8);
      std::printf("  %-58s %.3e of the stiffest\n", (name + " softest of the other 18").c_str(), values[1][6] / scale);
      EXPECT_GT(values[1][6], 1e-3 * scale);
      if (cut == Discretization::hex8full) continue;
      check(name + " largest of 18 modes without hourglass control", values[0].head(18).cwiseAbs().maxCoeff() / scale, 1e-8);
      EXPECT_GT(values[0][18], 1e-2 * scale);
    }
  }
}

}  // namespace
}  // namespace pliant::physics
