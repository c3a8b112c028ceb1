// The step of networks of springs: safe however they turn and deform, shorter where they stiffen; and what is said of networks
// that are lost or inside out.
#include <algorithm>
#include <map>

#include "cutting/blade/blade.h"
#include "physics/harness.h"
#include "simulation/measure/run_remarks.h"

namespace pliant::physics::network_stability_test {
namespace {

class NetworkStep : public OnBackend {};

Scene network_scene(const Box& box, double damping = 5) {
  Scene scene;
  Body body = box_body(box, Discretization::tet4, material_young(Law::neo_hookean, 5000, 0.25));
  body.name = "net";
  body.model.type = ModelType::mass_spring;
  body.material.damping = damping;
  scene.bodies = {body};
  return scene;
}

double energy_of(Simulation& sim) {
  std::vector<Vec3d> w = read_texels(sim, "node_w");
  for (Vec3d& x : w) x = plain(eigen(x) / sim.dt());
  const Energies e = energies(sim.model(), read_texels(sim, "node_u"), w, {});
  return e.kinetic + e.strain;
}

/// The largest squared frequency of the network of a model where its slots are at `x`, from the tangents of its springs.
double largest_omega2(const Model& model, const std::vector<Vector3d>& x) {
  const auto slots = static_cast<Eigen::Index>(model.slots);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 * slots, 3 * slots);
  for (const SpringBatch& b : model.links.springs) {
    for (std::size_t s = 0; s < b.size(); ++s) {
      const std::int32_t p = model.links.points.slots[b.points[s][0]][0], q = model.links.points.slots[b.points[s][1]][0];
      const Vector3d d = x[q] - x[p], n = d.normalized();
      const SpringState state = spring_state(b.law, b.parameters[s], d.norm() - b.length[s]);
      const Matrix3d t = state.slope * n * n.transpose() + state.force / d.norm() * (Matrix3d::Identity() - n * n.transpose());
      for (const auto& [i, j, sign] :
           {std::tuple(p, p, 1.0), std::tuple(q, q, 1.0), std::tuple(p, q, -1.0), std::tuple(q, p, -1.0)})
        k.block<3, 3>(3 * i, 3 * j) += sign * t / std::sqrt(model.mass[i] * model.mass[j]);
    }
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[k.rows() - 1];
}

/// Linear springs, in every configuration that a random motion finds; the bound is less than 1.6 times the largest one found.
TEST(NetworkBound, HoldsHoweverTheNodesMove) {
  for (const double stiffness : {0.0, 12.0}) {
    Scene scene = network_scene({{3, 2, 2}, 0.01, 0.15, 5});
    scene.bodies[0].model.spring.stiffness = stiffness;
    const Model model = build_model(scene);
    ASSERT_GT(model.network_bound, 0);
    const double bound = 4 / (model.network_bound * model.network_bound);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    double most = 0;
    for (const double size : {0.0, 0.002, 0.01, 0.05, 1.0}) {
      for (int trial = 0; trial < 20; ++trial) {
        std::vector<Vector3d> x;
        for (const Vec3d& rest : model.rest) x.push_back(eigen(rest) + size * Vector3d(any(random), any(random), any(random)));
        most = std::max(most, largest_omega2(model, x));
      }
      // All springs along one line are as stiff in it as they can be.
      std::vector<Vector3d> line;
      for (const Vec3d& rest : model.rest) line.emplace_back(rest[0] + size * any(random), 1e-9 * rest[1], 1e-9 * rest[2]);
      most = std::max(most, largest_omega2(model, line));
    }
    std::printf("  squared frequency: largest found %.4g, bound %.4g, ratio %.3f\n", most, bound, most / bound);
    EXPECT_LE(most, bound * (1 + 1e-9));
    EXPECT_GE(most, bound / 1.6);
  }
}

/// At the automatic step no deformation adds energy.
TEST_P(NetworkStep, DeformedNetworksCalmDown) {
  const std::vector<std::pair<const char*, Matrix3d>> starts{{"pressed to a half", -0.5 * Matrix3d::Identity()},
                                                             {"twice as long", Matrix3d::Identity()},
                                                             {"flat", Vector3d(0, -0.9, 0).asDiagonal().toDenseMatrix()},
                                                             {"sheared", (Matrix3d() << 0, 2, 0, 0, 0, 0, 0, 0, 0).finished()}};
  for (const auto& [name, h] : starts) {
    Scene scene = network_scene({{4, 4, 4}, 0.01, 0.1, 3});
    auto sim = simulate(scene, GetParam());
    write_texels(*sim, "node_u", displaced(sim->model(), [&m = h](const Vector3d& x) { return Vector3d(m * x); }));
    const double start = energy_of(*sim);
    double most = 0;
    for (int i = 0; i < 40; ++i) {
      sim->advance(25);
      most = std::max(most, energy_of(*sim));
    }
    EXPECT_FALSE(sim->divergence().has_value()) << name;
    check(std::string(name) + ": most energy over that of the start", most / start, 1.01);
    EXPECT_LT(energy_of(*sim), 0.05 * start) << name;
  }
}

/// Tables a hundred times as stiff beyond two millimetres, and flat before them: the step follows them, and grows again.
TEST_P(NetworkStep, FollowsSpringsThatStiffen) {
  for (const double toe : {0.005, 0.0}) {
    Scene scene = network_scene({{6, 2, 2}, 0.01, 0.1, 3});
    scene.bodies[0].model.spring.law = SpringLaw::curve;
    scene.bodies[0].model.spring.curve = {{0, 0}, {0.001, toe}, {0.002, 0.5}};
    scene.bodies[0].fixed.push_back({face(0, 0), {true, true, true}});
    Force pulse;
    pulse.where = face(0, 0.06);
    pulse.force = {0.3, 0, 0};
    pulse.curve.kind = Curve::Kind::table;
    pulse.curve.table = {{0, 1}, {0.4, 1}, {0.41, 0}, {9, 0}};
    scene.bodies[0].forces = {pulse};
    auto sim = simulate(scene, GetParam());
    const double first = sim->dt();
    double least = first, most = 0;
    while (sim->time() < 0.4 && !sim->divergence()) {
      sim->advance(16);
      least = std::min(least, sim->dt());
      most = std::max(most, energy_of(*sim));
    }
    if (toe > 0) {
      EXPECT_LT(least, 0.5 * first);
    }
    while (sim->time() < 2 && !sim->divergence()) sim->advance(64);
    ASSERT_FALSE(sim->divergence().has_value()) << toe;
    EXPECT_LT(energy_of(*sim), 0.05 * most) << toe;
    if (toe > 0) {
      EXPECT_GT(sim->dt(), 1.5 * least);
    }
  }
}

/// Nothing limits the step of loose nodes, and it stays what it was.
TEST_P(NetworkStep, StaysWhereACutHasBrokenAllSprings) {
  Scene scene = network_scene({{4, 2, 2}, 0.01, 0, 3});
  scene.bodies[0].model.edge_springs = false;
  SpringList& list = scene.bodies[0].springs.emplace_back();
  list.spring.stiffness = 2;
  list.nodes = {{0, 4}, {5, 9}};  // along two rows of nodes
  scene.cuttable = true;
  auto sim = simulate(scene, GetParam());
  const double first = sim->dt();
  sim->advance(10);
  const Vec3d a{0.016, -1, -1}, b{0.016, 1, -1}, c{0.016, 0, 2};
  sim->cut(std::array<SweepTriangle, 1>{{{a, b, c}}});
  ASSERT_TRUE(sim->model().links.empty());
  sim->advance(300);
  EXPECT_FALSE(sim->divergence().has_value());
  EXPECT_EQ(sim->dt(), first);
}

TEST_P(NetworkStep, AStepThatIsTooLongIsADivergence) {
  Scene scene = network_scene({{4, 2, 2}, 0.01, 0.1, 3});
  scene.bodies[0].fixed.push_back({face(0, 0), {true, true, true}});
  scene.gravity = {0, -9.81, 0};
  scene.dt = 1;
  scene.dt = 3 * simulate(network_scene({{4, 2, 2}, 0.01, 0.1, 3}), GetParam())->dt();
  auto sim = simulate(scene, GetParam());
  for (int i = 0; i < 100 && !sim->divergence(); ++i) sim->advance(100);
  ASSERT_TRUE(sim->divergence().has_value());
  EXPECT_EQ(sim->divergence()->body, "net");
  EXPECT_TRUE(sim->divergence()->node);
  EXPECT_NE(sim->divergence()->message().find("node"), std::string::npos);
  for (const Vec3d& u : sim->displacements(0)) ASSERT_TRUE(std::isfinite(vec::norm(u)));
}

/// One on the other, they crush their faces; contact of those adds no energy.
TEST_P(NetworkStep, StackedNetworksComeToRest) {
  Scene scene = network_scene({{4, 4, 4}, 0.01, 0, 3});
  Body upper = scene.bodies[0];
  upper.name = "upper";
  upper.translate = {0, 0.042, 0};
  scene.bodies[0].translate = {0, 0.001, 0};
  scene.bodies.push_back(upper);
  scene.contact = TissueContact{0.3};
  ContactTool table;
  table.name = "table";
  table.shape = ToolShape::half_space;
  table.second = {0, 1, 0};
  table.path = {{0, 0, 0, 0, 0, 0, 0, 1}};
  table.friction = 0.3;
  scene.tools = {table};
  scene.gravity = {0, -9.81, 0};
  auto sim = simulate(scene, GetParam());
  double most = 0;
  while (sim->time() < 1.5 && !sim->divergence()) {
    sim->advance(64);
    most = std::max(most, energy_of(*sim));
  }
  ASSERT_FALSE(sim->divergence().has_value());
  // Both weigh 0.128 kg together and come down by 16 mm at most.
  check("most energy [J]", most, 0.04);
  check("energy at the end [J]", energy_of(*sim), 0.02);
}

/// Several networks, a join and vessels in one scene have buffers of their own, also after a cut.
TEST(NetworkBuffers, BackendsAgreeAfterACut) {
  if (!test::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  std::array<std::vector<double>, 2> u;
  for (const bool opencl : {false, true}) {
    Scene scene = network_scene({{6, 2, 2}, 0.01, 0.1, 3});
    Body other = scene.bodies[0];
    other.name = "other";
    other.translate = {0, 0.021, 0};
    scene.bodies[0].fixed.push_back({face(0, 0), {true, true, true}});
    scene.bodies.push_back(other);
    Join join;
    join.bodies = {"net", "other"};
    join.distance = 0.004;
    join.spring.stiffness = 10;
    scene.joins = {join};
    Vessel vessel;
    vessel.points = {{0.005, 0.01, 0.01}, {0.055, 0.011, 0.009}};
    vessel.segments = {{0, 1}};
    vessel.radius = 0.002;
    vessel.young = 1e5;
    scene.bodies[0].vessels = {vessel};
    scene.gravity = {0, -9.81, 0};
    scene.cuttable = true;
    auto sim = simulate(scene, opencl ? "opencl:0" : "cpu");
    sim->advance(40);
    const Vec3d a{0.033, -1, -1}, b{0.033, 1, -1}, c{0.033, -1, 0.006}, d{0.033, 1, 0.006};
    sim->cut(std::array<SweepTriangle, 2>{SweepTriangle{a, b, c}, SweepTriangle{b, d, c}});
    sim->advance(60);
    u[opencl ? 1 : 0] = sim->backend().read_reals(sim->program().find("node_u"));
  }
  EXPECT_EQ(u[0], u[1]);
}

TEST(NetworkRemarks, TellOfTetrahedraThatAreInsideOut) {
  Scene scene = network_scene({{4, 2, 2}, 0.01, 0, 3}, 20);
  auto sim = simulate(scene, "cpu");
  EXPECT_TRUE(run_remarks(*sim).empty());
  write_texels(*sim, "node_u", displaced(sim->model(), [](const Vector3d& x) { return Vector3d(-2 * x[0], 0, 0); }));
  const std::vector<std::string> remarks = run_remarks(*sim);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks[0].find("96 of 96 tetrahedra of the network 'net' are inside out"), std::string::npos) << remarks[0];
}

PLIANT_ON_BACKENDS(NetworkStep);

}  // namespace
}  // namespace pliant::physics::network_stability_test
