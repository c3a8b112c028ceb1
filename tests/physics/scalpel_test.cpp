// Blades that cut by force: the edge indents tissue as a rigid line does, gives way at F* = K_I kappa zeta dA, and what it does
// is what tissue stores, moves with and loses.
#include <fmt/format.h>

#include <map>

#include "physics/harness.h"
#include "statics/statics.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant::physics {
namespace {

class Scalpel : public OnBackend {};

struct Press {
  double speed = 0.02, toughness = 1e9, sharpness = 1, integrity = 1, edge = 5e-4, damping = 60;
  std::string element = "hex8full", extra{};
  double depth = 0.012, x = 0;
};

/// A block of 0.1 m with cells of 10 mm, held at its bottom; an edge comes down on a line of nodes at its top, x = 0.
Scene pressed_block(const Press& p) {
  const double end = 0.001 + p.depth;
  return parse_scene(
      fmt::format(R"({{"format": "pliant-scene/1", "duration": {0}, "bodies": [{{"name": "block", "surface": "meshes/cube.obj",
        "lattice": {{"spacing": 0.01}}, "element": "{1}", "material": {{"law": "neo-hookean", "young": 20000, "poisson": 0.4,
        "density": 1000, "damping": {2}, "toughness": {3}, "integrity": {4}}},
        "fixed": [{{"plane": [[0, -0.0499, 0], [0, -1, 0]]}}]}}], "blades": [{{"name": "scalpel", "cuts": "by-force",
        "edge": {5}, "sharpness": {6}, {7} "path": [[0, {9}, 0.051, -0.05, {9}, 0.051, 0.05],
        [{0}, {9}, {8}, -0.05, {9}, {8}, 0.05]]}}]}})",
                  end / p.speed, p.element, p.damping, p.toughness, p.integrity, p.edge, p.sharpness, p.extra, 0.05 - p.depth,
                  p.x),
      test::source_dir() + "/scenes/pressed_block.json");
}

const PressedBlade& blade_of(const Simulation& sim) { return sim.state().pressed.at("scalpel"); }

std::int64_t cut_edges(const Simulation& sim) {
  std::int64_t edges = 0;
  for (const CutRecord& cut : sim.state().cuts) edges += static_cast<std::int64_t>(cut.edges.size());
  return edges;
}

/// Before anything gives way, the force is that of a body whose nodes below the edge are moved down.
TEST_P(Scalpel, IndentsLikeARigidLine) {
  const Press p{.speed = 0.01, .depth = 0.006};
  const Scene scene = pressed_block(p);
  auto sim = simulate(scene, GetParam());
  while (sim->time() < scene.duration - 20 * sim->dt() && sim->advance(16) > 0) {  // then the blade is gone
  }
  const double depth = p.speed * sim->time() - 0.001;
  Scene still = pressed_block(p);
  statics::Problem problem = statics::problem_of(still, sim->model(), 0);
  const auto line = statics::nodes_where(problem.mesh, [](const Vec3d& x) { return std::abs(x[0]) < 1e-6 && x[1] > 0.0499; });
  ASSERT_EQ(line.size(), 11U);
  for (const std::int32_t node : line) problem.prescribed.push_back({node, 1, -depth, 7});
  const statics::Solution solution = statics::solve(problem);
  ASSERT_TRUE(solution.converged) << solution.failure;
  double force = 0;
  for (const std::int32_t node : line) force -= solution.reaction[static_cast<std::size_t>(node)][1];
  check_relative("force of the edge against a static solve", sim->press().last_force(0).force[1], force, 0.05);
  EXPECT_EQ(cut_edges(*sim), 0);
  EXPECT_EQ(blade_of(*sim).first, -1);
}

/// The largest force is F* of the whole edge, proportional to its factors; then it falls.
TEST_P(Scalpel, GivesWayAtItsLimit) {
  const std::vector<Press> all{
      {.toughness = 2e4}, {.toughness = 4e4}, {.toughness = 4e4, .sharpness = 0.5}, {.toughness = 4e4, .integrity = 0.5}};
  for (const Press& p : all) {
    const Scene scene = pressed_block(p);
    auto sim = simulate(scene, GetParam());
    while (sim->time() < scene.duration - 20 * sim->dt() && sim->advance(16) > 0) {
    }
    const double limit = p.toughness * p.sharpness * p.integrity * 2 * p.edge * 0.1;
    check_relative("largest force against K_I kappa zeta dA", blade_of(*sim).max_force, limit,
                   0.03);  // samples at the ends give way a little before the others
    EXPECT_LT(sim->press().last_force(0).force[1], 0.8 * limit);
    EXPECT_GT(cut_edges(*sim), 0);
    EXPECT_GT(blade_of(*sim).by_contact, 0);
  }
}

/// The work of the blade is the energy that the body holds and what cutting took.
TEST_P(Scalpel, WorkIsKept) {
  const Press p{.speed = 0.02, .toughness = 4e4, .damping = 0, .depth = 0.02, .x = 0.0031};
  const Scene scene = pressed_block(p);
  auto sim = simulate(scene, GetParam());
  double worst = 0;
  while (sim->time() < scene.duration - 1e-9 && sim->advance(64) > 0) {
    const PressedBlade& blade = blade_of(*sim);
    auto w = read_texels(*sim, "node_w");
    for (Vec3d& x : w) x = plain(eigen(x) / sim->dt());
    const Energies e = energies(sim->model(), read_texels(*sim, "node_u"), w);
    const double lost = blade.work - e.kinetic - e.strain - e.hourglass - blade.fracture_now();
    if (sim->time() > 0.5 * scene.duration) worst = std::max(worst, std::abs(lost) / blade.work);
  }
  check("work of the blade, less elastic, kinetic and fracture energy", worst, 0.02);
  EXPECT_GT(blade_of(*sim).fracture, 0);
}

/// Work and largest force are those of the steps that were kept, not of batches that were made again.
TEST_P(Scalpel, WhatIsTakenBackDidNothing) {
  const Press p{.speed = 0.5, .damping = 5, .element = "hex8", .depth = 0.09};
  const Scene scene = pressed_block(p);
  auto sim = simulate(scene, GetParam());
  std::map<std::int64_t, std::array<double, 2>> kept;  // by step: largest force and work
  while (sim->time() < 0.95 * scene.duration && !sim->divergence()) {
    sim->begin_batch(1);  // batches end between the steps to which they go back
    sim->run_steps(0, 1);
    sim->end_batch(1);
    kept.erase(kept.upper_bound(sim->step()), kept.end());
    for (const auto& f : sim->press().step_forces()) {
      const double way = p.speed * sim->dt() * (sim->step() == 1 ? 0.5 : 1);  // the path begins with the first step
      kept[sim->step()] = {eigen(f.force).norm(), f.force[1] * way};
    }
  }
  EXPECT_GT(sim->report().made_again, 0);
  double most = 0, work = 0;
  for (const auto& [step, felt] : kept) most = std::max(most, felt[0]), work += felt[1];
  EXPECT_EQ(blade_of(*sim).max_force, most);
  check_relative("work against that of the steps", blade_of(*sim).work, work, 1e-9);
}

PLIANT_ON_BACKENDS(Scalpel);

}  // namespace
}  // namespace pliant::physics
