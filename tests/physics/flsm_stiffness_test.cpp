// "stiffness": {"young": E} of shape matching: bars pulled by a force stretch by F L / (E A), whatever the step.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/flsm_harness.h"
#include "pliant/error.h"
#include "support/error_of.h"

namespace pliant::physics {
namespace {

constexpr double kSpacing = 0.01, kDensity = 1000, kYoung = 500;

struct Bar {
  int width = 1;
  double dt = 1e-3, damping = 20;  // [s], [1/s]
  int across = 3;
  Box box() const { return {{12 * width + 24, across, across}, kSpacing}; }
};

Scene bar_scene(const Bar& bar, double young, ModelType type = ModelType::flsm, int substeps = 1) {
  const Vec3d size = bar.box().size();
  Body body = matched_box(bar.box(), type, size[0] / 3);
  body.material.density = kDensity;
  body.material.damping = bar.damping;
  body.model.width = bar.width;
  body.model.young = young;
  body.model.substeps = substeps;
  Scene scene;
  scene.dt = bar.dt;
  scene.bodies = {body};
  return scene;
}

/// Mean displacement along x of the nodes of the section that lies `cells` from the clamp [m].
double section(const Simulation& sim, int cells) {
  const auto u = sim.displacements(0);
  const auto& rest = sim.model().bodies[0].rest;
  double sum = 0;
  int count = 0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (std::lround(rest[n][0] / kSpacing) != cells) continue;
    sum += u[n][0];
    ++count;
  }
  EXPECT_GT(count, 0);
  return sum / count;
}

constexpr double kEnds[] = {0, 0.30, 1.89, 5.30};  ///< by half-width

/// Pull to 0.2 %, which is nearly linear, and wait: the strain of the middle third, and that of the whole bar with its soft
/// ends, times E A / F.
std::array<double, 2> compliance(const Bar& bar) {
  const Vec3d size = bar.box().size();
  const double area = size[1] * size[2], force = 0.002 * kYoung * area;
  // Critical damping of the slowest wave.
  const double omega = M_PI / 2 / size[0] * std::sqrt(kYoung / kDensity);
  Bar damped = bar;
  damped.damping = 2 * omega;
  Scene scene = bar_scene(damped, kYoung);
  scene.bodies[0].fixed = {{face(0, 0), {true, true, true}}};
  // In equal shares, which is what the correction of the ends is for.
  const ModelBody placed = build_model(scene).bodies[0];
  std::vector<std::int64_t> ends;
  for (std::size_t n = 0; n < placed.rest.size(); ++n) {
    if (placed.rest[n][0] > size[0] - 1e-6) ends.push_back(static_cast<std::int64_t>(n));
  }
  for (const std::int64_t n : ends) {
    Force share;
    share.where.kind = Selection::Kind::nodes;
    share.where.nodes = {n};
    share.force = {force / static_cast<double>(ends.size()), 0, 0};
    scene.bodies[0].forces.push_back(share);
  }
  auto sim = simulate(scene, "cpu");
  const int along = bar.box().cells[0], third = along / 3;
  const auto settle_to = [&](double end) {
    while (sim->time() < end && !sim->divergence()) sim->advance(64);
    return section(*sim, along);
  };
  const double before = settle_to(22 / omega), after = settle_to(24 / omega);
  EXPECT_FALSE(sim->divergence().has_value());
  EXPECT_NEAR(before, after, 1e-4 * after) << "not at rest yet";
  const double strain = (section(*sim, 2 * third) - section(*sim, third)) / (third * kSpacing);
  return {strain * kYoung * area / force, after / size[0] * kYoung * area / force};
}

// docs/flsm_stiffness.md: E holds in the middle third; a clamp and a load on one layer of nodes each make the bar softer, as if
// it were longer by so many cells.
TEST(FlsmStiffness, BarsStretchByForceOverStiffness) {
  for (int width = 1; width <= 3; ++width) {
    for (const double dt : {1.0 / 120, 1.0 / 400}) {
      const Bar bar{width, dt};
      const auto [middle, whole] = compliance(bar);
      const std::string name = "w = " + std::to_string(width) + ", dt = " + std::to_string(dt) + ": ";
      check_relative(name + "strain E A / F of the middle third", middle, 1, 0.005);
      check_relative(name + "of the whole bar", whole, 1 + kEnds[width] / bar.box().cells[0], 0.005);
    }
  }
}

std::string refused(const Scene& scene) {
  return test::error_of([&] { Simulation(scene, open_backend("cpu")); });
}

/// The largest alpha that a scene stands: regions are up to `stiffest` times as stiff as the springs to their goals.
double largest_alpha(const Scene& scene) { return std::min(1.0, 3.8 / build_model(scene).flsm.at(0).stiffest); }

/// The number after `words` in a message.
double number_after(const std::string& message, const std::string& words) {
  const std::size_t at = message.find(words);
  EXPECT_NE(at, std::string::npos) << message;
  return at == std::string::npos ? 0 : std::stod(message.substr(at + words.size()));
}

TEST(FlsmStiffness, RefusesWhatNoAlphaReaches) {
  // b = dt^2 / (1 + damping dt / 2) = 1e-4 / 1.1, so at most 2 rho d^2 alpha / b = 2200 Pa alpha.
  const Bar bar{2, 0.01, 20};
  const std::string message = refused(bar_scene(bar, 1e4));
  const double most = 2200 * largest_alpha(bar_scene(bar, 1e4));
  EXPECT_LT(most, 2200);
  EXPECT_NE(message.find("/bodies/0/model/stiffness/young: got 10000 Pa"), std::string::npos) << message;
  check_relative("most Pa", number_after(message, "allowed is at most "), most, 1e-5);
  const double dt = number_after(message, "or dt up to "), b = dt * dt / (1 + 10 * dt);
  check_relative("E b", 1e4 * b, most * 1e-4 / 1.1, 1e-5);
  EXPECT_EQ(refused(bar_scene(bar, 0.9999 * most)), "");
  EXPECT_EQ(refused(bar_scene({2, 0.9999 * dt, 20}, 1e4)), "");
  EXPECT_EQ(refused(bar_scene(bar, 1e-3)), "");
}

TEST(FlsmStiffness, SubstepsCountInWhatIsAllowed) {
  const Scene scene = bar_scene({2, 1e-3, 20}, 1e4, ModelType::hybrid, 10);
  const std::string message = refused(scene);
  const double most = 2200 * largest_alpha(scene);
  check_relative("most Pa", number_after(message, "and 10 substeps; allowed is at most "), most, 1e-5);
  EXPECT_EQ(refused(bar_scene({2, 1e-3, 20}, 0.9999 * most, ModelType::hybrid, 10)), "");
}

/// Without finite elements the automatic step is 1/60 s, or the longest that reaches E: b = 2 rho d^2 alpha / E = 2e-5 s^2
/// alpha.
TEST(FlsmStiffness, AutomaticStepReachesTheStiffness) {
  EXPECT_EQ(Simulation(bar_scene({2, 0, 20}, 300), open_backend("cpu")).dt(), 1.0 / 60);
  const Scene scene = bar_scene({2, 0, 20}, 1e4);
  const Simulation stiff(scene, open_backend("cpu"));
  EXPECT_NEAR(stiff.dt() * stiff.dt() / (1 + 10 * stiff.dt()), 2e-5 * largest_alpha(scene), 1e-12);
}

/// The automatic step of a hybrid counts the stiffness that the interface gets from "young".
TEST(FlsmStiffness, AutomaticStepOfAHybridHolds) {
  for (const int substeps : {1, 4}) {
    Scene scene = bar_scene({2, 0, 0.5}, 800, ModelType::hybrid, substeps);
    scene.bodies[0].angular_velocity = {3, 2, 1};
    auto sim = simulate(scene, "cpu");
    const double first = sim->dt();
    EXPECT_GT(first, 0);
    const double h = substeps * first;
    EXPECT_LE(h * h / (1 + 0.25 * h), 2 * kDensity * kSpacing * kSpacing / 800 * (1 + 1e-12));
    sim->advance(1500);
    EXPECT_FALSE(sim->divergence().has_value());
    EXPECT_GT(sim->dt(), 0.8 * first);
  }
}

}  // namespace
}  // namespace pliant::physics
