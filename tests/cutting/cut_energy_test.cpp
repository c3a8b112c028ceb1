// What cuts do to energy: nothing.
#include <gtest/gtest.h>

#include "cutting/cut_scenes.h"
#include "simulation/measure/energy.h"

namespace pliant::cut_test {
namespace {

double strain_energy(const Simulation& s) {
  const Energies e = energies(s.model(), by_slot(s.model(), {s.displacements(0)}), by_slot(s.model(), {s.velocities(0)}));
  return e.strain + e.hourglass;
}

TEST(CutEnergy, ACutThroughCopiesThatHaveMovedApartCreatesNoEnergy) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
    Body body = box_body("box", {0.06, 0.03, 0.03}, element);
    hold(body, {0.001, 0, 0}, {-1, 0, 0});
    pull(body, {0.059, 0, 0}, {1, 0, 0}, {0.02, 0.01, 0}, 0.1);
    Simulation s(scene_with(body), open_backend("cpu:double"));
    const auto move = [&](const char* name, double x, double y) { return s.move_blade(name, {{{x, y, -1}, {x, y, 1}}}); };
    s.advance(s.next_batch(1));
    move("across", 0.031, -1);
    move("across", 0.034, 0.017);  // askew, and not through
    while (s.time() < 0.2) s.advance(s.next_batch(64));
    ASSERT_FALSE(s.divergence());
    const double before = strain_energy(s);
    move("along", -1, 0.013);
    EXPECT_TRUE(move("along", 1, 0.016).changed);
    EXPECT_NEAR(strain_energy(s) / before, 1, 1e-4) << to_string(element) << " (thin copies take stiffness from the others)";
  }
}

}  // namespace
}  // namespace pliant::cut_test
