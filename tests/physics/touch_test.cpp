// Tissue against tissue: momentum, energy, weight, friction, one block for two, a fold, the faces of a cut.
#include "model/pieces.h"
#include "physics/harness.h"
#include "simulation/measure/reactions.h"
#include "support/error_of.h"

namespace pliant::physics {
namespace {

class TouchPhysics : public OnBackend {};

Vector3d sum_over(const Simulation& sim, std::size_t body, const std::vector<Vec3d>& values) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t n = 0; n < values.size(); ++n)
    sum += sim.model().mass[static_cast<std::size_t>(sim.model().bodies[body].slot[n])] * eigen(values[n]);
  return sum;
}
Vector3d velocity_of(const Simulation& sim, std::size_t body) {
  return sum_over(sim, body, sim.velocities(body)) / sim.model().bodies[body].mass;
}

double energy_of(Simulation& sim) {
  auto w = read_texels(sim, "node_w");
  for (Vec3d& x : w) x = plain(eigen(x) / sim.dt());
  return energies(sim.model(), read_texels(sim, "node_u"), w).total();
}

ContactTool table(double friction) {
  ContactTool tool;
  tool.name = "table";
  tool.shape = ToolShape::half_space;
  tool.second = {0, 0, 1};
  tool.friction = friction;
  return tool;
}

/// Two bodies of different elements meet askew in free space: what one loses the other gets, and no energy comes from nowhere.
TEST_P(TouchPhysics, ACollisionKeepsMomentumAndMakesNoEnergy) {
  for (const Discretization cut : all_cuts()) {
    for (const double friction : {0.0, 0.5}) {
      Scene scene;
      Body one = box_body({{4, 4, 4}, 0.0125}, cut, material_young(Law::neo_hookean, 2e4, 0.4));
      Body two = box_body({{5, 4, 4}, 0.01}, Discretization::hex8_bricks, material_young(Law::neo_hookean, 5e4, 0.3));
      two.name = "two";
      two.translate = {0.055, 0.013, 0.007};
      one.velocity = {0.5, 0.02, 0};
      two.velocity = {-0.5, 0, 0.05};
      scene.bodies = {one, two};
      scene.contact = TissueContact{friction};
      scene.dt = 1e-4;
      auto sim = simulate(scene, GetParam());
      const Momenta before = momenta_of(*sim);
      const double energy = energy_of(*sim);
      const double closing = velocity_of(*sim, 0)[0] - velocity_of(*sim, 1)[0];
      double most = 0;
      for (int i = 0; i < 100; ++i) {
        sim->advance(10);
        most = std::max(most, energy_of(*sim) / energy - 1);
      }
      const Momenta after = momenta_of(*sim);
      const std::string name = std::string(name_of(cut)) + ", friction " + std::to_string(friction).substr(0, 3);
      const double scale = 0.5 * sim->model().bodies[0].mass;
      check(name + ": linear momentum, over that of one", (eigen(after.linear) - eigen(before.linear)).norm() / scale,
            bound(2e-5, 1e-12));
      const auto spin = [](const Momenta& m) { return Vector3d(eigen(m.angular) - eigen(m.centre).cross(eigen(m.linear))); };
      check("  angular momentum, over that of one at a cell", (spin(after) - spin(before)).norm() / (scale * 0.0125), 0.03);
      check("  energy made, over all", most, 1e-3);
      EXPECT_LT(velocity_of(*sim, 0)[0] - velocity_of(*sim, 1)[0], 0.2 * closing) << name;
    }
  }
}

