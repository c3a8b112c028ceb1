// The hourglass control of one-point hexahedra that are no cubes: exact in bending, indifferent to rotation, and stable.
#include "elements/elements.h"
#include "physics/harness.h"

namespace pliant::physics::hourglass_test {
namespace {

constexpr double kYoung = 3000;

std::vector<double> brick_record(const Vector3d& size, const Matrix3d& turn, double poisson) {
  std::array<Vec3d, 8> x;
  for (int c = 0; c < 8; ++c) x[c] = plain(turn * Vector3d(size[0] * (c & 1), size[1] * (c >> 1 & 1), size[2] * (c >> 2 & 1)));
  return Hex8::record(x, material_young(Law::neo_hookean, kYoung, poisson), "brick");
}

/// Displacements of the corners of such a brick by a field in its own axes about its middle.
Displacements8 field(const Vector3d& size, const Matrix3d& turn, const std::function<Vector3d(const Vector3d&)>& u) {
  Displacements8 out;
  for (int c = 0; c < 8; ++c) {
    const Vector3d x(size[0] * ((c & 1) - 0.5), size[1] * ((c >> 1 & 1) - 0.5), size[2] * ((c >> 2 & 1) - 0.5));
    out.col(c) = turn * u(x);
  }
  return out;
}

Matrix3d some_turn() { return Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(); }

/// Bent about one axis or about two, and twisted: the energies of beams and plates, for a curvature so small that nothing else
/// counts.
TEST(Hourglass, BricksBendAndTwistWithTheEnergyOfPlates) {
  constexpr double kappa = 1e-4;  // [1/m]
  for (const double poisson : {0.0, 0.3, 0.49}) {
    for (const double aspect : {0.25, 0.5, 1.0, 2.0, 4.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        Vector3d size = Vector3d::Constant(0.01);
        size[axis] *= aspect;
        const double volume = size.prod(), shear = kYoung / (2 * (1 + poisson));
        for (const Matrix3d& turn : {Matrix3d(Matrix3d::Identity()), some_turn()}) {
          const std::vector<double> record = brick_record(size, turn, poisson);
          for (int i = 0; i < 3; ++i) {
            for (int d = 0; d < 3; ++d) {
              if (d == i) continue;
              const int j = 3 - i - d;
              const double second =
                  kappa * kappa * volume * size[d] * size[d] / 12;  // mean square of kappa x_d, times the volume
              // A plate bent along i alone; as a beam, whose other side bends by -nu as much; twisted.
              const auto bent = [&](double with) {
                return hourglass_energy(record, field(size, turn, [&](const Vector3d& x) {
                                          Vector3d u = Vector3d::Zero();
                                          u[i] = kappa * x[i] * x[d];
                                          u[j] = with * kappa * x[j] * x[d];
                                          return u;
                                        }));
              };
              EXPECT_NEAR(bent(0), kYoung / (1 - poisson * poisson) * second / 2, 1e-6 * kYoung * second) << aspect << i << d;
              EXPECT_NEAR(bent(-poisson), kYoung * second / 2, 1e-6 * kYoung * second) << aspect << i << d;
              const double twisted = hourglass_energy(record, field(size, turn, [&](const Vector3d& x) {
                                                        Vector3d u = Vector3d::Zero();
                                                        u[i] = kappa * x[j] * x[d];
                                                        u[j] = kappa * x[i] * x[d];
                                                        u[d] = -kappa * x[i] * x[j];
                                                        return u;
                                                      }));
              EXPECT_NEAR(twisted, shear * 4 * second / 2, 1e-6 * kYoung * second) << aspect << i << d;
            }
          }
        }
      }
    }
  }
}

/// Flat, slender, skewed and wedge-shaped cells.
VolumeMesh distorted_mesh() {
  VolumeMesh mesh = make_mesh({{4, 2, 2}, 0.01, 0.15, 7}, false);
  for (Vec3d& x : mesh.vertices) x = {3 * x[0] + 0.3 * x[1], x[1], 0.5 * x[2]};
  return mesh;
}

Scene distorted_scene() {
  Scene scene;
  Body body;
  body.name = "bar";
  body.element = ElementKind::hex8;
  body.material = material_young(Law::neo_hookean, kYoung, 0.45);
  body.mesh = save(distorted_mesh());
  scene.bodies = {body};
  return scene;
}

TEST(Hourglass, TurnsWithTheBody) {
  auto sim = simulate(distorted_scene(), "cpu:double");
  const auto bent = [](const Vector3d& x) {
    return Vector3d(-6 * x[0] * x[1], 3 * x[0] * x[0] + 20 * x[1] * x[2], 30 * x[0] * x[1]);
  };
  const auto zero = std::vector<Vec3d>(sim->model().slots);
  auto u = displaced(sim->model(), bent);
  write_texels(*sim, "node_u", u);
  const auto rest = forces(*sim);
  const Energies before = energies(sim->model(), u, zero);
  EXPECT_GT(before.hourglass, 0.01 * before.strain);
  for (const double angle : {0.5, 2.0, 3.1}) {
    const Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d(0.2, 1, -0.6).normalized()).toRotationMatrix();
    u = displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(turn * (x + bent(x)) - x); });
    write_texels(*sim, "node_u", u);
    const Energies now = energies(sim->model(), u, zero);
    check("hourglass energy of a turned body", now.hourglass / before.hourglass - 1, 1e-9);
    const auto f = forces(*sim);
    double worst = 0;
    for (std::size_t s = 0; s < f.size(); ++s) worst = std::max(worst, (eigen(f[s]) - turn * eigen(rest[s])).norm());
    check("force of a turned body", worst / largest(rest), 1e-9);
  }
}

