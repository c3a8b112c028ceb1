// Tissue that an edit frees while it stands in a tool: it is not thrown out, which would be energy from nowhere.
#include "physics/harness.h"

namespace pliant::physics::freed_in_tool {
namespace {

class FreedInTool : public OnBackend {};

constexpr double kCell = 0.01;

/// A bar that is held at x = 0, where a half space comes to stand more than a cell deep in it.
Scene bar_in_a_table(Discretization cells) {
  Material m = material_young(Law::neo_hookean, 8e3, 0.4);
  m.damping = 20;
  Scene scene;
  Body body = box_body({{5, 3, 3}, kCell}, cells, m);
  body.fixed = {{face(0, 0)}};
  ContactTool table;
  table.name = "table";
  table.shape = ToolShape::half_space;
  table.first = {0, 0, 0};
  table.second = {1, 0, 0};
  table.path = {{0, -0.001, 0, 0, 0, 0, 0, 1},
                {0.3, 1.3 * kCell, 0, 0, 0, 0, 0, 1},
                {1.5, 1.3 * kCell, 0, 0, 0, 0, 0, 1},
                {2, 3.3 * kCell, 0, 0, 0, 0, 0, 1}};
  scene.bodies = {body};
  scene.tools = {table};
  scene.cuttable = true;
  scene.safety = 0.1;  // at the longest step what is let go of has some energy that is of the step's order
  return scene;
}

double energy_of(Simulation& sim) {
  auto w = read_texels(sim, "node_w");
  for (Vec3d& x : w) x = plain(eigen(x) / sim.dt());
  return energies(sim.model(), read_texels(sim, "node_u"), w).total();
}

/// The most energy beyond that before an edit, and the work of the tool since, as a share of what there was.
template <class Edit>
double created(Simulation& sim, Edit&& edit) {
  while (sim.time() < 0.5) sim.advance(sim.next_batch(16));
  const double before = energy_of(sim), work = sim.report().tools[0].work;
  edit();
  double most = 0;
  for (int k = 0; k < 500; ++k) {
    sim.advance(sim.next_batch(2));
    most = std::max(most, energy_of(sim) - before - (sim.report().tools[0].work - work));
  }
  EXPECT_GT(before, 0);
  return most / before;
}

/// A cut makes chips that no longer hang on what holds the body.
TEST_P(FreedInTool, ByACut) {
  for (const Discretization cells : {Discretization::hex8_bricks, Discretization::tet4}) {
    auto sim = simulate(bar_in_a_table(cells), GetParam());
    const double share = created(*sim, [&] {
      const double x = 0.7 * kCell;  // of the deformed first cells
      const Vec3d a{x, -1, -1}, b{x, 1, -1}, c{x, 1, 1}, d{x, -1, 1};
      EXPECT_GT(sim->cut(std::array<SweepTriangle, 2>{SweepTriangle{a, b, c}, SweepTriangle{a, c, d}}).edges, 0);
    });
    check(std::string(name_of(cells)) + ": energy made by a cut", share, 0.02);
  }
}

/// Nothing holds the body any more.
TEST_P(FreedInTool, ByAChange) {
  auto sim = simulate(bar_in_a_table(Discretization::hex8_bricks), GetParam());
  const std::string name = sim->scene().bodies[0].name;
  const double share = created(*sim, [&] { sim->change("{\"body\": \"" + name + "\", \"fixed\": []}"); });
  check("energy made by a change", share, 0.02);
  EXPECT_LT(sim->time(), 1.5);
  const auto place = [&] {
    double sum = 0;
    for (const Vec3d& u : sim->displacements(0)) sum += u[0];
    return sum / static_cast<double>(sim->displacements(0).size());
  };
  while (sim->time() < 1.5) sim->advance(sim->next_batch(16));
  const double before = place();
  while (sim->time() < 2) sim->advance(sim->next_batch(16));
  EXPECT_GT(place() - before, 1.5 * kCell) << "the tool still pushes it";
}

PLIANT_ON_BACKENDS(FreedInTool);

}  // namespace
}  // namespace pliant::physics::freed_in_tool