/// Bodies that begin inside each other part as slowly at a small step as at half the stable one: the way is given back in time,
/// not in steps.
TEST_P(TouchPhysics, SmallStepsPartBodiesNoFaster) {
  Scene scene;
  Body one = box_body({{3, 3, 3}, 0.01}, Discretization::hex8_bricks, material_young(Law::neo_hookean, 1e4, 0.3));
  Body two = one;
  two.name = "two";
  two.translate = {0.0002, 0.0003, 0.0285};
  scene.bodies = {one, two};
  scene.contact = TissueContact{};
  const double stable = simulate(scene, GetParam())->stable_dt();
  const auto fastest = [&](double share) {
    scene.dt = stable * share;
    auto sim = simulate(scene, GetParam());
    double most = 0;
    for (int k = 0; k < 20; ++k) {
      sim->advance(static_cast<int>(16 / share));
      most = std::max(most, velocity_of(*sim, 1)[2] - velocity_of(*sim, 0)[2]);
    }
    return most;
  };
  const double half = fastest(0.5), small = fastest(0.02);
  EXPECT_GT(half, 0);
  check("speed of parting at a fiftieth of the stable step, over that at half of it", small / half, 1.5);
}

/// Viscosity, and a stiff body elsewhere, shorten the stable step. Bodies that begin inside each other part no faster for that.
TEST_P(TouchPhysics, ShortStepsPartBodiesNoFaster) {
  const auto fastest = [&](double viscosity, double third) {
    Scene scene;
    Material material = material_young(Law::neo_hookean, 1e4, 0.3);
    material.viscosity = viscosity;
    Body one = box_body({{3, 3, 3}, 0.01}, Discretization::hex8_bricks, material);
    Body two = one;
    two.name = "two";
    two.translate = {0.0002, 0.0003, 0.0285};
    scene.bodies = {one, two};
    if (third > 0) {
      Body stiff = box_body({{3, 3, 3}, 0.01}, Discretization::hex8_bricks, material_young(Law::neo_hookean, third, 0.3));
      stiff.name = "stiff";
      stiff.translate = {0.2, 0, 0};
      scene.bodies.push_back(stiff);
    }
    scene.contact = TissueContact{};
    auto sim = simulate(scene, GetParam());
    double most = 0;
    while (sim->time() < 0.2) {
      sim->advance(16);
      most = std::max(most, velocity_of(*sim, 1)[2] - velocity_of(*sim, 0)[2]);
    }
    return std::pair{most, sim->stable_dt()};
  };
  const auto [elastic, step] = fastest(0, 0);
  EXPECT_GT(elastic, 0);
  const auto [viscous, viscous_step] = fastest(1000, 0);
  EXPECT_LT(viscous_step, 0.02 * step);
  check("speed of parting with a viscosity that shortens the step to a fiftieth, over that without", viscous / elastic, 3);
  const auto [beside, stiff_step] = fastest(0, 2.5e7);
  EXPECT_LT(stiff_step, 0.03 * step);
  check("speed of parting beside a body that shortens the step to a fiftieth, over that without", beside / elastic, 3);
}

/// Three cubes that do not lie straight on each other come to rest and stay; the table holds the weight of all.
TEST_P(TouchPhysics, AStackStands) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    Scene scene;
    Material m = material_young(Law::neo_hookean, 1e5, 0.4);
    m.damping = 20;
    for (int k = 0; k < 3; ++k) {
      Body cube = box_body({{4, 4, 4}, 0.0125}, cut, m);
      cube.name = "cube" + std::to_string(k);
      cube.translate = {0.003 * k, 0.002 * k, 0.0505 * k + 5e-4};
      scene.bodies.push_back(cube);
    }
    scene.gravity = {0, 0, -9.81};
    scene.contact = TissueContact{0.5};
    scene.tools = {table(0.5)};
    auto sim = simulate(scene, GetParam());
    while (sim->time() < 1.5) sim->advance(sim->next_batch(64));
    const std::vector<Vec3d> before = sim->displacements(2);
    while (sim->time() < 2.5) sim->advance(sim->next_batch(64));
    const std::vector<Vec3d> after = sim->displacements(2);
    double creep = 0;
    for (std::size_t n = 0; n < after.size(); ++n) creep = std::max(creep, (eigen(after[n]) - eigen(before[n])).norm());
    const std::string name = name_of(cut);
    check(name + ": creep of the highest in 1 s, in cells", creep / 0.0125, bound(1e-4, 1e-5));
    double mass = 0;
    for (const ModelBody& b : sim->model().bodies) mass += b.mass;
    check_relative("  force on the table", -sim->report().tools[0].now.force[2], 9.81 * mass, 1e-3);
    check("  deepest pair, in cells", sim->report().tissue.max_depth / 0.0125, 0.05);
    EXPECT_GT(sim->report().tissue.points, 100);
  }
}

