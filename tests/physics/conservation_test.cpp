// Momenta of a free spinning body, energy without damping, free fall, decay by damping, prescribed motion and loads.
#include "physics/harness.h"
#include "simulation/step/applied_loads.h"

namespace pliant::physics {
namespace {

class Conservation : public OnBackend {};

/// State at the middle of a step: u_n with the central velocity (w_n + w_(n+1)) / 2h, in the frame that moves with `frame`
/// [m/s].
Energies central_energies(Simulation& sim, const DeadLoads& loads = {}, const Vec3d& frame = {}) {
  const auto u = read_texels(sim, "node_u");
  auto v = read_texels(sim, "node_w");
  sim.advance(1);
  const auto next = read_texels(sim, "node_w");
  for (std::size_t s = 0; s < v.size(); ++s) v[s] = plain((eigen(v[s]) + eigen(next[s])) / (2 * sim.dt()) - eigen(frame));
  return energies(sim.model(), u, v, loads);
}

TEST_P(Conservation, FreeSpinningBody) {
  const Box box{{4, 2, 2}, 0.05, 0.2, 4};
  for (const Discretization cut : all_cuts()) {
    Scene scene;
    Body body = box_body(box, cut, material_young(Law::neo_hookean, 3000, 0.45));
    body.velocity = {0.3, -0.2, 0.1};
    body.angular_velocity = {4, 6, -3};
    scene.bodies = {body};
    scene.dt = 3e-4;
    auto sim = simulate(scene, GetParam());
    ASSERT_LT(scene.dt, 0.8 * sim->stable_dt());
    const Momenta before = momenta_of(*sim);
    const double energy = central_energies(*sim).total();
    const int steps = 4000;
    double drift = 0, late = 0;
    for (int i = 0; i < 40; ++i) {
      sim->advance(steps / 40 - 1);
      const double now = central_energies(*sim).total() / energy - 1;
      drift = std::max(drift, std::abs(now));
      if (i >= 30) late += now / 10;
    }
    const Momenta after = momenta_of(*sim);
    const std::string name = name_of(cut);
    // Linear momentum: float rounds every increment, a random walk over 4000 steps.
    check(name + " linear momentum", (eigen(after.linear) - eigen(before.linear)).norm() / eigen(before.linear).norm(),
          bound(5e-6, 1e-13));
    // About the centre of mass, from the angular momentum about the origin.
    const auto spin = [](const Momenta& m) { return Vector3d(eigen(m.angular) - eigen(m.centre).cross(eigen(m.linear))); };
    check(name + " angular momentum", (spin(after) - spin(before)).norm() / spin(before).norm(), bound(2e-5, 1e-13));
    check(name + " largest change of energy in 4000 steps", drift, 2e-5);
    check(name + " mean change of energy in the last quarter", late, 2e-5);
  }
}

/// Six hundred body lengths away: without RunState::offset a float has 1e-4 of an element's edge left there.
TEST_P(Conservation, BodyThatFliesFarAway) {
  const Vec3d velocity{32, -16, 8};
  for (const Discretization cut : all_cuts()) {
    Scene scene;
    Body body = box_body({{4, 2, 2}, 0.05, 0.2, 4}, cut, material_young(Law::neo_hookean, 3000, 0.45));
    body.velocity = velocity;
    body.angular_velocity = {4, 6, -3};
    scene.bodies = {body};
    scene.dt = 2.44140625e-4;  // 2^-12, so that only the displacement is rounded by flying
    auto sim = simulate(scene, GetParam());
    const double energy = central_energies(*sim, {}, velocity).total();
    const int steps = 16383;
    sim->advance(steps - 1);
    const double change = central_energies(*sim, {}, velocity).total() / energy - 1;
    const std::string name = name_of(cut);
    check(name + " change of inner energy in 16384 steps", change, bound(5e-4, 1e-5));
    const Momenta after = momenta_of(*sim);
    const std::vector<Vec3d> still(sim->model().mass.size());
    const Vector3d flown = eigen(after.centre) - eigen(momenta(sim->model(), still, still).centre);
    check(name + " way flown", (flown - sim->time() * eigen(velocity)).norm() / flown.norm(), bound(1e-5, 1e-9));
    const std::vector<Vec3d> surface = sim->surface_positions();
    if (!surface.empty()) {
      Vector3d mean = Vector3d::Zero();
      for (const Vec3d& x : surface) mean += eigen(x) / static_cast<double>(surface.size());
      check(name + " surface beside its centre of mass", (mean - eigen(after.centre)).norm(), 0.005);
    }
  }
}

TEST_P(Conservation, EnergyOfAVibratingBody) {
  for (const Discretization cut : all_cuts()) {
    Scene scene;
    Body body = box_body({{4, 2, 2}, 0.05, 0.2, 4}, cut, material_young(Law::neo_hookean, 3000, 0.3));
    body.fixed.push_back({face(0, 0), {true, true, true}});
    Force force;
    force.where = face(0, 0.2);
    force.force = {0, 0.05, 0.02};
    body.forces.push_back(force);
    scene.bodies = {body};
    scene.gravity = {0, -1, 0};
    scene.dt = 2e-4;
    auto sim = simulate(scene, GetParam());
    const DeadLoads loads{scene.gravity, 0};
    double largest_kinetic = 0, low = 1e300, high = -1e300, early = 0, late = 0;
    for (int i = 0; i < 100; ++i) {
      sim->advance(39);
      const Energies e = central_energies(*sim, loads);
      largest_kinetic = std::max(largest_kinetic, e.kinetic);
      low = std::min(low, e.total());
      high = std::max(high, e.total());
      (i < 50 ? early : late) += e.total() / 50;
    }
    const std::string name = name_of(cut);
    check(name + " swing of the total over the kinetic energy", (high - low) / largest_kinetic, 2e-5);
    check(name + " drift between the halves of 4000 steps", (late - early) / largest_kinetic, bound(1e-5, 1e-6));
    check(name + " total against its start, zero", late / largest_kinetic, 2e-5);
  }
}

TEST_P(Conservation, FreeFall) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    Scene scene;
    Body body = box_body({{2, 2, 2}, 0.05}, cut, material_young(Law::neo_hookean, 3000, 0.45));
    scene.bodies = {body};
    scene.gravity = {1, -9.81, 2};
    scene.dt = 1.0 / 2048;
    auto sim = simulate(scene, GetParam());
    sim->advance(2048);
    double error = 0;
    for (const Vec3d& u : sim->displacements(0)) error = std::max(error, (eigen(u) - 0.5 * eigen(scene.gravity)).norm());
    check(std::string(name_of(cut)) + " fall of g t^2 / 2 in 1 s, 2048 steps", error / (0.5 * eigen(scene.gravity).norm()),
          bound(1e-5, 1e-9));
  }
}

