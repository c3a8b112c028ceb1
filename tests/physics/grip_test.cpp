// Tools that grip: what they hold follows them as if it were prescribed, slips at the strength of the grip, and is let go.
#include <array>

#include "cutting/blade/blade.h"
#include "physics/harness.h"
#include "simulation/measure/reactions.h"
#include "simulation/measure/run_remarks.h"

namespace pliant::physics::grip_test {
namespace {

class GripPhysics : public OnBackend {};

constexpr int kCells = 4;
constexpr double kCell = 0.0125, kSide = kCells * kCell;

Body cube(Discretization cut, double damping) {
  Material m = material_young(Law::neo_hookean, 2e4, 0.3);
  m.damping = damping;
  return box_body({{kCells, kCells, kCells}, kCell}, cut, m);
}

/// A plate on the whole top of the cube, which it touches.
ContactTool plate(double thickness = 0.02) {
  ContactTool tool;
  tool.name = "plate";
  tool.shape = ToolShape::box;
  tool.size = {0.08, 0.08, thickness};
  tool.path = {{0, 0.5 * kSide, 0.5 * kSide, kSide + 0.5 * thickness - 1e-5, 0, 0, 0, 1}};
  tool.grip = GripSpec{0, {{0, 1e9}}};
  return tool;
}

/// Then it moves by `d` until `time`.
void move(ContactTool& tool, double time, const Vec3d& d) {
  std::array<double, 8> row = tool.path.back();
  row[0] = time;
  for (std::size_t c = 0; c < 3; ++c) row[1 + c] += d[c];
  tool.path.push_back(row);
}

Scene scene_of(Body body, ContactTool tool) {
  Scene scene;
  scene.bodies = {std::move(body)};
  scene.tools = {std::move(tool)};
  return scene;
}

double mean(const std::vector<Vec3d>& u, std::size_t axis) {
  double sum = 0;
  for (const Vec3d& v : u) sum += v[axis];
  return sum / static_cast<double>(u.size());
}

void until(Simulation& sim, double time) {
  while (sim.time() < time) sim.advance(1);
}

/// A body that hangs from a tool: its weight is on the tool, and it goes where the tool goes.
TEST_P(GripPhysics, CarriesABody) {
  for (const Discretization cut : all_cuts()) {
    ContactTool tool = plate();
    move(tool, 0.5, {0, 0, 0});
    move(tool, 0.8, {0.02, -0.01, 0.03});
    Scene scene = scene_of(cube(cut, 40), tool);
    scene.gravity = {0, 0, -9.81};
    auto sim = simulate(scene, GetParam());
    until(*sim, 0.49);
    const std::vector<Vec3d> hung = sim->displacements(0);
    until(*sim, 1.5);
    const std::vector<Vec3d> carried = sim->displacements(0);
    const double weight = sim->model().bodies[0].mass * 9.81;
    check_relative(std::string(name_of(cut)) + ": weight on the tool", sim->report().tools[0].now.force[2], -weight,
                   bound(1e-4, 1e-5));
    check("  way along x", mean(carried, 0) - mean(hung, 0) - 0.02, 1e-6);
    check("  way along y", mean(carried, 1) - mean(hung, 1) + 0.01, 1e-6);
    check("  way along z", mean(carried, 2) - mean(hung, 2) - 0.03, 1e-6);
  }
}

/// Held all over one face, a body behaves as one whose nodes there are prescribed.
TEST_P(GripPhysics, PullsAndTurnsAsPrescribedNodesDo) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::hex8full, Discretization::tet4}) {
    for (const bool turns : {false, true}) {
      ContactTool tool = plate();
      Body body = cube(cut, 60);
      body.fixed.push_back({face(2, 0), {true, true, true}});
      Body same = body;
      if (turns) {
        for (int k = 1; k <= 30; ++k) {  // about z, through the middle
          std::array<double, 8> row = tool.path.front();
          row[0] = 0.01 * k;
          row[6] = std::sin(0.01 * k);
          row[7] = std::cos(0.01 * k);
          tool.path.push_back(row);
        }
        Prescribed turn;
        turn.where = face(2, kSide);
        turn.rotate = Rotation{{0, 0, 1}, {0.5 * kSide, 0.5 * kSide, 0}, 0.6 * 180 / M_PI};
        turn.curve = smooth(0.3);
        same.prescribed.push_back(turn);
      } else {
        move(tool, 0.3, {0.004, 0, 0.01});
        same.prescribed.push_back(pull(2, kSide, 0.01, smooth(0.3)));
        same.prescribed.back().displacement = {0.004, 0, 0.01};
      }
      Scene holding = scene_of(body, tool);
      holding.safety = 0.3;  // a held point gives way with the square of the step
      auto held = simulate(holding, GetParam());
      until(*held, 1);
      Scene bare;
      bare.bodies = {same};
      auto given = simulate(bare, GetParam());
      until(*given, 1);
      const std::vector<Vec3d> u = held->displacements(0), v = given->displacements(0);
      double apart = 0;
      for (std::size_t n = 0; n < u.size(); ++n) apart = std::max(apart, (eigen(u[n]) - eigen(v[n])).norm());
      check(std::string(name_of(cut)) + (turns ? ": turned" : ": pulled") + ", difference over the largest displacement",
            apart / largest(v), 1.5e-2);
      Vector3d force = Vector3d::Zero();
      for (const Vec3d& r : reactions(*given, 0)) force += eigen(r);  // of both ends
      check("  the forces of both ends balance", force.norm(), 1e-4);
      Vector3d pull_on_top = Vector3d::Zero();
      const std::vector<Vec3d> r = reactions(*given, 0);
      for (std::size_t n = 0; n < r.size(); ++n) {
        if (given->model().bodies[0].rest[n][2] > 0.5 * kSide) pull_on_top += eigen(r[n]);
      }
      const Wrench& on_tool = held->report().tools[0].now;
      if (!turns) check("  force", (eigen(on_tool.force) + pull_on_top).norm() / pull_on_top.norm(), 1e-3);
    }
  }
}

