// The work of tools and the energy of what they press: none is lost, and none comes from nowhere.
#include <fmt/format.h>

#include "physics/harness.h"
#include "support/source_dir.h"

namespace pliant::physics {
namespace {

class ContactEnergy : public OnBackend {};

Scene touched_by(Body body, ContactTool tool) {
  Scene scene;
  scene.bodies = {std::move(body)};
  scene.tools = {std::move(tool)};
  return scene;
}

/// What a tool does on tissue is in its energy or was damped, whether a force along its way or a torque about its origin did
/// it.
TEST_P(ContactEnergy, WorkIsEnergyAndWhatIsDamped) {
  ContactTool pushed;
  pushed.name = "tool";
  pushed.shape = ToolShape::box;
  pushed.size = {0.5, 0.5, 0.02};
  pushed.path = {{0, 0.04, 0.04, 0.0505, 0, 0, 0, 1}, {0.3, 0.04, 0.04, 0.045, 0, 0, 0, 1}};
  ContactTool turned = pushed;  // about an edge of the block, which it then presses askew
  turned.path = {{0, 0, 0.04, 0.0505, 0, 0, 0, 1}, {0.3, 0, 0.04, 0.0505, 0, std::sin(0.05), 0, std::cos(0.05)}};
  for (const ContactTool& tool : {pushed, turned}) {
    Material m = material_young(Law::neo_hookean, 1e4, 0.4);
    m.damping = 30;
    Body body = box_body({{8, 8, 4}, 0.01}, Discretization::hex8full_lattice, m);
    body.fixed = {{face(2, 0)}};
    auto sim = simulate(touched_by(body, tool), GetParam());
    double damped = 0;
    const auto energy = [&] {
      auto w = read_texels(*sim, "node_w");
      for (Vec3d& x : w) x = plain(eigen(x) / sim->dt());
      return energies(sim->model(), read_texels(*sim, "node_u"), w);
    };
    while (sim->time() < 0.5) {
      const double before = sim->time();
      sim->advance(sim->next_batch(4));
      damped += 2 * m.damping * energy().kinetic * (sim->time() - before);
      sim->watch_energy();
    }
    const double work = sim->report().tools[0].work;
    check_relative(std::string(tool.path[0][1] > 0 ? "pushed" : "turned") + ": work", work,
                   energy().strain + energy().kinetic + damped,
                   0.01);  // a plate that turns: 0.8 %, of the normals of the start
    ASSERT_TRUE(sim->report().energy.share());
    check("  energy made, over the largest", *sim->report().energy.share(), 1e-3);
    // A push that nobody accounts for, of more than what stands in the tool could give back.
    auto w = read_texels(*sim, "node_w");
    for (Vec3d& x : w) x[0] += 0.1 * sim->dt();
    write_texels(*sim, "node_w", w);
    sim->watch_energy();
    EXPECT_GT(*sim->report().energy.share(), 0.01);
  }
}

/// Tissue that presses on a thin tool stands in it, which takes work beyond that of the strain; it comes back when the tool
/// withdraws, and is no energy from nowhere.
TEST_P(ContactEnergy, WhatANeedleGivesBackIsNotCreated) {
  ContactTool needle;
  needle.name = "needle";
  needle.shape = ToolShape::capsule;
  needle.radius = 0.004;
  needle.first = {0, 0, 0.004};
  needle.second = {0, 0, 0.05};
  needle.path = {{0, 0.02, 0.02, 0.0202, 0, 0, 0, 1},
                 {0.4, 0.02, 0.02, 0.0162, 0, 0, 0, 1},
                 {0.6, 0.02, 0.02, 0.0162, 0, 0, 0, 1},
                 {0.8, 0.02, 0.02, 0.0242, 0, 0, 0, 1}};
  Material m = material_young(Law::neo_hookean, 8e3, 0.45);
  m.damping = 20;
  Body body = box_body({{10, 10, 5}, 0.004}, Discretization::hex8_bricks, m);
  body.fixed = {{face(2, 0)}};
  auto sim = simulate(touched_by(body, needle), GetParam());
  while (sim->time() < 1) {
    sim->advance(sim->next_batch(16));
    sim->watch_energy();
  }
  EXPECT_GT(sim->report().tools[0].max_force, 0.05);
  ASSERT_TRUE(sim->report().energy.share());
  check("energy made, over the largest", *sim->report().energy.share(), 0.01);
}

/// A sheet whose springs resist no pressure falls down along a held edge and crumples. Its faces lie on each other in heaps and
/// slide, and their pairs get long arms between two searches.
TEST_P(ContactEnergy, ASheetThatCrumplesMakesNoEnergy) {
  auto sim = simulate(parse_scene(R"({"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "duration": 0.3, "contact": {},
      "bodies": [{"name": "cloth", "surface": "meshes/cloth.obj", "thickness": 0.005,
        "model": {"type": "mass-spring", "spring": {"slack": true}},
        "material": {"law": "neo-hookean", "young": 5000, "poisson": 0.3, "density": 1050, "damping": 3},
        "fixed": [{"plane": [[0.066, 0, 0], [1, 0, 0]]}]}]})",
                                  test::source_dir() + "/scenes/heap.json"),
                      GetParam());
  while (sim->time() < 0.3) {
    sim->advance(sim->next_batch(64));
    sim->watch_energy();
  }
  EXPECT_GT(sim->report().tissue.points, 3000);
  ASSERT_TRUE(sim->report().energy.share());
  check("energy made, over the largest", *sim->report().energy.share(), 0.01);
}

