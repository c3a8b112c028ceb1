// Springs against closed forms: frequencies of a chain, Duffing's period, decay; a network against Newton's method, momenta,
// energy, and two half bars joined by springs.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/harness.h"

namespace pliant::physics {
namespace {

class Springs : public OnBackend {};

/// Masses in a row along x, both ends held, joined by springs with one law; start: displacements of the free ones [m].
struct Chain {
  Spring law;
  double edge = 0.1, mass = 0.02;  ///< [m], [kg]
  std::vector<double> start;
  bool wall_at_end = true;
};

/// A scene with enough nodes, and a model in which springs join them in a row.
std::unique_ptr<Simulation> simulate_chain(const Chain& chain, double dt, const char* backend) {
  const std::size_t nodes = chain.start.size() + (chain.wall_at_end ? 2 : 1);
  Scene scene;
  Body body = box_body({{static_cast<int>(nodes), 1, 1}, chain.edge}, Discretization::tet4,
                       material_young(Law::neo_hookean, 1000, 0.25));
  body.model.type = ModelType::mass_spring;
  scene.bodies = {body};
  scene.dt = dt;
  auto model = std::make_shared<Model>(build_model(scene));
  SpringBatch batch;
  batch.law = chain.law;
  batch.body = 0;
  batch.label = "chain";
  model->links = {};
  std::fill(model->displacement.begin(), model->displacement.end(), Vec3d{});
  model->displacement.resize(static_cast<std::size_t>(model->slots));
  for (std::size_t n = 0; n < nodes; ++n) {
    const std::int32_t slot = model->bodies[0].slot[n];
    const Vec3d place{static_cast<double>(n) * chain.edge, 0, 0};
    model->rest[slot] = place;
    model->mass[slot] = chain.mass;
    model->links.points.add_node(slot, place);
    const bool held = n == 0 || (chain.wall_at_end && n + 1 == nodes);
    if (held) model->constraints.push_back({slot, 7});
    if (!held) model->displacement[slot] = {chain.start[n - 1], 0, 0};
    if (n == 0) continue;
    batch.points.push_back({static_cast<std::int32_t>(n) - 1, static_cast<std::int32_t>(n)});
    batch.length.push_back(chain.edge);
    batch.parameters.push_back(spring_parameters(chain.law, chain.edge, 1, chain.law.stiffness));
    batch.damper.push_back(chain.law.damping);
  }
  std::sort(model->constraints.begin(), model->constraints.end(), [](const auto& a, const auto& b) { return a.slot < b.slot; });
  model->links.springs = {batch};
  return std::make_unique<Simulation>(scene, std::shared_ptr<const Model>(model), open_backend(backend));
}

double displacement_of(const Simulation& sim, std::size_t node) { return sim.displacements(0)[node][0]; }

TEST_P(Springs, ChainHasTheFrequenciesOfItsClosedForm) {
  constexpr int n = 9;
  for (const int mode : {1, 4, 9}) {
    Chain chain;
    chain.law.stiffness = 50;
    for (int i = 1; i <= n; ++i) chain.start.push_back(1e-3 * std::sin(std::numbers::pi * i * mode / (n + 1)));
    const double omega = 2 * std::sqrt(chain.law.stiffness / chain.mass) * std::sin(std::numbers::pi * mode / (2 * (n + 1)));
    const double h = 1e-4;
    auto sim = simulate_chain(chain, h, GetParam());
    const double discrete = 2 / h * std::asin(omega * h / 2);  // of central differences
    double error = 0;
    for (int k = 0; k < 40; ++k) {
      sim->advance(50);
      for (std::size_t i = 1; i <= n; ++i)
        error = std::max(error, std::abs(displacement_of(*sim, i) - chain.start[i - 1] * std::cos(discrete * sim->time())));
    }
    check("chain of 9, mode " + std::to_string(mode) + ", over its amplitude", error / 1e-3, bound(2e-3, 1e-8));
  }
}

TEST_P(Springs, CubicLawHasDuffingsPeriod) {
  Chain chain;
  chain.law.law = SpringLaw::cubic;
  chain.law.lambda1 = 60, chain.law.lambda2 = 0.5;
  chain.start = {0.04};
  chain.wall_at_end = false;
  const double a0 = chain.law.lambda2 / (chain.mass * chain.edge),
               b = chain.law.lambda1 / (chain.mass * std::pow(chain.edge, 3));
  const double square = b * 0.04 * 0.04, q = std::sqrt(square / (2 * (a0 + square)));
  const double period = 4 * std::comp_ellint_1(q) / std::sqrt(a0 + square);
  auto sim = simulate_chain(chain, period / 20000, GetParam());
  double last = 0.04, crossed = 0;
  int crossings = 0;
  for (int i = 0; i < 60000 && crossings < 5; ++i) {  // a quarter of the period, then one each half
    sim->advance(1);
    const double now = displacement_of(*sim, 1);
    if ((now > 0) != (last > 0)) {
      ++crossings;
      crossed = sim->time() - sim->dt() * now / (now - last);
    }
    last = now;
  }
  ASSERT_EQ(crossings, 5);
  check_relative("Duffing's period from five zeros", crossed / 2.25, period, bound(1e-4, 1e-6));
}

TEST_P(Springs, DamperMakesAnOscillationDecay) {
  Chain chain;
  chain.law.stiffness = 80, chain.law.damping = 0.4;
  chain.start = {1e-3};
  chain.wall_at_end = false;
  const double h = 2e-5, rate = chain.law.damping / (2 * chain.mass);
  const double omega = std::sqrt(chain.law.stiffness / chain.mass - rate * rate);
  auto sim = simulate_chain(chain, h, GetParam());
  double error = 0;
  for (int k = 0; k < 100; ++k) {
    sim->advance(100);
    const double t = sim->time();
    const double exact = 1e-3 * std::exp(-rate * t) * (std::cos(omega * t) + rate / omega * std::sin(omega * t));
    error = std::max(error, std::abs(displacement_of(*sim, 1) - exact));
  }
  check("damped spring over its amplitude", error / 1e-3, 3e-3);
}

Body network(const Box& box, double young) {
  Body body = box_body(box, Discretization::tet4, material_young(Law::neo_hookean, young, 0.25));
  body.model.type = ModelType::mass_spring;
  return body;
}

TEST_P(Springs, FreeNetworkKeepsMomentaAndEnergy) {
  Scene scene;
  Body body = network({{4, 2, 2}, 0.05, 0.2, 4}, 3000);
  body.velocity = {0.3, -0.2, 0.1};
  body.angular_velocity = {4, 6, -3};
  scene.bodies = {body};
  scene.dt = 3e-4;
  auto sim = simulate(scene, GetParam());
  ASSERT_LT(scene.dt, 0.8 * sim->stable_dt());
  const auto total = [&] {
    const auto u = read_texels(*sim, "node_u");
    auto v = read_texels(*sim, "node_w");
    sim->advance(1);
    const auto next = read_texels(*sim, "node_w");
    for (std::size_t s = 0; s < v.size(); ++s) v[s] = plain((eigen(v[s]) + eigen(next[s])) / (2 * sim->dt()));
    return energies(sim->model(), u, v, {}).total();
  };
  const Momenta before = momenta_of(*sim);
  const double energy = total();
  double drift = 0;
  for (int i = 0; i < 20; ++i) {
    sim->advance(99);
    drift = std::max(drift, std::abs(total() / energy - 1));
  }
  const Momenta after = momenta_of(*sim);
  const auto spin = [](const Momenta& m) { return Vector3d(eigen(m.angular) - eigen(m.centre).cross(eigen(m.linear))); };
  check("linear momentum", (eigen(after.linear) - eigen(before.linear)).norm() / eigen(before.linear).norm(),
        bound(5e-6, 1e-12));
  check("angular momentum", (spin(after) - spin(before)).norm() / spin(before).norm(), bound(2e-5, 1e-12));
  check("largest change of energy in 2000 steps", drift, 2e-4);
}

/// Residual of the free nodes of a network, and its tangent, in double and from the definition of a spring alone.
struct Net {
  const Model& model;
  Vec3d gravity;
  std::vector<std::int32_t> free;  ///< number of each slot among the unknowns, -1: held
  Eigen::VectorXd residual;
  Eigen::MatrixXd tangent;