/// A cube on a slope of tissue that does not move slides with g (sin - mu cos), or stays.
TEST_P(TouchPhysics, FrictionSticksAndSlides) {
  const double slope = std::atan(0.4);
  for (const double friction : {0.2, 0.5}) {
    Scene scene;
    Body bed = box_body({{12, 4, 1}, 0.02}, Discretization::hex8_bricks, material_young(Law::neo_hookean, 1e5, 0.3));
    bed.name = "bed";
    bed.fixed = {{face(2, 0)}, {face(2, 0.02)}};
    Material m = material_young(Law::neo_hookean, 5e4, 0.3);
    m.damping = friction > 0.4 ? 20 : 0;
    Body cube = box_body({{4, 4, 4}, 0.0125}, Discretization::hex8_bricks, m);
    cube.translate = {0.005, 0.0151, 0.0201};
    scene.bodies = {bed, cube};
    scene.contact = TissueContact{friction};
    scene.gravity = {9.81 * std::sin(slope), 0, -9.81 * std::cos(slope)};
    auto sim = simulate(scene, GetParam());
    const auto until = [&](double time) {
      while (sim->time() < time) sim->advance(sim->next_batch(16));
    };
    until(friction > 0.4 ? 3 : 0.1);
    const double from = sim->time(), v = velocity_of(*sim, 1)[0];
    const std::vector<Vec3d> before = sim->displacements(1);
    until(friction > 0.4 ? 4 : 0.3);
    if (friction < 0.4) {
      check_relative("acceleration", (velocity_of(*sim, 1)[0] - v) / (sim->time() - from),
                     9.81 * (std::sin(slope) - friction * std::cos(slope)), 0.03);
      continue;
    }
    const std::vector<Vec3d> after = sim->displacements(1);
    double creep = 0;
    for (std::size_t n = 0; n < after.size(); ++n) creep = std::max(creep, (eigen(after[n]) - eigen(before[n])).norm());
    check("creep in 1 s, in cells", creep / 0.0125, bound(1e-4, 1e-5));
  }
}

/// Two blocks that lie on each other are pressed as one block of both.
TEST_P(TouchPhysics, TwoBlocksPressLikeOne) {
  for (const Discretization cut : all_cuts()) {
    Material m = material_young(Law::neo_hookean, 1e4, 0.4);
    m.damping = 30;
    const double edge = 0.0125;
    const auto reaction = [&](bool two) {
      Scene scene;
      Body low = box_body({{4, 4, two ? 4 : 8}, edge}, cut, m);
      low.name = "low";
      low.fixed = {{face(2, 0)}};
      Body high = box_body({{4, 4, 4}, edge}, cut, m);
      high.translate = {0, 0, 4 * edge};
      scene.bodies = {low};
      if (two) scene.bodies.push_back(high);
      Prescribed down;
      down.where = face(2, 8 * edge);
      down.displacement = {0.0, 0.0, -0.01};
      down.curve.kind = Curve::Kind::smooth;
      down.curve.duration = 0.6;
      scene.bodies.back().prescribed = {down};
      if (two) scene.contact = TissueContact{1};
      auto sim = simulate(scene, GetParam());
      while (sim->time() < 1.2) sim->advance(sim->next_batch(64));
      double sum = 0;
      const std::vector<Vec3d> forces = reactions(*sim, 0);
      for (std::size_t n = 0; n < forces.size(); ++n) {
        if (sim->model().bodies[0].rest[n][2] < 1e-6) sum += forces[n][2];
      }
      if (two) check("  deepest pair, in cells", sim->report().tissue.max_depth / edge, 0.06);
      return sum;
    };
    const double one = reaction(false);
    check_relative(std::string(name_of(cut)) + ": force of two blocks against one", reaction(true), one, 0.02);
  }
}

