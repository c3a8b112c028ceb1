// Norton's equivalent against the static solution of the whole block.
#include "haptics/condensed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/vec.h"
#include "haptics/coupling.h"
#include "haptics/held.h"
#include "statics/statics.h"
#include "statics/system.h"
#include "support/error_of.h"

namespace pliant::haptics::condensed_test {
namespace {

const Vec3d kSize{0.04, 0.04, 0.02};

/// A soft block on a table, under its own weight.
statics::Problem block() {
  statics::Problem p;
  p.mesh = statics::box_mesh(statics::Element::hex8full, {4, 4, 3}, kSize);
  p.materials = {make_material(Law::neo_hookean, Moduli::from_bulk(1500, 6000), 1000)};
  p.gravity = {0, 0, -9.81};
  statics::prescribe(
      p, [](const Vec3d& x) { return std::abs(x[2]) < 1e-9; }, 7);
  return p;
}

statics::Settings linear() {
  statics::Settings settings;
  settings.linear = true;
  return settings;
}

/// Top nodes within 11 mm of the middle.
bool touched(const Vec3d& x) { return std::abs(x[2] - kSize[2]) < 1e-9 && std::hypot(x[0] - 0.02, x[1] - 0.02) < 0.011; }

struct Condensed {
  Norton norton;
  std::vector<std::int32_t> nodes;
  std::vector<Vec3d> arms;
};

const Vec3d kOrigin{0.021, 0.019, 0.026};  // of the instrument

Condensed condensed() {
  const statics::Problem p = block();
  const statics::System system(p, true);
  statics::Forces forces;
  statics::SparseMatrix lower = system.pattern();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.components());
  EXPECT_TRUE(system.tangent(zero, 1, forces, lower));
  const statics::SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  Condensed out;
  out.nodes = statics::nodes_where(p.mesh, touched);
  std::vector<int> components;
  for (const std::int32_t node : out.nodes) {
    for (int axis = 0; axis < 3; ++axis) components.push_back(system.free_of()[static_cast<std::size_t>(3 * node + axis)]);
    out.arms.push_back(vec::sub(p.mesh.nodes[static_cast<std::size_t>(node)], kOrigin));
  }
  out.norton = condense(whole, components, system.free_part(forces.external - forces.internal));
  return out;
}

/// What the contact nodes exert on what moves them with an instrument, by the solver of the whole.
Wrench exerted(const Vec3d& shift, const Vec3d& turn) {
  statics::Problem p = block();
  const std::vector<std::int32_t> nodes = statics::nodes_where(p.mesh, touched);
  for (const std::int32_t node : nodes) {
    const Vec3d arm = vec::sub(p.mesh.nodes[static_cast<std::size_t>(node)], kOrigin);
    const Vec3d u = vec::add(shift, vec::cross(turn, arm));
    for (int axis = 0; axis < 3; ++axis) p.prescribed.push_back({node, axis, u[static_cast<std::size_t>(axis)], 1});
  }
  const statics::Solution s = statics::solve(p, linear());
  EXPECT_TRUE(s.converged) << s.failure;
  Wrench out;
  for (const std::int32_t node : nodes) {
    const Vec3d arm = vec::sub(p.mesh.nodes[static_cast<std::size_t>(node)], kOrigin);
    const Vec3d force = vec::mul(s.reaction[static_cast<std::size_t>(node)], -1);
    out.force = vec::add(out.force, force);
    out.torque = vec::add(out.torque, vec::cross(arm, force));
  }
  return out;
}

FrameReport report_of(const Wrench& wrench, std::int64_t topology) {
  FrameReport r;
  r.mean = wrench;
  r.last = wrench;
  r.topology = topology;
  r.tool.position = kOrigin;
  return r;
}

TEST(Condensed, IsTheStaticSolutionOfTheWhole) {
  const Condensed c = condensed();
  ASSERT_EQ(c.nodes.size(), 5u);
  EXPECT_NEAR((c.norton.stiffness - c.norton.stiffness.transpose()).norm(), 0, 1e-9 * c.norton.stiffness.norm());
  CondensedForce model(true);
  model.linearise({rigid_stiffness(c.norton, c.arms), 3});
  model.receive(report_of(exerted({}, {}), 3));
  ASSERT_TRUE(model.linear());
  for (const auto& [shift, turn] :
       {std::pair{Vec3d{0, 0, -2e-3}, Vec3d{}}, std::pair{Vec3d{1e-3, 0, 0}, Vec3d{}}, std::pair{Vec3d{}, Vec3d{0, 0, 0.02}},
        std::pair{Vec3d{1e-3, -5e-4, 1e-3}, Vec3d{0.03, 0, 0}}}) {
    const Wrench exact = exerted(shift, turn);
    Pose tool = turned({kOrigin}, turn);
    tool.position = vec::add(kOrigin, shift);
    const Wrench w = model.tick(tool, 1e-3);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(w.force[a], exact.force[a], 1e-8 * (1 + vec::norm(exact.force)));
      EXPECT_NEAR(w.torque[a], exact.torque[a], 1e-8 * (1 + vec::norm(exact.torque)));
    }
  }
}

