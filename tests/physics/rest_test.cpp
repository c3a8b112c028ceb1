// Contact that rests: what a still tool or other tissue presses keeps its energy where nothing damps, and comes to rest where
// something does, at the automatic step.
#include "physics/harness.h"

namespace pliant::physics {
namespace {

class RestPhysics : public OnBackend {};

/// Kinetic energy over that of strain.
double motion(const Simulation& sim) {
  std::vector<std::vector<Vec3d>> u, v;
  for (std::size_t b = 0; b < sim.model().bodies.size(); ++b) {
    u.push_back(sim.displacements(b));
    v.push_back(sim.velocities(b));
  }
  const Energies e = energies(sim.model(), by_slot(sim.model(), u), by_slot(sim.model(), v));
  return e.kinetic / (e.strain + e.hourglass);
}

void until(Simulation& sim, double time) {
  while (sim.time() < time) sim.advance(sim.next_batch(64));
}

/// Largest motion of a span of time.
double most_motion(Simulation& sim, double from, double to) {
  until(sim, from);
  double most = 0;
  while (sim.time() < to) {
    sim.advance(sim.next_batch(64));
    most = std::max(most, motion(sim));
  }
  return most;
}

/// Its origin starts at `x` and goes down.
ContactTool pressed(ContactTool tool, const Vec3d& x, double depth) {
  tool.name = "tool";
  tool.path = {{0, x[0], x[1], x[2], 0, 0, 0, 1}, {0.3, x[0], x[1], x[2] - depth, 0, 0, 0, 1}};
  return tool;
}

Body held_block(const Box& box, Discretization cut, double damping) {
  Material m = material_young(Law::neo_hookean, 8000, 0.45);
  m.damping = damping;
  Body body = box_body(box, cut, m);
  body.fixed = {{face(2, 0)}};
  return body;
}

/// One cell under a ball that stands still: without friction and damping nothing may grow. The ball's normal at the place of
/// the trial step would feed each oscillation by f h / (2 m R) per second.
TEST_P(RestPhysics, OneCellUnderABall) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    Scene scene;
    scene.bodies = {held_block({{1, 1, 1}, 0.01}, cut, 0)};
    ContactTool ball;
    ball.radius = 0.01;
    scene.tools = {pressed(ball, {0.006, 0.0055, 0.0205}, 0.004)};
    auto sim = simulate(scene, GetParam());
    const double early = most_motion(*sim, 0.3, 0.8), late = most_motion(*sim, 4, 4.5);
    check(std::string(name_of(cut)) + ": growth of the motion in 4 s", std::max(0.0, late / early - 1), 0.2);
  }
}

/// Tools thinner than half a cell, with edges: pressed between points of contact they have a force, in place and at rest.
TEST_P(RestPhysics, ThinToolsWithEdgesAreMet) {
  ContactTool ball, needle;
  ball.radius = 0.001;
  needle.shape = ToolShape::capsule;
  needle.radius = 0.0005;
  needle.second = {0.01, 0.003, 0.03};
  const std::array<std::pair<ContactTool, Vec3d>, 2> tools{
      {{ball, {0.0263, 0.0241, 0.0212}}, {needle, {0.0263, 0.0241, 0.0207}}}};
  const std::array<const char*, 2> names{"ball", "needle"};
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    for (std::size_t k = 0; k < tools.size(); ++k) {
      const std::string label = std::string(names[k]) + ", " + name_of(cut) + ": ";
      Vec3d force[2];
      double motion_at_end = 1;
      for (const bool edges : {false, true}) {
        Scene scene;
        scene.bodies = {held_block({{10, 10, 4}, 0.005}, cut, 20)};
        scene.tools = {pressed(tools[k].first, tools[k].second, 0.0025)};
        scene.tools[0].edges = edges;
        auto sim = simulate(scene, GetParam());
        motion_at_end = most_motion(*sim, 1.5, 1.6);
        force[edges ? 1 : 0] = sim->report().tools[0].now.force;
      }
      EXPECT_GT(force[1][2], 0.05) << label;
      EXPECT_GT(force[1][2], 2 * force[0][2]) << label;
      check(label + "motion at rest", motion_at_end, 1e-6);
    }
  }
}

/// A rod that lies and the rim of a plate, askew to the cells. Were only the deepest point of an edge to push on a patch, or
/// did friction act where the edge is and not where slip is measured, they would shake the tissue for ever.
TEST_P(RestPhysics, ThinToolsThatLieOnTissueRest) {
  ContactTool rod, plate;
  rod.shape = ToolShape::capsule;
  rod.radius = 0.001;
  rod.first = {-0.015, -0.008, 0};
  rod.second = {0.015, 0.008, 0.001};
  plate.shape = ToolShape::box;
  plate.size = {0.002, 0.03, 0.05};
  const std::array<std::pair<ContactTool, Vec3d>, 2> tools{
      {{rod, {0.0263, 0.0241, 0.0212}}, {plate, {0.0263, 0.0241, 0.0452}}}};
  const std::array<const char*, 2> names{"rod", "plate"};
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    for (std::size_t k = 0; k < tools.size(); ++k) {
      Scene scene;
      scene.bodies = {held_block({{10, 10, 4}, 0.005}, cut, 20)};
      scene.tools = {pressed(tools[k].first, tools[k].second, 0.0025)};
      scene.tools[0].edges = true;
      scene.tools[0].friction = k == 0 ? 0 : 0.3;
      auto sim = simulate(scene, GetParam());
      check(std::string(names[k]) + ", " + name_of(cut) + ": motion at rest", most_motion(*sim, 1.5, 1.6), 1e-6);
      EXPECT_GT(sim->report().tools[0].now.force[2], 0.05);
    }
  }
}

