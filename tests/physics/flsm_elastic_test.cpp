// Bodies whose shape matching has the stiffness of their material, under their weight: they sag like finite elements, at any
// step.
#include <gtest/gtest.h>

#include <numeric>

#include "physics/flsm_harness.h"

namespace pliant::physics {
namespace {

const Box kCube{{6, 6, 6}, 0.02};

/// Fixed at the faces whose `axis` is at 0; `gravity` [m/s^2].
struct Load {
  const char* name;
  std::size_t axis;
  Vec3d gravity;
};

constexpr Load kLoads[] = {{"standing, 2 m/s2", 0, {-2, 0, 0}},
                           {"standing, 4 m/s2", 0, {-4, 0, 0}},
                           {"hanging, 9.81 m/s2", 0, {9.81, 0, 0}},
                           {"from the side", 0, {0, -2, 0}}};

Scene loaded(const Load& load, ModelType type, int width = 2) {
  Body body = matched_box(kCube, type, 0.06);
  body.material = material_young(Law::neo_hookean, 3000, 0.3);
  body.material.density = 1000;
  body.material.damping = 25;
  body.model.width = width;
  body.model.young = type == ModelType::tled ? 0 : 3000;
  if (type == ModelType::hybrid) {  // the lower half of the load hangs on shape matching
    body.model.region->a = {0.059, -1, -1};
    body.model.region->b = {1, 1, 1};
  }
  body.fixed = {{face(static_cast<int>(load.axis), 0), {true, true, true}}};
  Scene scene;
  scene.gravity = load.gravity;
  scene.bodies = {body};
  return scene;
}

/// The mean displacement at rest of the face opposite to the one that is held, along the load [m].
double sag(const Scene& scene, const char* backend = "cpu") {
  auto sim = simulate(scene, backend);
  const auto now = [&] {
    const auto u = sim->displacements(0);
    const auto& rest = sim->model().bodies[0].rest;
    const double g = vec::norm(scene.gravity);
    double sum = 0;
    int count = 0;
    for (std::size_t n = 0; n < u.size(); ++n) {
      if (rest[n][0] < kCube.size()[0] - 1e-6) continue;
      sum += vec::dot(u[n], scene.gravity) / g;
      ++count;
    }
    return sum / count;
  };
  if (scene.relaxation.enabled) {
    settle(*sim);
    std::printf("  %-58s %lld steps\n", "", static_cast<long long>(sim->step()));
    return now();
  }
  double before = 0;
  while (sim->time() < 3 && !sim->divergence()) {
    if (sim->time() < 2.7) before = now();
    sim->advance(64);
  }
  EXPECT_FALSE(sim->divergence().has_value());
  EXPECT_NEAR(now(), before, 2e-3 * std::abs(before)) << "not at rest yet";
  return now();
}

TEST(FlsmElastic, SagsLikeFiniteElements) {
  for (const Load& load : kLoads) {
    const double reference = sag(loaded(load, ModelType::tled));
    for (const int width : {1, 2}) {
      const std::string name = std::string(load.name) + ", w = " + std::to_string(width);
      // Three cells between clamp and interface are few for windows of five.
      check_relative(name + ": hybrid", sag(loaded(load, ModelType::hybrid, width)), reference, width == 1 ? 0.1 : 0.35);
      check_relative(name + ": shape matching", sag(loaded(load, ModelType::flsm, width)), reference, 0.1);
    }
  }
}

/// The stiffness follows the step: what is at rest does not know how it came there. Held goals pull once in n substeps, n
/// times as hard, about a mean that is 1 % off.
TEST(FlsmElastic, StepsAndSubstepsLeadToTheSameRest) {
  Scene scene = loaded(kLoads[0], ModelType::hybrid);
  const double reference = sag(scene), dt = simulate(scene, "cpu")->dt();
  for (const bool extrapolate : {false, true}) {
    for (const int substeps : {1, 4}) {
      DeformationModel& m = scene.bodies[0].model;
      m.extrapolate = extrapolate;
      m.substeps = substeps;
      for (const double step : {0.0, 0.25 * dt}) {
        scene.dt = step;
        check_relative(std::string(extrapolate ? "extrapolated" : "held") + ", " + std::to_string(substeps) + " substeps, dt " +
                           (step > 0 ? "a quarter" : "automatic"),
                       sag(scene), reference, extrapolate || substeps == 1 ? 1e-4 : 0.01);
      }
    }
  }
}

TEST(FlsmElastic, RelaxationFindsWhatDampingFinds) {
  for (const ModelType type : {ModelType::hybrid, ModelType::flsm}) {
    for (const auto& [substeps, extrapolate] : {std::pair{1, false}, {4, true}, {4, false}}) {
      if (type == ModelType::flsm && extrapolate) continue;
      Scene damped = loaded(kLoads[0], type, 1);
      damped.bodies[0].model.substeps = substeps;
      damped.bodies[0].model.extrapolate = extrapolate;
      Scene relaxed = damped;
      relaxed.relaxation = {true, 1e-5, 4000};  // held goals keep a rhythm of `substeps`, which is no noise
      relaxed.bodies[0].material.damping = 0;
      const double reference = sag(damped, "cpu:double");
      for (const char* backend : {"cpu", "cpu:double"}) {
        check_relative(std::string(to_string(type)) + ", " + std::to_string(substeps) +
                           (extrapolate ? " extrapolated substeps, " : " substeps, ") + backend,
                       sag(relaxed, backend), reference, 1e-3);
      }
    }
  }
}

/// In all they stand for all of the material: the energy of a uniform strain is that of the material, clamps or not.
TEST(FlsmElastic, SharesSumUpToTheMaterial) {
  for (const ModelType type : {ModelType::flsm, ModelType::hybrid}) {
    for (const int width : {1, 2}) {
      const Model model = build_model(loaded(kLoads[0], type, width));
      const FlsmBatch& b = model.flsm.at(0);
      double share = 0;
      for (const RegionElasticity& e : b.elastic) share += e.share;
      const double cells = type == ModelType::flsm ? 216 : 108, material = 1000 * std::pow(kCube.edge, 3) * cells;
      check_relative("sum of shares, w = " + std::to_string(width), share, width * (width + 1) / 3.0 * material, 1e-6);
      EXPECT_GE(b.stiffest, b.stiffest_interface);
      EXPECT_GT(b.stiffest, 1);
      EXPECT_LT(b.stiffest, 6);
    }
  }
}

/// A region of one plane of nodes does not see a strain across it.
TEST(FlsmElastic, ThinBodiesStayRigidRegions) {
  Scene scene = loaded(kLoads[0], ModelType::flsm, 3);
  Body thin = matched_box({{12, 12, 1}, 0.02}, ModelType::flsm);
  thin.model.width = 3;
  thin.model.young = 3000;
  scene.bodies = {thin};
  const Model model = build_model(scene);
  for (const RegionElasticity& e : model.flsm.at(0).elastic) EXPECT_EQ(e.share, 0);
  EXPECT_EQ(model.flsm[0].stiffest, 1);
}

/// Without damping the energy stays: the pull is the gradient of a potential, and the step is one that the body stands.
TEST(FlsmElastic, StandsItsLongestStep) {
  for (const int width : {1, 2, 3}) {
    Scene scene = loaded(kLoads[0], ModelType::flsm, width);
    scene.bodies[0].material.damping = 0;
    scene.bodies[0].model.young = 2e5;  // so that the step is the longest that it allows
    auto sim = simulate(scene, "cpu:double");
    double first = 0, last = 0;
    for (int i = 0; i < 4000; ++i) {
      sim->advance(1);
      double& most = i < 1000 ? first : last;
      if (i < 1000 || i >= 3000) most = std::max(most, largest(read_texels(*sim, "node_u")));
    }
    EXPECT_FALSE(sim->divergence().has_value());
    check_relative("w = " + std::to_string(width) + ": largest displacement, late and early", last, first, 0.2);
  }
}

}  // namespace
}  // namespace pliant::physics