/// Tissue slips out where the traction is that of the grip: at once under a plate, where the traction is the same everywhere,
/// and then moves freely.
TEST_P(GripPhysics, SlipsOutAtItsStrength) {
  for (const auto& [strength, safety] : {std::pair{500.0, 0.9}, {1500.0, 0.9}, {500.0, 0.3}, {1500.0, 0.3}}) {
    ContactTool tool = plate();
    tool.grip->strength = strength;
    move(tool, 1, {0, 0, 0.02});
    Body body = cube(Discretization::hex8_bricks, 60);
    body.material = material_young(Law::neo_hookean, 2e4, 0);
    body.material.damping = 60;
    body.fixed.push_back({face(2, 0), {true, true, true}});
    Scene scene = scene_of(body, tool);
    scene.safety = safety;
    auto sim = simulate(scene, GetParam());
    double most = 0;
    while (sim->time() < 1) {
      sim->advance(1);
      most = std::max(most, -sim->report().tools[0].now.force[2]);
    }
    check_relative("largest force", most, strength * kSide * kSide, 0.1);  // of all steps, of which the largest counts
    until(*sim, 1.5);
    EXPECT_EQ(sim->report().tools[0].now.force, Vec3d{});
    check("  free again, displacement", largest(sim->displacements(0)), 1e-4);
  }
}

/// Outside of its times a tool holds nothing: the body falls off, and is not gripped again from afar.
TEST_P(GripPhysics, LetsGoInTime) {
  ContactTool tool = plate();
  tool.grip->times = {{0, 0.6}, {0.8, 0.9}};
  Scene scene = scene_of(cube(Discretization::tet4, 20), tool);
  scene.gravity = {0, 0, -9.81};
  auto sim = simulate(scene, GetParam());
  until(*sim, 0.6);
  const double hung = mean(sim->displacements(0), 2);
  EXPECT_GT(hung, -1e-3);
  const double start = sim->time();
  until(*sim, 0.9);
  const double t = sim->time() - start, c = 20, fall = 9.81 / c * (t - (1 - std::exp(-c * t)) / c);
  check_relative("fall", hung - mean(sim->displacements(0), 2), fall, 0.02);
}

/// A cut takes a part away; what the tool holds stays held.
TEST_P(GripPhysics, HoldsOnThroughACut) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    Scene scene = scene_of(cube(cut, 40), plate());
    scene.gravity = {0, 0, -9.81};
    Blade blade;
    blade.name = "blade";
    blade.path = {{0.1, -0.01, -0.02, 0.02, -0.01, 0.07, 0.02}, {0.3, 0.06, -0.02, 0.021, 0.06, 0.07, 0.021}};
    scene.blades = {blade};
    auto sim = simulate(scene, GetParam());
    until(*sim, 0.8);
    double top = 0, bottom = 0;
    for (std::size_t n = 0; n < sim->model().bodies[0].rest.size(); ++n) {
      const double z = sim->displacements(0)[n][2];
      if (sim->model().bodies[0].rest[n][2] > kSide - 1e-6) top = std::max(top, std::abs(z));
      bottom = std::min(bottom, z);
    }
    check(std::string(name_of(cut)) + ": the held face stays", top, 1e-4);
    EXPECT_LT(bottom, -0.1) << "the other part falls";
  }
}