/// Let go bent and stretched, at a share of the step that the engine chooses for small strain: largest change of the energy.
double swing(double share, int steps) {
  Scene scene = distorted_scene();
  scene.bodies[0].fixed = {{face(0, 0, 0.01), {true, true, true}}};
  scene.dt = share * simulate(scene, "cpu")->dt();
  auto sim = simulate(scene, "cpu");
  const auto bent = [](const Vector3d& x) { return Vector3d(0.03 * x[0], x[0] * x[0], 5 * x[0] * x[1]); };
  write_texels(*sim, "node_u", displaced(sim->model(), bent));
  const auto total = [&] {
    const auto u = read_texels(*sim, "node_u");
    auto v = read_texels(*sim, "node_w");
    sim->advance(1);
    const auto next = read_texels(*sim, "node_w");
    for (std::size_t s = 0; s < v.size(); ++s) v[s] = plain((eigen(v[s]) + eigen(next[s])) / (2 * sim->dt()));
    return energies(sim->model(), u, v);
  };
  const double start = total().total();
  double most = 0;
  for (int i = 0; i < steps / 100; ++i) {
    sim->advance(99);
    EXPECT_FALSE(sim->divergence().has_value()) << sim->divergence()->message();
    if (sim->divergence()) break;
    const Energies now = total();
    EXPECT_GT(now.hourglass, 0);
    most = std::max(most, std::abs(now.total() / start - 1));
  }
  return most;
}

TEST(Hourglass, KeepsItsEnergyForManySteps) {
  // Near the limit of the step the energy of fast modes is not quite what central differences keep.
  check("change of energy in 8000 steps", swing(1, 8000), 0.1);
  check("change of energy in 16000 steps of a quarter", swing(0.25, 16000), 0.005);
}

/// The bound of the stiffness that ballast uses is above the stiffness, by differences of the energy, and not far above.
TEST(Hourglass, BoundsItsStiffness) {
  const Vector3d size(0.04, 0.01, 0.005);
  const std::vector<double> record = brick_record(size, some_turn(), 0.3);
  for (const double strain : {0.0, 0.3}) {
    Displacements8 u = field(size, some_turn(), [&](const Vector3d& x) {
      return Vector3d(strain * x[0] * (1 + 20 * x[1]), -strain * x[1], strain * x[2] * (1 + 10 * x[0]));
    });
    const double h = 1e-6;
    Eigen::Matrix<double, 24, 24> k;
    for (int i = 0; i < 24; ++i) {
      for (int j = 0; j < 24; ++j) {
        const auto at = [&](double di, double dj) {
          Displacements8 moved = u;
          moved(i % 3, i / 3) += di;
          moved(j % 3, j / 3) += dj;
          return hourglass_energy(record, moved);
        };
        k(i, j) = (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4 * h * h);
      }
    }
    const double most = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 24, 24>>(k).eigenvalues()[23];
    const double bound = hourglass_bound(record, u);
    EXPECT_GE(bound, 0.999 * most) << strain;
    EXPECT_LE(bound, 1.5 * most) << strain;
  }
}

}  // namespace
}  // namespace pliant::physics::hourglass_test
