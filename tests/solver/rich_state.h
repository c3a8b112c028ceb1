// A simulation whose run state has something of everything.
#pragma once
#include <algorithm>
#include <memory>
#include <utility>

#include "cutting/cut_scenes.h"

namespace pliant {

/// A hybrid in a moment with everything in it: cuts, a blade on its way with its trace, edits that wait for a step of shape
/// matching, forces, a tool.
inline Scene rich_scene() {
  Body body = cut_test::box_body("box", {0.05, 0.03, 0.03});
  body.model.type = ModelType::hybrid;
  body.model.ratio = 0.6;
  body.model.substeps = 3;
  body.fixed.push_back({});
  body.fixed[0].where.kind = Selection::Kind::plane;
  body.fixed[0].where.a = {0.001, 0, 0};
  body.fixed[0].where.b = {-1, 0, 0};
  Scene scene = cut_test::scene_with(body);
  scene.interactive = true;
  scene.gravity = {0, -9.81, 0};
  scene.blades.push_back(cut_test::blade("scalpel", {{0, 0.02, 0.1, -1, 0.02, 0.1, 1}, {0.4, 0.02, -0.1, -1, 0.02, -0.1, 1}}));
  return scene;
}

inline std::unique_ptr<Simulation> rich_simulation(const Scene& scene) {
  auto s = std::make_unique<Simulation>(scene, open_backend("cpu"));
  while (s->topology_version() == 0 && s->step() < 5000) s->advance(64);
  const auto& forces = s->model().forces;
  const auto reserved = std::find_if(forces.begin(), forces.end(), [](const NodeForce& force) { return force.reserved; });
  const auto& slots = s->model().bodies[0].slot;
  s->set_forces({{0, std::find(slots.begin(), slots.end(), reserved->slot) - slots.begin(), {0, 1e-3, 0}}});
  s->set_focus({0.1, 0.2, 0.3});
  while (s->step() % 3 == 0) s->advance(1);
  const BladePose first{"knife", {Vec3d{0.041, 0.05, -1}, Vec3d{0.041, 0.05, 1}}};
  const BladePose second{"knife", {Vec3d{0.041, 0.02, -1}, Vec3d{0.041, 0.02, 1}}};
  s->move_blades({&first, 1});
  s->move_blades({&second, 1});
  return s;
}

}  // namespace pliant
