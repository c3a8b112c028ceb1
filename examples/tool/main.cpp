// A ball is driven into a block, as a probe in somebody's hand would be, and the force on it is read in every frame.
#include <pliant/pliant.h>

#include <cstdio>

int main() try {
  pliant::SceneSpec scene;
  pliant::BodySpec block;
  block.surface = pliant::box_surface({0, 0, 0}, {0.1, 0.05, 0.1});
  block.lattice_spacing = 0.008;
  block.material.young = 10000;
  block.material.damping = 40;
  block.fixed.push_back({pliant::RegionSpec::plane({0, 0.001, 0}, {0, -1, 0})});
  scene.bodies.push_back(block);

  pliant::ToolSpec ball;
  ball.name = "probe";
  ball.radius = 0.012;  // of a sphere about the tool's origin [m]
  ball.friction = 0.2;
  ball.path = {{0, 0.05, 0.07, 0.05, 0, 0, 0, 1}};  // time [s], origin [m], unit quaternion: it waits above the block
  scene.tools.push_back(ball);

  pliant::World world(scene);
  const double period = 1.0 / 60;
  for (int frame = 0; frame < 60; ++frame) {
    // Down by 14 mm in half a second, then still. The tool reaches the place when the next frame is due.
    const double depth = frame < 30 ? 0.014 * frame / 30 : 0.014;
    world.drive_tool("probe", {0.05, 0.067 - depth, 0.05}, {0, 0, 0, 1}, period);
    world.advance(period);
    const pliant::ToolForce felt = world.tool_forces().front();
    if (frame % 10 == 9) {
      std::printf("t = %.2f s: at y = %.4f m the probe feels %.3f N, %.0f mm^2 touch it\n", world.time(), felt.position[1],
                  felt.force[1], 1e6 * felt.area);
    }
  }
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "tool: %s\n", error.what());
  return static_cast<int>(error.code());
}
