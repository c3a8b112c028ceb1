// A confined column's first frequency, and the tip-loaded elastica.
#include "physics/harness.h"

namespace pliant::physics {
namespace {

class Vibration : public OnBackend {};

/// Times at which a swinging signal crosses `middle` upwards, interpolated; the mean period between first and last.
double period(const std::vector<std::array<double, 2>>& samples, double middle) {
  std::vector<double> crossings;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double a = samples[i - 1][1] - middle, b = samples[i][1] - middle;
    if (a < 0 && b >= 0) crossings.push_back(samples[i - 1][0] + (samples[i][0] - samples[i - 1][0]) * a / (a - b));
  }
  EXPECT_GE(crossings.size(), 2u);
  return crossings.size() < 2 ? 0 : (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

/// L 0.1 m, E 3000 Pa, nu 0.45, rho 1000: f = sqrt(M / rho) / (4 L) with M = lambda + 2 mu.
TEST_P(Vibration, ConfinedColumn) {
  const Material base = material_young(Law::neo_hookean, 3000, 0.45);
  const double exact = std::sqrt((base.moduli.lambda + 2 * base.moduli.mu) / 1000) / 0.4;
  check_relative("closed form against the published figure [Hz]", exact, 8.4333, 1e-5);
  for (const Law law : all_laws()) {
    for (const Discretization cut : all_cuts()) {
      if (law != Law::neo_hookean && cut != Discretization::hex8_bricks && cut != Discretization::tet4) continue;
      Body body = box_body({{20, 2, 2}, 0.005}, cut, material_young(law, 3000, 0.45));
      body.fixed = {roller(0), {all_nodes(), {false, true, true}}};
      Scene scene;
      scene.bodies = {body};
      auto sim = simulate(scene, GetParam());
      write_texels(*sim, "node_u", displaced(sim->model(), [](const Vector3d& x) {
        return Vector3d(1e-4 * std::sin(M_PI / 2 * x[0] / 0.1), 0, 0);
      }));
      write_texels(*sim, "node_w", std::vector<Vec3d>(sim->model().slots));
      std::vector<std::array<double, 2>> samples;
      while (sim->time() < 0.6) {
        sim->advance(8);
        double tip = 0;
        const auto u = sim->displacements(0);
        for (std::size_t n = 0; n < u.size(); ++n) tip += sim->model().bodies[0].rest[n][0] > 0.0999 ? u[n][0] : 0;
        samples.push_back({sim->time(), tip});
      }
      check_relative(std::string(name_of(cut)) + " " + to_string(law) + " first frequency [Hz]", 1 / period(samples, 0), exact,
                     0.01);
    }
  }
}

/// Tip drop of the inextensible elastica over its length at P L^2 / EI, in double: shoot with the root curvature.
double elastica(double load) {
  const auto shoot = [&](double curvature, double& drop) {
    // theta'' = -load cos(theta), theta(0) = 0, theta'(0) = curvature, wanted theta'(1) = 0; y' = sin(theta).
    const int n = 2000;
    const double h = 1.0 / n;
    Vector3d s(0, curvature, 0);
    const auto rate = [&](const Vector3d& x) { return Vector3d(x[1], -load * std::cos(x[0]), std::sin(x[0])); };
    for (int i = 0; i < n; ++i) {
      const Vector3d a = rate(s), b = rate(s + h / 2 * a), c = rate(s + h / 2 * b), d = rate(s + h * c);
      s += h / 6 * (a + 2 * b + 2 * c + d);
    }
    drop = s[2];
    return s[1];
  };
  double drop = 0;
  const double curvature = root(0, load, [&](double k) { return shoot(k, drop); });
  shoot(curvature, drop);
  return drop;
}

struct Beam {
  Discretization cut;
  int along;                  ///< cells along the beam
  std::array<int, 2> across;  ///< cells over its height (the plane of bending) and its width
  double slenderness;         ///< L / h
};

/// Tip drop over L of a beam of L = 1 m and a square section h x h, nu = 0, clamped at x = 0, with a dead load spread over the
/// tip's nodes. Mass damping near the critical value of the first mode brings it to rest in a known time.
double tip_drop(const char* backend, const Beam& beam, double load) {
  const double h = 1 / beam.slenderness, young = 1e6, density = 1000;
  const double force = load * young * h * h * h * h / 12;
  const double omega = 3.516 * std::sqrt(young * h * h / 12 / density);
  Material m = material_young(Law::saint_venant_kirchhoff, young, 0, density);
  m.damping = 2 * omega;
  const Box box{{beam.along, beam.across[0], beam.across[1]}, h / beam.across[0]};
  Body body = box_body(box, beam.cut, m);
  if (!is_lattice(beam.cut)) {
    VolumeMesh mesh = make_mesh(box, is_tet(beam.cut));
    for (Vec3d& x : mesh.vertices) x = {x[0] / box.size()[0], x[1], x[2] * h / box.size()[2]};
    body.mesh = save(mesh);
  }
  body.fixed.push_back({face(0, 0), {true, true, true}});
  Force tip;
  tip.where = face(0, 1, 1e-5);
  tip.force = {0, -force, 0};
  tip.curve = smooth(2 / omega);
  body.forces.push_back(tip);
  Scene scene;
  scene.bodies = {body};
  scene.safety = 0.8;
  auto sim = simulate(scene, backend);
  const auto drop = [&] {
    double sum = 0;
    int count = 0;
    const auto u = sim->displacements(0);
    for (std::size_t n = 0; n < u.size(); ++n) {
      if (sim->model().bodies[0].rest[n][0] < 1 - 1e-5) continue;
      sum -= u[n][1];
      ++count;
    }
    return sum / count;
  };
  while (sim->time() < 10 / omega && !sim->divergence()) sim->advance(512);
  const double before = drop();
  while (sim->time() < 12 / omega && !sim->divergence()) sim->advance(512);
  EXPECT_FALSE(sim->divergence().has_value()) << sim->divergence()->message();
  EXPECT_NEAR(drop(), before, 0.004 * before) << "not at rest yet";
  return drop();
}

// Which cells bend within 2 %: hex8 with a single layer; hex8full, whose corners cannot follow the curvature, only with many
// layers or with cells much shorter than high; linear tetrahedra with eight to twelve layers, because each has one strain.
// tet4anp equals tet4 here: at nu = 0 it has no volumetric term to average.
std::vector<Beam> beams(double load, bool costly) {
  std::vector<Beam> all{{Discretization::hex8_bricks, 20, {1, 1}, 20},
                        {Discretization::hex8_bricks, 40, {2, 2}, 20},
                        {Discretization::hex8, 20, {1, 1}, 20},
                        {Discretization::hex8, 40, {1, 1}, 20},  // half as long as wide, 2 and 4 times
                        {Discretization::hex8, 10, {1, 1}, 20},
                        {Discretization::hex8, 10, {1, 1}, 40},
                        {Discretization::hex8full, 120, {1, 1}, 20}};
  if (costly && load == 1) all.push_back({Discretization::tet4, 108, {12, 1}, 10});
  if (costly && load == 2) all.push_back({Discretization::hex8full_lattice, 60, {5, 5}, 12});
  if (costly && load > 1) all.push_back({Discretization::tet4, 80, {8, 1}, 10});
  return all;
}

/// `published`: the tip drop over L at this load.
void expect_elastica(const std::string& backend, double load, double published) {
  const double exact = elastica(load);
  check_relative("closed form against the published figure", exact, published, 1e-5);
  // The costly meshes run on one backend; the others compute the same bits, or the same to seven digits.
  for (const Beam& beam : beams(load, backend == "cpu")) {
    const std::string name = std::string(name_of(beam.cut)) + " " + std::to_string(beam.along) + " x " +
                             std::to_string(beam.across[0]) + " x " + std::to_string(beam.across[1]) + ", load " +
                             std::to_string(static_cast<int>(load)) + ": drop / L";
    check_relative(name, tip_drop(backend.c_str(), beam, load), exact, 0.02);
  }
}

// A test for each load, because together they take long.
TEST_P(Vibration, ElasticaOfASmallLoad) { expect_elastica(GetParam(), 1, 0.301721); }
TEST_P(Vibration, ElasticaOfAModerateLoad) { expect_elastica(GetParam(), 2, 0.493457); }
TEST_P(Vibration, ElasticaOfALargeLoad) { expect_elastica(GetParam(), 5, 0.713792); }

PLIANT_ON_BACKENDS(Vibration);

}  // namespace
}  // namespace pliant::physics
