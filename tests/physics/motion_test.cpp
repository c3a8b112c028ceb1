// Motion that a scene gives: fields of displacement and velocity at the start, rotations of prescribed nodes.
#include "physics/harness.h"
#include "support/error_of.h"

namespace pliant::physics {
namespace {

class Motion : public OnBackend {};

const Box kBox{{3, 2, 2}, 0.05};

std::vector<Vec3d> places(const Simulation& sim) {
  std::vector<Vec3d> x = sim.displacements(0);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = plain(eigen(x[n]) + eigen(sim.model().bodies[0].rest[n]));
  return x;
}

AffineField linear_field(const Matrix3d& h, const Vector3d& about = Vector3d::Zero()) {
  AffineField field;
  for (int r = 0; r < 3; ++r) field.linear[r] = plain(h.row(r).transpose());
  field.about = plain(about);
  return field;
}

Matrix3d turned(const Vector3d& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()).toRotationMatrix();
}

/// At rest in another place: no element feels a rotation, and shape matching neither.
TEST_P(Motion, AFieldOfDisplacementThatIsARotationLeavesTheBodyAtRest) {
  const Matrix3d r = turned({1, 2, -0.5}, 70);
  const auto look = [&](Body body, const char* name, double in_float) {
    body.initial.push_back({all_nodes(), {}, linear_field(r - Matrix3d::Identity(), {0.3, 0, -0.1})});
    body.initial.back().displacement.offset = {0.01, 0, 0.02};
    Scene scene;
    scene.bodies = {body};
    scene.dt = 2e-4;
    auto sim = simulate(scene, GetParam());
    sim->advance(100);
    double error = 0;
    const auto x = places(*sim);
    for (std::size_t n = 0; n < x.size(); ++n) {
      const Vector3d about(0.3, 0, -0.1), rest = eigen(sim->model().bodies[0].rest[n]);
      error = std::max(error, (eigen(x[n]) - about - r * (rest - about) - Vector3d(0.01, 0, 0.02)).norm());
    }
    check(std::string(name) + " turned, after 100 steps, over its length", error / 0.15, bound(in_float, 1e-12));
  };
  for (const Discretization cut : all_cuts())
    look(box_body(kBox, cut, material_young(Law::neo_hookean, 3000, 0.45)), name_of(cut), 5e-7);
  for (const ModelType type : {ModelType::flsm, ModelType::hybrid}) {
    Body body = box_body({{6, 4, 4}, 0.025}, Discretization::hex8_bricks, material_young(Law::neo_hookean, 3000, 0.45));
    body.model.type = type;
    look(body, to_string(type), 3e-4);  // it finds the rotation of every region anew in every step, and what is rounded pushes
  }
}

/// An affine stretch stores the energy of its law in the volume, and what swings afterwards has as much.
TEST_P(Motion, AnInitialStretchSwingsWithItsEnergy) {
  Matrix3d h = Matrix3d::Zero();
  h(0, 0) = 0.2;
  h(0, 1) = 0.1;
  h(2, 2) = -0.05;
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8full, Discretization::hex8_bricks}) {
    const Material m = material_young(Law::neo_hookean, 3000, 0.3);
    Scene scene;
    Body body = box_body(kBox, cut, m);
    body.initial.push_back({all_nodes(), {}, linear_field(h)});
    scene.bodies = {body};
    scene.dt = 1e-4;
    auto sim = simulate(scene, GetParam());
    const double stored = kBox.volume() * kernel_test::energy_density(m.law, Matrix3d::Identity() + h, m.parameters);
    double most = 0, worst = 0;
    for (int i = 0; i < 40; ++i) {
      const auto u = read_texels(*sim, "node_u");
      auto v = read_texels(*sim, "node_w");
      sim->advance(1);
      const auto next = read_texels(*sim, "node_w");
      for (std::size_t s = 0; s < v.size(); ++s) v[s] = plain((eigen(v[s]) + eigen(next[s])) / (2 * sim->dt()));
      const Energies e = energies(sim->model(), u, v);
      if (i == 0) {
        check_relative(std::string(name_of(cut)) + " strain energy at the start [J]", e.strain, stored, bound(1e-5, 1e-9));
        EXPECT_LT(e.kinetic, 1e-4 * stored);
      }
      most = std::max(most, e.kinetic);
      worst = std::max(worst, std::abs(e.total() / stored - 1));
      sim->advance(49);
    }
    EXPECT_GT(most, 0.3 * stored) << name_of(cut) << " does not swing";
    check(std::string(name_of(cut)) + " energy over 2000 steps", worst, 2e-3);
  }
}

