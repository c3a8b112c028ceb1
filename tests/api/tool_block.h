// A block that rigid tools touch.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pliant/world.h"

namespace pliant::test {

/// A block of 80 x 80 x 40 mm in cells of 10 mm, held at its foot, its top at z = 0; without a tool.
inline SceneSpec bare_block() {
  SceneSpec scene;
  BodySpec& body = scene.bodies.emplace_back();
  body.name = "block";
  body.surface = box_surface({-0.04, -0.04, -0.04}, {0.04, 0.04, 0});
  body.lattice_spacing = 0.01;
  body.material.young = 1e4;
  body.material.damping = 60;
  body.fixed = {{RegionSpec::box({-1, -1, -0.0401}, {1, 1, -0.0399}), "xyz"}};
  return scene;
}

inline ToolSpec ball(const std::string& name, const Vec3d& at, double radius = 0.01) {
  ToolSpec tool;
  tool.name = name;
  tool.radius = radius;
  tool.friction = 0.3;
  tool.path = {{0, at[0], at[1], at[2], 0, 0, 0, 1}};
  return tool;
}

inline SceneSpec block_with(const std::vector<ToolSpec>& tools) {
  SceneSpec scene = bare_block();
  scene.tools = tools;
  return scene;
}

inline ToolForce force_of(World& world, const std::string& name) {
  for (const ToolForce& f : world.tool_forces()) {
    if (f.name == name) return f;
  }
  ADD_FAILURE() << "no tool " << name;
  return {};
}

}  // namespace pliant::test