  void evaluate(const Eigen::VectorXd& x) {
    const auto at = [&](std::int32_t slot) {
      return free[slot] < 0 ? eigen(model.rest[slot]) : Vector3d(x.segment<3>(3 * free[slot]));
    };
    residual.setZero(x.size());
    tangent.setZero(x.size(), x.size());
    for (std::size_t s = 0; s < free.size(); ++s) {
      if (free[s] >= 0) residual.segment<3>(3 * free[s]) += model.mass[s] * eigen(gravity);
    }
    const SpringBatch& b = model.links.springs[0];
    for (std::size_t i = 0; i < b.size(); ++i) {
      const std::int32_t p = model.links.points.slots[b.points[i][0]][0], q = model.links.points.slots[b.points[i][1]][0];
      const Vector3d d = at(q) - at(p), n = d.normalized();
      const double k = b.parameters[i][1], force = k * (d.norm() - b.length[i]);
      const Matrix3d stiff = k * n * n.transpose() + force / d.norm() * (Matrix3d::Identity() - n * n.transpose());
      for (const auto& [one, other, sign] : {std::tuple(p, q, 1.0), std::tuple(q, p, -1.0)}) {
        if (free[one] < 0) continue;
        residual.segment<3>(3 * free[one]) += sign * force * n;
        tangent.block<3, 3>(3 * free[one], 3 * free[one]) -= stiff;
        if (free[other] >= 0) tangent.block<3, 3>(3 * free[one], 3 * free[other]) += stiff;
      }
    }
  }
};

TEST_P(Springs, HangingNetIsInTheEquilibriumOfNewtonsMethod) {
  Scene scene;
  Body body = network({{3, 4, 1}, 0.02, 0.1, 3}, 4000);
  body.material.damping = 5;
  body.fixed.push_back({face(1, 0.08), {true, true, true}});
  scene.bodies = {body};
  scene.gravity = {3, -9.81, 0};
  scene.relaxation.enabled = true;
  scene.relaxation.tolerance = in_double() ? 1e-8 : 1e-4;
  auto sim = simulate(scene, GetParam());
  settle(*sim);
  const Model& model = sim->model();
  Net net{model, scene.gravity, std::vector<std::int32_t>(model.mass.size(), -1), {}, {}};
  std::int32_t count = 0;
  for (const std::int32_t s : model.bodies[0].slot) {
    if (model.rest[s][1] < 0.08 - 1e-9) net.free[s] = count++;
  }
  Eigen::VectorXd x(3 * count);
  for (const std::int32_t s : model.bodies[0].slot) {
    if (net.free[s] >= 0) x.segment<3>(3 * net.free[s]) = eigen(model.rest[s]);
  }
  for (int load = 1; load <= 4; ++load) {
    for (int c = 0; c < 3; ++c) net.gravity[c] = scene.gravity[c] * load / 4;
    for (int i = 0; i < 30; ++i) {
      net.evaluate(x);
      x -= net.tangent.fullPivLu().solve(net.residual);
    }
  }
  net.evaluate(x);
  ASSERT_LT(net.residual.norm(), 1e-10);
  double error = 0, most = 0;
  const std::vector<Vec3d> u = sim->displacements(0);
  for (std::size_t n = 0; n < u.size(); ++n) {
    const std::int32_t s = model.bodies[0].slot[n];
    if (net.free[s] < 0) continue;
    const Vector3d exact = x.segment<3>(3 * net.free[s]) - eigen(model.rest[s]);
    error = std::max(error, (eigen(u[n]) - exact).norm());
    most = std::max(most, exact.norm());
  }
  check("hanging net against Newton's method, over " + std::to_string(most) + " m", error / most, bound(2e-3, 1e-6));
}

/// Two bars in series: elements, and a block that springs join to it across a gap.
TEST_P(Springs, JoinedBarsAreSpringsInSeries) {
  const double edge = 0.02, young = 8000, gap = 0.01, pull_force = 0.02, each = 3;
  Scene scene;
  Body bar = box_body({{4, 1, 1}, edge}, Discretization::hex8full, material_young(Law::neo_hookean, young, 0));
  bar.name = "bar";
  bar.material.damping = 30;
  bar.fixed.push_back({face(0, 0), {true, true, true}});
  Body block = network({{1, 1, 1}, edge}, 4e4);
  block.name = "block";
  block.material.damping = 30;
  block.translate = {4 * edge + gap, 0, 0};
  Force force;
  force.where = face(0, 4 * edge + gap);
  force.force = {pull_force, 0, 0};
  block.forces.push_back(force);
  block.fixed.push_back({all_nodes(), {false, true, true}});
  scene.bodies = {bar, block};
  Join join;
  join.bodies = {"bar", "block"};
  join.distance = 1.2 * gap;
  join.spring.stiffness = each;
  scene.joins = {join};
  scene.relaxation.enabled = true;
  scene.relaxation.tolerance = in_double() ? 1e-8 : 1e-4;
  auto sim = simulate(scene, GetParam());
  const SpringBatch& joined = sim->model().links.springs.back();
  ASSERT_EQ(joined.size(), 4U);
  settle(*sim);
  double mean = 0;
  const std::vector<Vec3d> u = sim->displacements(1);
  int nodes = 0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (sim->model().bodies[1].rest[n][0] > 4 * edge + gap + 1e-6) continue;
    mean += u[n][0];
    ++nodes;
  }
  const double exact = pull_force * (4 * edge / (young * edge * edge) + 1 / (4 * each));
  check_relative("F (L / E A + 1 / k)", mean / nodes, exact, 0.01);
}

/// The sum of second parameters (stiffness) of the springs between two places at rest.
std::map<std::array<Vec3d, 2>, double> stiffness_by_place(const Model& model) {
  std::map<std::array<Vec3d, 2>, double> sums;
  for (const SpringBatch& b : model.links.springs) {
    for (std::size_t s = 0; s < b.size(); ++s) {
      std::array<Vec3d, 2> at{model.links.points.rest[b.points[s][0]], model.links.points.rest[b.points[s][1]]};
      std::sort(at.begin(), at.end());
      sums[at] += b.parameters[s][1];
    }
  }
  return sums;
}

TEST(SpringsCut, PiecesOfAnEdgeShareItsStiffness) {
  Scene scene;
  Body body = network({{4, 2, 2}, 0.05, 0.1, 2}, 3000);
  body.model.spring.stiffness = 7;
  scene.bodies = {body};
  scene.least_fill = 0;
  scene.cuttable = true;
  const auto sim = simulate(scene, "cpu");
  const auto before = stiffness_by_place(sim->model());
  for (const auto& [at, k] : before) ASSERT_NEAR(k, 7, 1e-12);
  const std::size_t springs = sim->model().links.springs[0].size();
  const Vec3d a{0.093, -1, -1}, b{0.093, 1, -1}, c{0.093, -1, 1}, d{0.093, 1, 1};
  const std::array<SweepTriangle, 2> plane{SweepTriangle{a, b, c}, SweepTriangle{b, d, c}};
  ASSERT_GT(sim->cut(plane).edges, 0);
  EXPECT_GT(sim->model().links.springs[0].size(), springs) << "the edges across the cut are there twice";
  const auto after = stiffness_by_place(sim->model());
  EXPECT_EQ(after.size(), before.size());
  for (const auto& [at, k] : after) EXPECT_NEAR(k, 7, 1e-9);
  EXPECT_GT(sim->advance(200), 0);
  EXPECT_FALSE(sim->divergence().has_value());
}

TEST(SpringsJoin, BreakWhenStretchedAndThenPullNoMore) {
  const double edge = 0.02, gap = 0.01;
  Scene scene;
  Body held = network({{2, 1, 1}, edge}, 3000), free = network({{1, 1, 1}, edge}, 3000);
  held.name = "held", free.name = "free";
  held.fixed.push_back({all_nodes(), {true, true, true}});
  free.translate = {2 * edge + gap, 0, 0};
  free.velocity = {0.5, 0, 0};
  scene.bodies = {held, free};
  Join join;
  join.bodies = {"held", "free"};
  join.distance = 1.2 * gap;
  join.spring.stiffness = 2;
  join.break_stretch = 1.5;
  scene.joins = {join};
  scene.dt = 5e-4;
  const auto sim = simulate(scene, "cpu");
  const auto springs = [&] {
    return std::count_if(sim->program().step.begin(), sim->program().step.end(),
                         [](const Pass& p) { return p.kernel == "spring_force"; });
  };
  const auto before = springs();
  const double speed = momenta_of(*sim).linear[0];
  while (sim->state().broken.empty() && sim->time() < 0.2) sim->advance(16);
  ASSERT_EQ(sim->state().broken.size(), 1U);
  while (sim->state().broken[0].size() < 4 && sim->time() < 0.2) sim->advance(16);
  EXPECT_EQ(sim->state().broken[0], (std::vector<std::int32_t>{0, 1, 2, 3}));
  EXPECT_EQ(springs(), before - 1);
  const double kept = momenta_of(*sim).linear[0];
  EXPECT_LT(kept, speed) << "the joins have pulled";
  sim->advance(200);
  EXPECT_NEAR(momenta_of(*sim).linear[0], kept, 1e-5 * kept) << "and no longer do";
}

TEST(SpringsOff, ScenesWithoutLinksHaveNoneOfTheirPassesAndBuffers) {
  Scene scene;
  scene.bodies = {box_body({{2, 1, 1}, 0.05}, Discretization::tet4, material_young(Law::neo_hookean, 3000, 0.3))};
  const auto sim = simulate(scene, "cpu");
  for (const Pass& pass : sim->program().step) {
    EXPECT_EQ(pass.kernel.find("link"), std::string::npos);
    EXPECT_EQ(pass.kernel.find("spring"), std::string::npos);
    EXPECT_NE(pass.kernel, "node_load");
  }
  for (const char* name : {"link_u", "link_force", "link_node"}) EXPECT_LT(sim->program().find(name), 0) << name;
}

TEST(SpringsOff, NetworkHasNoElements) {
  Scene scene;
  scene.bodies = {network({{2, 1, 1}, 0.05}, 3000)};
  const auto sim = simulate(scene, "cpu");
  EXPECT_TRUE(sim->model().batches.empty());
  EXPECT_NEAR(sim->model().bodies[0].mass, 1000 * 2 * 0.05 * 0.05 * 0.05, 1e-9);
  // Van Gelder: k l^2 summed over the edges of a tetrahedron is 6 E V.
  double sum = 0;
  const SpringBatch& b = sim->model().links.springs.at(0);
  for (std::size_t s = 0; s < b.size(); ++s) sum += b.parameters[s][1] * b.length[s] * b.length[s];
  EXPECT_NEAR(sum, 6 * 3000 * 2 * 0.05 * 0.05 * 0.05, 1e-9);
}

PLIANT_ON_BACKENDS(Springs);

}  // namespace
}  // namespace pliant::physics