/// Gravity that grows as g t / T moves a free body by g t^3 / 6T, whichever kernel updates its nodes; central differences begin
/// with a_0 = 0 and sum to g t (t^2 - h^2) / 6T.
TEST_P(Conservation, FallUnderGravityThatGrows) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    for (const ModelType type : {ModelType::tled, ModelType::flsm}) {
      if (type == ModelType::flsm && cut == Discretization::tet4) continue;
      Scene scene;
      Body body = box_body({{4, 4, 4}, 0.05}, cut, material_young(Law::neo_hookean, 3000, 0.45));
      body.model.type = type;
      scene.bodies = {body};
      scene.gravity = {1, -9.81, 2};
      scene.gravity_curve.kind = Curve::Kind::ramp;
      scene.gravity_curve.duration = 2;
      scene.dt = 1.0 / 2048;
      auto sim = simulate(scene, GetParam());
      sim->advance(2048);
      const Vector3d exact = eigen(scene.gravity) / 12 * (1 - scene.dt * scene.dt);
      double error = 0;
      for (const Vec3d& u : sim->displacements(0)) error = std::max(error, (eigen(u) - exact).norm());
      check(std::string(name_of(cut)) + " " + to_string(type) + " fall of g t^3 / 6T", error / exact.norm(), bound(2e-5, 1e-9));
    }
  }
}