/// Spin as a field is the spin of angular_velocity, entries add up, and the body keeps its angular momentum.
TEST_P(Motion, AFieldOfVelocitySpinsTheBody) {
  const Vector3d spin(4, 6, -3), half(kBox.size()[0] / 2, kBox.size()[1] / 2, kBox.size()[2] / 2);
  Matrix3d cross;
  cross << 0, -spin[2], spin[1], spin[2], 0, -spin[0], -spin[1], spin[0], 0;
  Scene scene;
  Body body = box_body(kBox, Discretization::hex8_bricks, material_young(Law::neo_hookean, 3000, 0.45));
  body.velocity = {0.1, 0, 0};
  body.initial.push_back({all_nodes(), linear_field(cross, half), {}});
  body.initial.push_back({all_nodes(), {{0, 0.2, 0}, {}, {}}, {}});
  scene.bodies = {body};
  scene.dt = 2e-4;
  auto sim = simulate(scene, GetParam());
  for (std::size_t n = 0; n < sim->model().bodies[0].rest.size(); ++n) {
    const Vector3d r = eigen(sim->model().bodies[0].rest[n]) - half;
    const Vector3d v = eigen(sim->model().velocity[sim->model().bodies[0].slot[n]]);
    ASSERT_LT((v - spin.cross(r) - Vector3d(0.1, 0.2, 0)).norm(), 1e-12);
  }
  const auto momenta_now = [&] {
    auto w = read_texels(*sim, "node_w");
    for (Vec3d& x : w) x = plain(eigen(x) / sim->dt());
    const Momenta m = momenta(sim->model(), read_texels(*sim, "node_u"), w);
    return Vector3d(eigen(m.angular) - eigen(m.centre).cross(eigen(m.linear)));
  };
  const Vector3d before = momenta_now();
  sim->advance(2000);
  check("angular momentum after 2000 steps", (momenta_now() - before).norm() / before.norm(), bound(2e-5, 1e-13));
}

/// Part of a body, a fixed component stays out of it.
TEST_P(Motion, AFieldMovesWhatItsSelectionHolds) {
  Scene scene;
  Body body = box_body(kBox, Discretization::tet4, material_young(Law::neo_hookean, 3000, 0.45));
  body.fixed.push_back({face(0, 0.15), {false, true, false}});
  body.initial.push_back({face(0, 0.15), {}, {{0.01, 0.02, 0}, {}, {}}});
  scene.bodies = {body};
  auto sim = simulate(scene, GetParam());
  const auto u = sim->displacements(0);
  for (std::size_t n = 0; n < u.size(); ++n) {
    const bool chosen = sim->model().bodies[0].rest[n][0] > 0.149;
    EXPECT_NEAR(u[n][0], chosen ? 0.01 : 0, 1e-9);
    EXPECT_EQ(u[n][1], 0);
  }
}

Prescribed rotation(const Vec3d& axis, const Vec3d& about, double angle, const Curve& curve) {
  Prescribed p;
  p.where = face(0, 0.15);
  p.rotate = Rotation{axis, about, angle};
  p.curve = curve;
  return p;
}

/// Once round and a half about an oblique axis: at every step on the circle, as near as float stands for a place.
TEST_P(Motion, RotatedNodesStayOnTheirCircles) {
  const Vector3d axis(2, 1, -0.5), about(0.1, 0.04, 0.06);
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    for (const Integrator integrator : {Integrator::increment, Integrator::textbook}) {
      Scene scene;
      scene.integrator = integrator;
      Body body = box_body(kBox, cut, material_young(Law::neo_hookean, 3000, 0.45));
      body.prescribed.push_back(rotation(plain(axis), plain(about), 540, smooth(0.4)));
      scene.bodies = {body};
      scene.dt = 5e-4;
      auto sim = simulate(scene, GetParam());
      double worst = 0, speed = 0;
      for (int i = 0; i < 90; ++i) {
        sim->advance(10);
        const double now = 540 * smooth(0.4).value(sim->time()), before = 540 * smooth(0.4).value(sim->time() - sim->dt());
        const auto x = places(*sim);
        const auto v = sim->velocities(0);
        for (std::size_t n = 0; n < x.size(); ++n) {
          const Vector3d r = eigen(sim->model().bodies[0].rest[n]) - about;
          if (r[0] + about[0] < 0.149) continue;
          worst = std::max(worst, (eigen(x[n]) - about - turned(axis, now) * r).norm());
          speed = std::max(speed, (eigen(v[n]) - (turned(axis, now) - turned(axis, before)) * r / sim->dt()).norm());
        }
      }
      check(std::string(name_of(cut)) + " distance from the circle [m]", worst, bound(3e-8, 1e-15));
      check(std::string(name_of(cut)) + " speed [m/s]", speed, bound(2e-4, 1e-11));
    }
  }
}

