// The energy account of blades: what they do on tissue is no energy from nowhere.
#include <fmt/format.h>

#include "geometry/vec.h"
#include "physics/harness.h"
#include "simulation/measure/energy.h"
#include "support/source_dir.h"

namespace pliant::physics::blade_energy {
namespace {

class BladeEnergy : public OnBackend {};

/// A block of 0.1 m with cells of 10 mm, held at its bottom, undamped; an edge comes down on it, 12 mm deep, and leaves.
std::string pressed_block(double toughness, const std::string& element) {
  return fmt::format(R"({{"format": "pliant-scene/1", "duration": 0.9, "bodies": [{{"name": "block",
      "surface": "meshes/cube.obj", "lattice": {{"spacing": 0.01}}, "element": "{1}", "material": {{"law": "neo-hookean",
      "young": 20000, "poisson": 0.4, "density": 1000, "damping": 0, "toughness": {0}}},
      "fixed": [{{"plane": [[0, -0.0499, 0], [0, -1, 0]]}}]}}],
      "blades": [{{"name": "scalpel", "cuts": "by-force", "edge": 5e-4,
        "path": [[0, 0.0031, 0.0502, -0.05, 0.0031, 0.0502, 0.05], [0.5, 0.0031, 0.038, -0.05, 0.0031, 0.038, 0.05],
                 [0.8, 0.0031, 0.056, -0.05, 0.0031, 0.056, 0.05]]}}]}})",
                     toughness, element);
}

/// The same block, damped; the edge goes 40 mm deep in a second.
std::string cut_block(double damping, const std::string& element, const std::string& method) {
  return fmt::format(R"({{"format": "pliant-scene/1", "duration": 1.1, "gravity": [0, 0, 0], "bodies": [{{"name": "block",
      "surface": "meshes/cube.obj", "lattice": {{"spacing": 0.01}}, "element": "{1}", "material": {{"law": "neo-hookean",
      "young": 20000, "poisson": 0.4, "density": 1000, "damping": {0}, "toughness": 4e4}},
      "fixed": [{{"plane": [[0, -0.0499, 0], [0, -1, 0]]}}]}}],
      "blades": [{{"name": "scalpel", "cuts": "by-force", "edge": 5e-4, "method": "{2}",
        "path": [[0, 0.0031, 0.0502, -0.06, 0.0031, 0.0502, 0.06], [1, 0.0031, 0.01, -0.06, 0.0031, 0.01, 0.06]]}}]}})",
                     damping, element, method);
}

struct Account {
  double share = 0;  ///< created energy, of the largest
  double work = 0, fracture = 0;
};

Account account_of(const std::string& scene, const char* backend) {
  auto sim = simulate(parse_scene(scene, test::source_dir() + "/scenes/pressed_block.json"), backend);
  while (sim->time() < 0.9 && sim->advance(16) > 0) sim->watch_energy();
  const PressedBlade& blade = sim->state().pressed.at("scalpel");
  EXPECT_TRUE(sim->report().energy.share());
  return {sim->report().energy.share().value_or(1), blade.work, blade.fracture};
}

/// A blade that cuts does work, most of it on what gives way; the rest is in the tissue and no surprise there.
TEST_P(BladeEnergy, WorkOfCuttingIsNotCreated) {
  for (const char* element : {"hex8full", "tet4anp"}) {
    const Account a = account_of(pressed_block(4e4, element), GetParam());
    EXPECT_GT(a.fracture, 0) << element;
    check(fmt::format("{}: energy made, over the largest", element), a.share, 1e-3);
  }
}

/// Nor is what it pressed without cutting and gets back when it leaves.
TEST_P(BladeEnergy, WorkOfPressingIsNotCreated) {
  const Account a = account_of(pressed_block(1e9, "hex8full"), GetParam());
  EXPECT_EQ(a.fracture, 0);
  check("energy made, over the largest", a.share, 1e-3);
}

/// Where the work of a blade went: what the tissue holds, what its damping has taken, and what cutting took (docs/cutting.md).
TEST_P(BladeEnergy, WorkIsElasticDissipatedAndFracture) {
  constexpr double kDamping = 20;
  for (const char* method : {"virtual-nodes", "separation"}) {
    for (const char* element : {"hex8full", "tet4anp"}) {
      auto sim = simulate(parse_scene(cut_block(kDamping, element, method), test::source_dir() + "/scenes/cut_block.json"),
                          GetParam());
      double dissipated = 0;  // mass-proportional: a force -c m v at each node
      while (sim->time() < 0.6 && sim->advance(1) == 1) {
        const std::vector<Vec3d> v = by_slot(sim->model(), {sim->velocities(0)});
        for (std::size_t i = 0; i < v.size(); ++i)
          dissipated += kDamping * sim->model().mass[i] * vec::dot(v[i], v[i]) * sim->dt();
      }
      const std::vector<Vec3d> u = by_slot(sim->model(), {sim->displacements(0)});
      const std::vector<Vec3d> v = by_slot(sim->model(), {sim->velocities(0)});
      const PressedBlade& blade = sim->state().pressed.at("scalpel");
      EXPECT_GT(sim->topology_version(), 2);
      EXPECT_GT(dissipated, 0.01 * blade.work);
      const double rest = blade.work - energies(sim->model(), u, v).total() - dissipated - blade.fracture_now();
      check(fmt::format("{}, {}: work less what is known of it, over the work", method, element), std::abs(rest) / blade.work,
            0.005);
    }
  }
}

PLIANT_ON_BACKENDS(BladeEnergy);

}  // namespace
}  // namespace pliant::physics::blade_energy