/// Without elastic forces every velocity decays as exp(-c t): a body thrown, damped.
TEST_P(Conservation, DampingOfAThrownBody) {
  Scene scene;
  Material m = material_young(Law::neo_hookean, 3000, 0.45);
  m.damping = 5;
  Body body = box_body({{2, 2, 2}, 0.05}, Discretization::tet4, m);
  body.velocity = {1, 0.5, -0.2};
  scene.bodies = {body};
  scene.dt = 2e-4;
  auto sim = simulate(scene, GetParam());
  sim->advance(2500);
  const double travelled = (1 - std::exp(-5 * 0.5)) / 5;
  double error = 0;
  for (const Vec3d& u : sim->displacements(0)) error = std::max(error, (eigen(u) / travelled - eigen(body.velocity)).norm());
  check("path v (1 - exp(-c t)) / c", error, bound(1e-4, 1e-6));
}

/// One degree of freedom: a column's first mode decays as exp(-c t / 2).
TEST_P(Conservation, DampedVibration) {
  Scene scene;
  Material m = material_young(Law::neo_hookean, 3000, 0.3);
  m.damping = 8;
  Body body = box_body({{8, 1, 1}, 0.0125}, Discretization::hex8_bricks, m);
  body.fixed = {roller(0), {all_nodes(), {false, true, true}}};
  scene.bodies = {body};
  scene.dt = 2e-4;
  auto sim = simulate(scene, GetParam());
  write_texels(*sim, "node_u", displaced(sim->model(), [](const Vector3d& x) {
    return Vector3d(1e-4 * std::sin(M_PI / 2 * x[0] / 0.1), 0, 0);
  }));
  write_texels(*sim, "node_w", std::vector<Vec3d>(sim->model().slots));
  // Peaks of the tip's motion, with a parabola through the largest of three samples.
  std::vector<std::array<double, 2>> peaks;
  const auto tip = [&] {
    double sum = 0;
    const auto u = sim->displacements(0);
    for (std::size_t n = 0; n < u.size(); ++n) sum += sim->model().bodies[0].rest[n][0] > 0.0999 ? u[n][0] / 4 : 0;
    return sum;
  };
  double a = tip(), b = a;
  for (int i = 0; i < 2500 && peaks.size() < 4; ++i) {
    sim->advance(4);
    const double c = tip();
    if (i > 3 && b > a && b > c) {
      const double shift = 0.5 * (a - c) / (a - 2 * b + c);
      peaks.push_back({sim->time() + (shift - 1) * 4 * sim->dt(), b - 0.25 * (a - c) * shift});
    }
    a = b;
    b = c;
  }
  ASSERT_EQ(peaks.size(), 4u);
  const double rate = std::log(peaks[0][1] / peaks[3][1]) / (peaks[3][0] - peaks[0][0]);
  check_relative("decay rate c / 2 [1/s]", rate, 4, 1e-3);
}

TEST_P(Conservation, PrescribedMotion) {
  Scene scene;
  Curve ramp, table;
  ramp.kind = Curve::Kind::ramp;
  ramp.start = 0.01;
  ramp.duration = 0.02;
  table.kind = Curve::Kind::table;
  table.table = {{0, 0}, {0.01, 0.5}, {0.02, -0.25}, {0.04, 1}};
  const std::vector<std::pair<Curve, std::function<double(double)>>> cases{
      {ramp, [](double t) { return std::min(1.0, std::max(0.0, (t - 0.01) / 0.02)); }},
      {smooth(0.03),
       [](double t) {
         const double s = std::min(1.0, t / 0.03);
         return 10 * std::pow(s, 3) - 15 * std::pow(s, 4) + 6 * std::pow(s, 5);
       }},
      {table, [](double t) {
         return t < 0.01 ? 50 * t : t < 0.02 ? 0.5 - 75 * (t - 0.01) : t < 0.04 ? -0.25 + 62.5 * (t - 0.02) : 1.0;
       }}};
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    for (const auto& [curve, value] : cases) {
      Body body = box_body({{2, 2, 2}, 0.05}, cut, material_young(Law::neo_hookean, 3000, 0.45));
      body.fixed.push_back(roller(0));
      body.prescribed.push_back(pull(0, 0.1, 0.01, curve));
      scene.bodies = {body};
      scene.dt = 1e-4;
      auto sim = simulate(scene, GetParam());
      double error = 0;
      while (sim->step() < 450) {
        sim->advance(7);
        const auto u = sim->displacements(0);
        for (std::size_t n = 0; n < u.size(); ++n) {
          if (sim->model().bodies[0].rest[n][0] > 0.0999)
            error = std::max(error, std::abs(u[n][0] - 0.01 * value(sim->time())));
          if (sim->model().bodies[0].rest[n][0] < 1e-6) error = std::max(error, std::abs(u[n][0]));
        }
      }
      check(std::string(name_of(cut)) + " prescribed motion / 0.01 m", error / 0.01, bound(2e-7, 1e-13));
    }
  }
}