/// A block that is cut through and pressed holds like one that is not: the faces of the cut start where they touch.
TEST_P(TouchPhysics, TheFacesOfACutHold) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4, Discretization::hex8full_lattice}) {
    const double edge = 0.0125;
    const auto run = [&](bool cuts) {
      Scene scene;
      Material m = material_young(Law::neo_hookean, 1e4, 0.4);
      m.damping = 30;
      Body block = box_body({{4, 4, 8}, edge}, cut, m);
      block.fixed = {{face(2, 0)}};
      Prescribed down;
      down.where = face(2, 8 * edge);
      down.displacement = {0.0, 0.0, -0.01};
      down.curve.kind = Curve::Kind::smooth;
      down.curve.start = 0.25;
      down.curve.duration = 0.5;
      block.prescribed = {down};
      scene.bodies = {block};
      if (cuts) {
        Blade blade;
        blade.name = "knife";
        blade.path = {{{0.01, -0.01, -0.01, 0.047, -0.01, 0.06, 0.047}}, {{0.2, 0.06, -0.01, 0.055, 0.06, 0.06, 0.055}}};
        scene.blades = {blade};
        scene.contact = TissueContact{1};
      }
      auto sim = simulate(scene, GetParam());
      while (sim->time() < 1.2) sim->advance(sim->next_batch(64));
      if (cuts) {
        EXPECT_EQ(pieces_of(sim->model().bodies[0]), 2);
        check("  deepest pair, in cells", sim->report().tissue.max_depth / edge, 0.06);
      }
      double sum = 0;
      const std::vector<Vec3d> forces = reactions(*sim, 0);
      for (std::size_t n = 0; n < forces.size(); ++n) {
        if (sim->model().bodies[0].rest[n][2] < 1e-6) sum += forces[n][2];
      }
      return sum;
    };
    const double whole = run(false);
    check_relative(std::string(name_of(cut)) + ": force of a block that is cut", run(true), whole, 0.03);
  }
}

/// Bodies that begin a little inside each other part slowly; deeper, they are refused.
TEST_P(TouchPhysics, BodiesThatBeginInsideEachOther) {
  const auto scene_of = [](double depth) {
    Scene scene;
    Body one = box_body({{4, 4, 4}, 0.0125}, Discretization::hex8_bricks, material_young(Law::neo_hookean, 2e4, 0.4));
    Body two = one;
    one.name = "one";
    two.name = "two";
    two.translate = {0, 0, 0.05 - depth};
    scene.bodies = {one, two};
    scene.contact = TissueContact{};
    return scene;
  };
  auto sim = simulate(scene_of(0.003), GetParam());
  double fastest = 0;
  while (sim->time() < 0.3) {
    sim->advance(sim->next_batch(16));
    fastest = std::max(fastest, velocity_of(*sim, 1).norm());
  }
  std::printf("  they part at %.3g m/s at the most\n", fastest);
  EXPECT_LT(fastest, 0.02);
  EXPECT_GT(fastest, 0);
  const std::string message = test::error_of([&] { (void)simulate(scene_of(0.01), GetParam()); });
  EXPECT_NE(message.find("/contact: body 'two' begins inside body 'one', 0.0"), std::string::npos) << message;
}

PLIANT_ON_BACKENDS(TouchPhysics);

}  // namespace
}  // namespace pliant::physics