/// A tool that draws tissue out holds its points away from their places, the farther the harder it draws; as it goes back they
/// give back what that took.
TEST_P(ContactEnergy, WhatAGripGivesBackIsNotCreated) {
  ContactTool cup;
  cup.name = "cup";
  cup.shape = ToolShape::sphere;
  cup.radius = 0.012;
  cup.friction = 0.3;
  cup.grip = GripSpec{0, {{0.05, 1e9}}};
  cup.path = {{0, 0.025, 0.025, 0.06199, 0, 0, 0, 1},
              {0.1, 0.025, 0.025, 0.06199, 0, 0, 0, 1},
              {0.3, 0.025, 0.035, 0.082, 0, 0, 0, 1},
              {0.5, 0.025, 0.025, 0.062, 0, 0, 0, 1}};
  Material m = material_young(Law::stable_neo_hookean, 2e4, 0.4);
  m.damping = 20;
  Body body = box_body({{4, 4, 4}, 0.0125}, Discretization::tet4, m);
  body.fixed = {{face(2, 0)}};
  auto sim = simulate(touched_by(body, cup), GetParam());
  double held = 0;
  while (sim->time() < 0.6) {
    sim->advance(sim->next_batch(7));
    sim->watch_energy();
    held = std::max(held, sim->contact().held_energy());
  }
  EXPECT_GT(held / sim->report().energy.highest, 0.02);
  check("energy made, over the largest", sim->report().energy.share().value(), 4e-4);
}

/// Blocks that begin inside each other, held at their far ends, press on each other as they part: all of their energy is the
/// work of that.
TEST_P(ContactEnergy, PartingIsWork) {
  Scene scene;
  Material m = material_young(Law::neo_hookean, 2e4, 0.4);
  m.damping = 5;
  Body one = box_body({{4, 4, 4}, 0.0125}, Discretization::hex8_bricks, m), two = one;
  one.name = "one";
  two.name = "two";
  one.fixed = {{face(2, 0)}};
  two.fixed = {{face(2, 0.097)}};
  two.translate = {0, 0, 0.047};
  scene.bodies = {one, two};
  scene.contact = TissueContact{};
  auto sim = simulate(scene, GetParam());
  while (sim->time() < 0.6) {
    sim->watch_energy();
    sim->advance(sim->next_batch(16));
  }
  sim->watch_energy();
  const std::vector<Vec3d> u = read_texels(*sim, "node_u");
  const double work = sim->report().tissue.work, strain = energies(sim->model(), u, std::vector<Vec3d>(u.size())).strain;
  EXPECT_GT(sim->report().energy.highest, 1e-4);
  EXPECT_GT(work, strain);
  EXPECT_LT(work, 2 * strain) << "the rest is damped, by contact, too, where pairs part faster than the tissue follows";
  check("energy made, over the largest", sim->report().energy.share().value(), 0.01);
}

/// Tissue that is pressed stands a little in the tool, by as much as its force moves it in a step. A step that becomes much
/// shorter, here because another body has become stiff, does not throw it out; nor does another one after it.
TEST_P(ContactEnergy, AShorterStepThrowsNothingOut) {
  const auto body = [](const char* name, double spacing, const char* more) {
    return fmt::format(R"({{"name": "{}", "surface": "meshes/cube.obj", "lattice": {{"spacing": {}}}, "element": "hex8full",
        "material": {{"law": "neo-hookean", "young": 1e4, "poisson": 0.4, "density": 1000, "damping": 100}}, {}}})",
                       name, spacing, more);
  };
  auto sim = simulate(parse_scene(R"({"format": "pliant-scene/1", "bodies": [)" +
                                      body("block", 0.0125, R"("fixed": [{"plane": [[0, -0.0499, 0], [0, -1, 0]]}])") + ", " +
                                      body("other", 0.1, R"("translate": [1, 0, 0])") + R"(], "tools": [{"name": "plate",
            "shape": {"box": [0.5, 0.02, 0.5]}, "path": [[0, 0, 0.0605, 0], [0.2, 0, 0.05, 0]]}]})",
                                  test::source_dir() + "/scenes/shorter_step.json"),
                      GetParam());
  const auto run = [&](double end) {
    while (sim->time() < end) sim->advance(sim->next_batch(8));
  };
  run(0.5);
  EXPECT_GT(sim->report().tools[0].now.force[1], 10);
  for (const char* young : {"1e6", "3e7"}) {
    const double dt = sim->dt(), depth = sim->report().tools[0].now.depth;
    sim->change(fmt::format(R"({{"body": "other", "material": {{"young": {}}}}})", young));
    double fastest = 0;
    for (int step = 0; step < 16; ++step) {
      sim->advance(1);
      for (const Vec3d& v : sim->velocities(0)) fastest = std::max(fastest, eigen(v).norm());
    }
    EXPECT_LT(sim->dt(), 0.6 * dt);
    check(fmt::format("{} Pa: way of the tissue in a step, over its depth", young), fastest * sim->dt() / depth, 0.15);
    run(sim->time() + 0.2);
    check_relative("  force [N]", sim->report().tools[0].now.force[1], 11.7, 0.01);
  }
}

PLIANT_ON_BACKENDS(ContactEnergy);

}  // namespace
}  // namespace pliant::physics