/// A cube that stands on its bottom and is pulled up by a fifth of its height.
Scene pulled_cube(Discretization cut) {
  ContactTool tool = plate();
  move(tool, 0.3, {0, 0, 0.01});
  Body body = cube(cut, 60);
  body.fixed.push_back({face(2, 0), {true, true, true}});
  return scene_of(body, tool);
}

/// What is held under a pull stays held while a cut goes on below it.
TEST_P(GripPhysics, HoldsStretchedTissueThroughACut) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    Scene scene = pulled_cube(cut);
    Blade blade;
    blade.name = "blade";
    blade.path = {{0.6, -0.01, -0.02, 0.02, -0.01, 0.07, 0.02}, {0.8, 0.025, -0.02, 0.02, 0.025, 0.07, 0.02}};
    scene.blades = {blade};
    auto sim = simulate(scene, GetParam());
    until(*sim, 0.59);
    const ToolLoad before = sim->report().tools[0].now;
    until(*sim, 1.2);
    const ToolLoad after = sim->report().tools[0].now;
    EXPECT_GE(after.points, before.points) << name_of(cut);
    EXPECT_LT(after.force[2], 0.4 * before.force[2]) << name_of(cut) << ": half of it is cut, the other half pulls";
    double top = 0;
    for (std::size_t n = 0; n < sim->model().bodies[0].rest.size(); ++n) {
      if (sim->model().bodies[0].rest[n][2] > kSide - 1e-6) top = std::max(top, std::abs(sim->displacements(0)[n][2] - 0.01));
    }
    check(std::string(name_of(cut)) + ": the held face stays", top, 5e-4);
  }
}

/// An edit elsewhere is not felt at the grip: its force in the next step is that of the step before.
TEST_P(GripPhysics, ACutElsewhereIsNotFelt) {
  for (const Discretization cut : {Discretization::hex8_bricks, Discretization::tet4}) {
    Scene scene = pulled_cube(cut);
    scene.cuttable = true;
    auto sim = simulate(scene, GetParam());
    until(*sim, 0.8);
    const double before = sim->report().tools[0].now.force[2];
    const Vec3d a{0.3 * kCell, -1, 0.2 * kCell}, b{0.3 * kCell, 1, 0.2 * kCell}, c{-1, -1, 0.6 * kCell}, d{-1, 1, 0.6 * kCell};
    ASSERT_GT(sim->cut(std::array<SweepTriangle, 2>{SweepTriangle{a, b, c}, SweepTriangle{b, d, c}}).edges, 0);
    sim->advance(1);
    check_relative(std::string(name_of(cut)) + ": force on the tool", sim->report().tools[0].now.force[2], before, 0.02);
  }
}

/// A grip that holds nothing is told: nothing began it, or nothing was there when it began.
TEST(GripRemarks, TellOfGripsThatHoldNothing) {
  const auto said = [](ContactTool tool, const std::string& sentence) {
    Body body = cube(Discretization::hex8_bricks, 60);
    body.fixed.push_back({face(2, 0), {true, true, true}});
    auto sim = simulate(scene_of(body, tool), "cpu");
    until(*sim, 0.05);
    for (const std::string& remark : run_remarks(*sim)) {
      if (remark.find(sentence) != std::string::npos) return true;
    }
    return false;
  };
  const char *const untold = "nothing told it to grip: it holds no tissue", *const empty =
                                                                                "and holds no tissue: it holds what it touches";
  ContactTool tool = plate();
  EXPECT_FALSE(said(tool, "holds no tissue"));
  tool.grip->times.clear();
  EXPECT_TRUE(said(tool, untold));
  tool = plate();
  for (auto& row : tool.path) row[3] += 0.05;
  EXPECT_TRUE(said(tool, empty));
}

/// Tools are those that are there: one before it in the scene may be gone.
TEST(GripRemarks, FollowToolsThatAreRemoved) {
  Body body = cube(Discretization::hex8_bricks, 60);
  body.fixed.push_back({face(2, 0), {true, true, true}});
  Scene scene = scene_of(body, plate());
  ContactTool far = plate();
  far.name = "far";
  far.grip.reset();
  for (auto& row : far.path) row[3] += 1;
  scene.tools.insert(scene.tools.begin(), far);
  auto sim = simulate(scene, "cpu");
  until(*sim, 0.02);
  sim->tools().remove("far");
  until(*sim, 0.05);
  for (const std::string& remark : run_remarks(*sim)) EXPECT_EQ(remark.find("holds no tissue"), std::string::npos) << remark;
}

PLIANT_ON_BACKENDS(GripPhysics);

}  // namespace
}  // namespace pliant::physics::grip_test