Vector3d total(const std::vector<Vec3d>& f) {
  Vector3d sum = Vector3d::Zero();
  for (const Vec3d& x : f) sum += eigen(x);
  return sum;
}

TEST_P(Conservation, TotalOfLoads) {
  for (const Discretization cut : all_cuts()) {
    Body plain_body = box_body({{3, 2, 2}, 0.05, 0.2, 6}, cut, material_young(Law::neo_hookean, 3000, 0.45));
    const std::string name = name_of(cut);
    const Matrix3d h = (Matrix3d() << 0.2, 0.1, 0, -0.1, 0.1, 0.3, 0.1, 0, -0.2).finished();
    const auto loads_at = [&](const Body& body) {
      Scene scene;
      scene.bodies = {body};
      scene.dt = 1e-4;
      auto sim = simulate(scene, GetParam());
      write_texels(*sim, "node_u", displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(h * x); }));
      const Vector3d sum = total(forces(*sim));  // the internal forces cancel
      // What probes call the force is made by other code, in double.
      check(name + " applied loads", (total(applied_loads(*sim, 0)) - sum).norm() / 10, bound(1e-5, 1e-12));
      return sum;
    };
    Body body = plain_body;
    Force force;
    force.where = face(0, 0.15);
    force.force = {1, -2, 3};
    body.forces = {force};
    check(name + " total of a force on a face", (loads_at(body) - Vector3d(1, -2, 3)).norm() / std::sqrt(14.0),
          bound(1e-5, 1e-12));
    const double read = is_lattice(cut) ? 1e-7 : 1e-12;  // surface files are read in float
    body = plain_body;
    Pressure pressure;
    pressure.pressure = 500;
    body.pressures = {pressure};
    check(name + " closed surface: no resultant / p A", loads_at(body).norm() / (500 * 0.01), bound(1e-5, read));
    pressure.where = face(0, 0.15);
    body.pressures = {pressure};
    // Nanson: the deformed face's area vector is cof F n A, and pressure pushes inwards.
    const Matrix3d f = Matrix3d::Identity() + h;
    const Vector3d exact = -500 * 0.01 * f.determinant() * f.inverse().transpose() * Vector3d(1, 0, 0);
    check(name + " follower pressure on a deformed face", (loads_at(body) - exact).norm() / exact.norm(), bound(1e-5, read));
  }
}

TEST_P(Conservation, WeightAndHandsAreApplied) {
  Scene scene;
  scene.bodies = {box_body({{3, 2, 2}, 0.05, 0.2, 6}, all_cuts()[0], material_young(Law::neo_hookean, 3000, 0.45))};
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "other";
  scene.gravity = {1, -9, 0.5};
  scene.gravity_curve.kind = Curve::Kind::ramp;
  scene.gravity_curve.duration = 0.01;
  scene.dt = 1e-4;
  scene.interactive = true;
  auto sim = simulate(scene, GetParam());
  sim->advance(50);
  sim->set_forces({{1, 3, {0.1, 0.2, -0.3}}});
  const double weight = 0.5 * sim->model().bodies[0].mass;
  for (std::size_t b = 0; b < 2; ++b) {
    const Vector3d hand = b == 0 ? Vector3d(0, 0, 0) : Vector3d(0.1, 0.2, -0.3);
    const Vector3d exact = weight * Vector3d(1, -9, 0.5) + hand;
    check("applied loads", (total(applied_loads(*sim, b)) - exact).norm() / exact.norm(), 1e-12);
  }
}