/// A bar is wrung once round: turned at one end about its own axis, its end free along it, which another entry pulls.
TEST_P(Motion, ARotationLeavesAxesToOtherEntries) {
  Scene scene;
  Body body = box_body({{6, 2, 2}, 0.025}, Discretization::hex8_bricks, material_young(Law::neo_hookean, 3000, 0.3));
  body.fixed.push_back({face(0, 0)});
  body.prescribed.push_back(rotation({1, 0, 0}, {0, 0.025, 0.025}, 360, smooth(0.5)));
  body.prescribed.back().axes = {false, true, true};
  body.prescribed.push_back(pull(0, 0.15, 0.03, smooth(0.5)));
  body.material.damping = 20;
  scene.bodies = {body};
  auto sim = simulate(scene, GetParam());
  const auto to = [&](double time) { sim->advance(static_cast<std::int64_t>(std::round((time - sim->time()) / sim->dt()))); };
  to(0.25);
  ASSERT_FALSE(sim->divergence());
  const auto middle = places(*sim);
  const double angle = 360 * smooth(0.5).value(sim->time()), moved = 0.03 * smooth(0.5).value(sim->time());
  to(0.6);
  const auto end = places(*sim);
  for (std::size_t n = 0; n < end.size(); ++n) {
    const Vector3d rest = eigen(sim->model().bodies[0].rest[n]), about(0, 0.025, 0.025);
    if (rest[0] < 0.149) continue;
    EXPECT_LT((eigen(middle[n]) - about - turned({1, 0, 0}, angle) * (rest - about) - Vector3d(moved, 0, 0)).norm(), 1e-7);
    EXPECT_LT((eigen(end[n]) - rest - Vector3d(0.03, 0, 0)).norm(), 1e-8);  // a whole turn is none
  }
  EXPECT_GT(energies(sim->model(), read_texels(*sim, "node_u"), std::vector<Vec3d>(sim->model().slots)).strain, 0.01)
      << "the bar is not wrung";
}

PLIANT_ON_BACKENDS(Motion);

std::string refused(const Body& body) {
  Scene scene;
  scene.bodies = {body};
  scene.bodies[0].name = "bar";
  return test::error_of([&] { build_model(scene); });
}

TEST(Entries, ThatMoveOneComponentDifferentlyAreRefused) {
  const Body plain_body = box_body(kBox, Discretization::tet4, material_young(Law::neo_hookean, 3000, 0.45));
  const auto with = [&](std::vector<Fixed> fixed, std::vector<Prescribed> prescribed) {
    Body body = plain_body;
    body.fixed = std::move(fixed);
    body.prescribed = std::move(prescribed);
    for (std::size_t i = 0; i < body.fixed.size(); ++i) body.fixed[i].where.pointer = "/fixed/" + std::to_string(i);
    for (std::size_t i = 0; i < body.prescribed.size(); ++i)
      body.prescribed[i].where.pointer = "/prescribed/" + std::to_string(i);
    return refused(body);
  };
  const Fixed clamp{face(0, 0.15)}, clamp_x{face(0, 0.15), {true, false, false}};
  const Prescribed x = pull(0, 0.15, 0.02, smooth(1)), x_later = pull(0, 0.15, 0.02, smooth(2)),
                   still = pull(0, 0.15, 0, smooth(1));
  Prescribed y = pull(0, 0.15, 0, smooth(1));
  y.displacement = {std::nullopt, 0.01, std::nullopt};
  Prescribed turn = rotation({1, 0, 0}, {0, 0.1, 0.2}, 90, smooth(1)), turn_yz = turn;
  turn_yz.axes = {false, true, true};
  // What agrees or concerns other components is put together.
  EXPECT_EQ(with({clamp, clamp_x}, {}), "");
  EXPECT_EQ(with({clamp_x}, {y}), "");
  EXPECT_EQ(with({clamp}, {still}), "");
  EXPECT_EQ(with({}, {x, x}), "");
  EXPECT_EQ(with({}, {x, y}), "");
  EXPECT_EQ(with({}, {turn_yz, x}), "");
  EXPECT_EQ(with({clamp_x}, {turn_yz}), "");
  // The node lowest in number is named, with both entries.
  const std::string at =
      ": got the x component of node 3 of body 'bar', at [0.15, 0, 0] m, which two entries move differently: ";
  EXPECT_EQ(with({clamp}, {x}).substr(0, 175),
            ("/prescribed/0" + at + "/fixed/0 holds it, /prescribed/0 moves it by 0.02 m; expected one motion").substr(0, 175));
  EXPECT_NE(with({}, {x, x_later}).find("/prescribed/0 moves it by 0.02 m, /prescribed/1 moves it by 0.02 m"),
            std::string::npos);
  EXPECT_NE(with({}, {y, turn}).find("the y component of node 3 of body 'bar', at [0.15, 0, 0] m"), std::string::npos);
  EXPECT_NE(with({}, {y, turn_yz}).find("/prescribed/0 moves it by 0.01 m, /prescribed/1 rotates it"), std::string::npos);
}

}  // namespace
}  // namespace pliant::physics
