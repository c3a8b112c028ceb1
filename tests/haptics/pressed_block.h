// A soft block with a ball above it, as a Simulation on the twins.
#pragma once
#include <memory>

#include "backends/choice/backends.h"
#include "simulation/simulation.h"

namespace pliant::haptics_test {

inline constexpr double kTop = 0.06, kBall = 0.012;

inline TriangleMesh box(const Vec3d& low, const Vec3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        {(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1], (i & 4) != 0 ? high[2] : low[2]});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// 0.1 x 0.06 x 0.1 m of cells of 1 cm, held at its lower face; the ball begins `gap` [m] above its top, at (0.05, 0.05).
inline Scene block_scene(ElementKind element = ElementKind::hex8, double gap = 0.001) {
  Scene scene;
  Body body;
  body.name = "block";
  body.surface = "block";
  body.surface_in_memory = std::make_shared<const TriangleMesh>(box({0, 0, 0}, {0.1, kTop, 0.1}));
  body.lattice.spacing = 0.01;
  body.element = element;
  body.material.moduli = Moduli::from_young(5000, 0.4);
  body.material.law = Law::neo_hookean;
  body.material.parameters = {body.material.moduli.mu, body.material.moduli.lambda};
  body.material.density = 1000;
  body.material.damping = 20;
  Selection floor;
  floor.kind = Selection::Kind::box;
  floor.a = {-1, -1, -1};
  floor.b = {1, 1e-4, 1};
  body.fixed = {{floor}};
  scene.bodies = {body};
  ContactTool ball;
  ball.name = "ball";
  ball.radius = kBall;
  ball.friction = 0.2;
  ball.path = {{0, 0.05, kTop + kBall + gap, 0.05, 0, 0, 0, 1}};
  scene.tools = {ball};
  return scene;
}

inline std::unique_ptr<Simulation> simulate(const Scene& scene, double dt = 0) {
  SimulationOptions options;
  options.dt = dt;
  return std::make_unique<Simulation>(scene, open_backend("cpu"), options);
}

/// A press by `depth` [m] in `seconds` [s], then sideways.
inline Pose pressed(double t, double depth = 0.008, double seconds = 0.2) {
  const double s = std::min(1.0, t / seconds), share = s * s * (3 - 2 * s);
  return {{0.05 + 0.02 * std::max(0.0, t - seconds), kTop + kBall + 0.001 - (depth + 0.001) * share, 0.05}, {0, 0, 0, 1}};
}

}  // namespace pliant::haptics_test
