// Laws that are finite for J <= 0: an element pressed through itself and released comes back, with the same bits everywhere.
// Other laws report it.
#include "physics/harness.h"
#include "program/hash.h"

namespace pliant::physics {
namespace {

/// A cube whose upper face is pressed along x, beyond the lower one, and released; it moves along x only.
Scene pressed(Discretization cut, Law law) {
  const double edge = 0.1;
  const Material m = material(law, 1000, 9000, 1000);
  Body body = box_body({{1, 1, 1}, edge}, cut, m);
  body.material.damping = 60;
  body.fixed = {roller(0), {all_nodes(), {false, true, true}}};
  Force push;
  push.where = face(0, edge);
  push.total = {-1.5 * (m.moduli.lambda + 2 * m.moduli.mu) * edge * edge, 0, 0};
  push.curve.kind = Curve::Kind::table;
  push.curve.table = {{0, 0}, {0.05, 1}, {0.3, 1}, {0.35, 0}};
  body.forces = {push};
  Scene scene;
  scene.bodies = {body};
  scene.dt = 1e-3;
  return scene;
}

/// x / edge of the pressed face: F = diag(x / edge, 1, 1) on average.
double stretch(const Simulation& sim) {
  double sum = 0, count = 0;
  const auto& rest = sim.model().bodies[0].rest;
  const auto u = sim.displacements(0);
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (rest[n][0] < 0.0999) continue;
    sum += (rest[n][0] + u[n][0]) / 0.1;
    ++count;
  }
  return sum / count;
}

TEST(Inversion, AnElementPressedThroughItselfComesBackIfTheLawIsFinite) {
  for (const Law law : all_laws()) {
    for (const Discretization cut : all_cuts()) {
      SCOPED_TRACE(std::string(name_of(cut)) + " " + to_string(law));
      std::vector<std::string> hashes;
      for (const BackendInfo& info : list_backends()) {
        if (info.name != "cpu" && info.name != "opencl:0") continue;
        auto sim = simulate(pressed(cut, law), info.name.c_str());
        double least = 1;
        for (int i = 0; i < 100 && !sim->divergence(); ++i) {
          sim->advance(20);
          least = std::min(least, stretch(*sim));
        }
        EXPECT_EQ(sim->divergence().has_value(), !law_info(law).invertible);
        if (!law_info(law).invertible) continue;
        std::printf("  %-20s %-20s %-9s least x / edge %9.6f, at the end %.9f, hash %s\n", to_string(law), name_of(cut),
                    info.name.c_str(), least, stretch(*sim), hash_text(sim->hash()).c_str());
        EXPECT_LT(least, -0.1);
        EXPECT_NEAR(stretch(*sim), 1, 1e-5);
        hashes.push_back(hash_text(sim->hash()));
      }
      if (hashes.size() == 2) EXPECT_EQ(hashes[0], hashes[1]);
    }
  }
}

}  // namespace
}  // namespace pliant::physics