/// The source alone: what holds the contacts at u = 0, and where they go when nothing holds them.
TEST(Condensed, HasTheWeightInItsSource) {
  const Condensed c = condensed();
  const Wrench held = exerted({}, {});
  double weight = 0;
  for (Eigen::Index n = 2; n < c.norton.force.size(); n += 3) weight += c.norton.force[n];
  EXPECT_NEAR(weight, held.force[2], 1e-10);
  EXPECT_LT(weight, -1e-3) << "[N]";
  const Eigen::VectorXd free = c.norton.stiffness.ldlt().solve(c.norton.force);
  const statics::Solution s = statics::solve(block(), linear());
  for (std::size_t n = 0; n < c.nodes.size(); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(free[static_cast<Eigen::Index>(3 * n + axis)], s.displacement[static_cast<std::size_t>(c.nodes[n])][axis],
                  1e-10);
  }
}

TEST(Condensed, IsDroppedAtAnEdit) {
  std::array<double, 36> stiffness{};
  for (std::size_t i = 0; i < 6; ++i) stiffness[7 * i] = i < 3 ? 100 : 2;
  CondensedForce model;
  HeldForce held;
  const auto receive = [&](std::int64_t topology) {
    model.receive(report_of({{0, 0, 1}, {0.1, 0, 0}}, topology));
    held.receive(report_of({{0, 0, 1}, {0.1, 0, 0}}, topology));
  };
  Pose lower{kOrigin}, higher{kOrigin};
  lower.position[2] -= 0.005;
  higher.position[2] += 0.02;
  receive(7);
  EXPECT_EQ(model.tick(lower, 1e-3).force, held.tick(lower, 1e-3).force) << "nothing is condensed yet";
  model.linearise({stiffness, 7});
  EXPECT_NEAR(model.tick(lower, 1e-3).force[2], 1.5, 1e-12);
  EXPECT_EQ(model.tick(lower, 1e-3).torque[0], 0.1);
  EXPECT_EQ(model.tick(higher, 1e-3).force, Vec3d{}) << "a contact does not pull";
  receive(8);
  EXPECT_FALSE(model.linear());
  EXPECT_EQ(model.tick(lower, 1e-3).force, held.tick(lower, 1e-3).force);
  model.linearise({stiffness, 8});
  EXPECT_NEAR(model.tick(lower, 1e-3).force[2], 1.5, 1e-12);
  model.receive(report_of({}, 8));
  EXPECT_EQ(model.tick(lower, 1e-3).force, Vec3d{}) << "without contact there is no spring";
}

TEST(Condensed, RefusesWhatDoesNotFit) {
  const auto error = [](const std::vector<int>& contacts, double diagonal, Eigen::Index load) {
    Eigen::SparseMatrix<double> k(3, 3);
    for (int i = 0; i < 3; ++i) k.insert(i, i) = diagonal;
    return test::error_of([&] { condense(k, contacts, Eigen::VectorXd::Zero(load)); });
  };
  EXPECT_EQ(error({0, 2}, 1, 3), "");
  EXPECT_EQ(error({0, 1, 2}, 1, 3), "");
  EXPECT_NE(error({2, 0}, 1, 3).find("contacts[1] is 0"), std::string::npos);
  EXPECT_NE(error({3}, 1, 3).find("below 3"), std::string::npos);
  EXPECT_NE(error({0}, 1, 2).find("a load of 2"), std::string::npos);
  EXPECT_NE(error({0}, -1, 3).find("positive definite"), std::string::npos);
  EXPECT_NE(test::error_of([] { rigid_stiffness({}, {{0, 0, 0}}); }), "");
}

}  // namespace
}  // namespace pliant::haptics::condensed_test