/// Of part of a body: what an energy is of a cut-out of the same mesh; of all of it: the body's.
TEST_P(Conservation, EnergyAmongNodes) {
  const Matrix3d h = (Matrix3d() << 0.2, 0.1, 0, -0.1, 0.1, 0.3, 0.1, 0, -0.2).finished();
  for (const Discretization cut : all_cuts()) {
    Scene scene;
    scene.bodies = {box_body({{4, 2, 2}, 0.05, 0, 4}, cut, material_young(Law::neo_hookean, 3000, 0.45))};
    auto sim = simulate(scene, GetParam());
    const Model& m = sim->model();
    const auto u = displaced(m, [&](const Vector3d& x) { return Vector3d(h * x); });
    const auto v = displaced(m, [&](const Vector3d& x) { return Vector3d(x[1], 1, -2 * x[0]); });
    const Energies whole = energies(m, u, v), all = energies_among(m, u, v, std::vector<char>(u.size(), 1));
    const std::string name = name_of(cut);
    check(name + " strain energy of all", std::abs(all.strain / whole.strain - 1), 1e-14);
    check(name + " kinetic energy of all", std::abs(all.kinetic / whole.kinetic - 1), 1e-14);
    check(name + " hourglass energy of all", std::abs(all.hourglass - whole.hourglass), 1e-16);
    std::vector<char> some(u.size(), 0);
    for (std::size_t s = 0; s < some.size(); ++s) some[s] = m.rest[s][0] < 0.151 ? 1 : 0;
    const Energies part = energies_among(m, u, v, some);
    // Uniform strain: three of four layers of cells. The nodes in the three hold more mass than their cells.
    check(name + " strain energy of three quarters", std::abs(part.strain / whole.strain - 0.75), 1e-6);
    EXPECT_GT(part.kinetic, 0.1 * whole.kinetic);
    EXPECT_LT(part.kinetic, 0.99 * whole.kinetic);
    EXPECT_EQ(energies_among(m, u, v, std::vector<char>(u.size(), 0)).total(), 0);
  }
}

/// Negative pressure on one face of a block on rollers: P = p times the area ratio, with the closed form's lateral stretch.
TEST_P(Conservation, PressurePullsABlock) {
  const Material m = material_young(Law::neo_hookean, 3000, 0.3);
  const auto lateral = [&](double s) {
    return root(0.2, 3, [&](double l) { return first_piola(Vector3d(s, l, l).asDiagonal(), m)(1, 1); });
  };
  const double p = 600;
  // Cauchy stress p on the deformed area: P11 = p lateral^2.
  const double stretch = root(1, 2, [&](double s) {
    const double l = lateral(s);
    return first_piola(Vector3d(s, l, l).asDiagonal(), m)(0, 0) - p * l * l;
  });
  for (const Discretization cut : all_cuts()) {
    Body body = box_body({{2, 2, 2}, 0.5, 0.1, 8}, cut, m);
    for (int axis = 0; axis < 3; ++axis) body.fixed.push_back(roller(axis));
    Pressure pressure;
    pressure.where = face(0, 1);
    pressure.pressure = -p;
    body.pressures = {pressure};
    Scene scene;
    scene.bodies = {body};
    scene.safety = 0.5;
    scene.relaxation.enabled = true;
    scene.relaxation.tolerance = bound(1e-5, 1e-9);
    auto sim = simulate(scene, GetParam());
    settle(*sim);
    double mean = 0;
    int count = 0;
    const auto u = sim->displacements(0);
    for (std::size_t n = 0; n < u.size(); ++n) {
      if (sim->model().bodies[0].rest[n][0] < 0.999) continue;
      mean += u[n][0];
      ++count;
    }
    // Consistent for tetrahedra; the two triangles of a hexahedron's face load its corners unevenly.
    check_relative(std::string(name_of(cut)) + " stretch under follower pressure", 1 + mean / count, stretch,
                   is_tet(cut) ? bound(1e-5, 1e-8) : 1e-3);
  }
}

PLIANT_ON_BACKENDS(Conservation);

}  // namespace
}  // namespace pliant::physics