/// With friction and hardly any damping; the mean of all points of an edge is not enough for that.
TEST_P(RestPhysics, ThinRodWithFrictionFeedsNoMotion) {
  Scene scene;
  scene.bodies = {held_block({{12, 8, 4}, 0.005}, Discretization::hex8full_lattice, 0.5)};
  ContactTool rod;
  rod.shape = ToolShape::capsule;
  rod.radius = 0.0005;
  rod.first = {-0.02, -0.008, 0};
  rod.second = {0.02, 0.008, 0};
  rod.friction = 0.3;
  rod.edges = true;
  scene.tools = {pressed(rod, {0.0313, 0.0211, 0.0207}, 0.0035)};
  auto sim = simulate(scene, GetParam());
  const double early = most_motion(*sim, 0.5, 0.8), late = most_motion(*sim, 1.5, 1.6);
  check("growth of the motion in 1 s", std::max(0.0, late / early - 1), 0.2);
}

/// A rod and a ball at the same place: W counts both, so that their order does not matter. (Were only the last to count, the
/// rod would be too strong where the ball comes after it, and put energy in.)
TEST_P(RestPhysics, TwoThinToolsAtOnePlaceInAnyOrder) {
  ContactTool rod, ball;
  rod.shape = ToolShape::capsule;
  rod.first = {-0.015, -0.004, 0};
  rod.second = {0.015, 0.004, 0.0005};
  rod.radius = 0.001;
  ball.radius = 0.0008;
  rod.edges = ball.edges = true;
  Vec3d on_rod[2];
  for (const std::size_t order : {0U, 1U}) {
    Scene scene;
    scene.bodies = {held_block({{12, 8, 4}, 0.005}, Discretization::hex8full_lattice, 5)};
    ContactTool a = pressed(rod, {0.031, 0.0203, 0.0215}, 0.003), b = pressed(ball, {0.032, 0.021, 0.0215}, 0.003);
    a.name = "rod", b.name = "ball";
    scene.tools = order == 0 ? std::vector{a, b} : std::vector{b, a};
    auto sim = simulate(scene, GetParam());
    until(*sim, 0.35);
    on_rod[order] = sim->report().tools[order].now.force;
  }
  check_relative("force on the rod, after over before the ball", on_rod[0][2], on_rod[1][2], 1e-3);
}

/// The rod, the block and the step that once shook for ever, on every element; and the force at a tenth of the step.
TEST_P(RestPhysics, ARodOnASlab) {
  for (const Discretization cut : all_cuts()) {
    Scene scene;
    scene.bodies = {held_block({{10, 8, 4}, 0.006}, cut, 8)};
    ContactTool rod;
    rod.shape = ToolShape::capsule;
    rod.radius = 0.006;
    rod.first = {0.0313, -0.05, 0};
    rod.second = {0.0313, 0.1, 0.003};
    scene.tools = {pressed(rod, {0, 0, 0.031}, 0.0065)};
    auto sim = simulate(scene, GetParam());
    until(*sim, 2.3);
    check(std::string(name_of(cut)) + ": motion after 2 s", motion(*sim), 1e-6);
    EXPECT_GE(sim->dt(), 0.8 * scene.safety * sim->stable_dt()) << name_of(cut);
    if (!in_double() || cut != Discretization::hex8full_lattice) continue;
    const double force = sim->report().tools[0].now.force[2];
    scene.dt = 0.1 * sim->dt();
    auto fine = simulate(scene, GetParam());
    until(*fine, 1.5);
    check_relative("  force against that of a tenth of the step", force, fine->report().tools[0].now.force[2], 0.015);
  }
}

/// A cube whose edge comes first is pressed into a block, both without friction: what pushes a pair must be the gradient of an
/// energy. Without the turn of its tangents both shake harder and harder.
TEST_P(RestPhysics, TissueInTissue) {
  Scene scene;
  Body low = held_block({{8, 8, 4}, 0.006}, Discretization::hex8_bricks, 3);
  low.name = "low";
  TriangleMesh cube = box_surface({{4, 4, 4}, 0.006});
  const Matrix3d turn = (Eigen::AngleAxisd(0.3, Vector3d::UnitX()) * Eigen::AngleAxisd(0.4, Vector3d::UnitY())).matrix();
  for (Vec3d& x : cube.vertices) x = plain(turn * eigen(x) + Vector3d(0.009, 0.018, 0.0365));
  Body high = low;
  high.name = "high";
  high.surface = save(cube);
  high.fixed.clear();
  Prescribed p;
  p.where.kind = Selection::Kind::box;
  p.where.a = {-1, -1, 0.049};
  p.where.b = {1, 1, 1};
  p.displacement = {0, 0, -0.013};
  p.curve = smooth(0.3);
  high.prescribed = {p};
  scene.bodies = {low, high};
  scene.contact = TissueContact{0};
  auto sim = simulate(scene, GetParam());
  until(*sim, 4);
  EXPECT_GT(sim->report().tissue.points, 20);
  check("motion", motion(*sim), 1e-5);
}

PLIANT_ON_BACKENDS(RestPhysics);

}  // namespace
}  // namespace pliant::physics
