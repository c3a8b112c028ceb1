// An element pressed through itself and released comes back with every law, with the same bits everywhere; with "inverted":
// "stop" it does so only if the law is finite for J <= 0 as it is.
#include "physics/harness.h"
#include "program/hash.h"

namespace pliant::physics {
namespace {

/// A cube whose upper face is pressed along x, beyond the lower one, and released; it moves along x only.
Scene pressed(Discretization cut, Law law, Inverted inverted) {
  const double edge = 0.1;
  const Material m = material(law, 1000, 9000, 1000);
  Body body = box_body({{1, 1, 1}, edge}, cut, m);
  body.material.damping = 60;
  body.fixed = {roller(0), {all_nodes(), {false, true, true}}};
  Force push;
  push.where = face(0, edge);
  // Where the law has a barrier at J = 0, its continuation is as stiff.
  push.force = {(law_info(law).invertible ? -1.5 : -15) * (m.moduli.lambda + 2 * m.moduli.mu) * edge * edge, 0, 0};
  push.curve.kind = Curve::Kind::table;
  push.curve.table = {{0, 0}, {0.05, 1}, {0.3, 1}, {0.35, 0}};
  body.forces = {push};
  Scene scene;
  scene.inverted = inverted;
  scene.bodies = {body};
  scene.dt = 2e-4;
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

TEST(Inversion, AnElementPressedThroughItselfComesBack) {
  for (const Law law : all_laws()) {
    for (const Discretization cut : all_cuts()) {
      SCOPED_TRACE(std::string(name_of(cut)) + " " + to_string(law));
      std::vector<std::string> hashes;
      for (const BackendInfo& info : list_backends()) {
        if (info.name != "cpu" && info.name != "opencl:0") continue;
        auto sim = simulate(pressed(cut, law, Inverted::recover), info.name.c_str());
        double least = 1;
        // Both go in and out again; one of them comes to rest.
        for (int i = 0; i < (info.name == "cpu" ? 100 : 30) && !sim->divergence(); ++i) {
          sim->advance(100);
          least = std::min(least, stretch(*sim));
          if (i == 29) hashes.push_back(hash_text(sim->hash()));
        }
        EXPECT_FALSE(sim->divergence());
        EXPECT_LT(least, 0);
        EXPECT_GT(sim->report().inversions.batches, 0);
        EXPECT_EQ(sim->report().inversions.last, 0);
        if (info.name != "cpu") continue;
        std::printf("  %s %s: least stretch %.3f, %lld elements inverted at a time\n", name_of(cut), to_string(law), least,
                    static_cast<long long>(sim->report().inversions.most));
        EXPECT_NEAR(stretch(*sim), 1, 1e-5);
      }
      EXPECT_TRUE(hashes.size() < 2 || hashes[0] == hashes[1]);
    }
  }
}

TEST(Inversion, WithStopItEndsTheRunUnlessTheLawIsFinite) {
  for (const Law law : all_laws()) {
    for (const Discretization cut : all_cuts()) {
      SCOPED_TRACE(std::string(name_of(cut)) + " " + to_string(law));
      auto sim = simulate(pressed(cut, law, Inverted::stop), "cpu");
      double least = 1;
      for (int i = 0; i < 20 && !sim->divergence(); ++i) {
        sim->advance(100);
        least = std::min(least, stretch(*sim));
      }
      EXPECT_TRUE(!law_info(law).invertible || (!sim->divergence() && least < -0.1));
      if (!law_info(law).invertible) {  // laws with a barrier at J = 0 may hold; nobody passes it unseen
        EXPECT_TRUE(sim->divergence() || least > 0) << "least stretch " << least;
      }
    }
  }
}

}  // namespace
}  // namespace pliant::physics
