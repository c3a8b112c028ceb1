// The render loop of a program that embeds Pliant: the worker steps while a frame is drawn.
#include <pliant/version.h>
#include <pliant/world.h>

#include <chrono>
#include <cstdio>
#include <thread>

int main() try {
  pliant::SceneSpec scene;
  scene.gravity = {0, -9.81, 0};
  pliant::BodySpec block;
  block.surface = pliant::box_surface({0, 0, 0}, {0.1, 0.08, 0.06});
  block.lattice_spacing = 0.02;
  block.fixed.push_back({pliant::RegionSpec::plane({0, 0.001, 0}, {0, -1, 0})});
  scene.bodies.push_back(block);
  pliant::World world(scene);

  int drawn = 0, fresh = 0;
  while (drawn < 30) {
    world.step_async(20);  // does nothing while the worker is busy
    if (world.poll()) ++fresh;
    const pliant::FramePtr frame = world.frame();  // upload frame->positions, trace, draw ...
    drawn += frame->positions.empty() ? 0 : 1;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  world.wait();
  std::printf("C++: pliant %s, %d frames drawn, %s\n", pliant::version(), drawn, fresh > 0 ? "some of them new" : "none new");
  try {
    world.step(-1);
  } catch (const pliant::Error& error) {  // the type must be the same on both sides of a shared library
    return error.code() == pliant::ErrorCode::usage && fresh > 0 ? 0 : 1;
  }
  return 1;
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "consumer: %s\n", error.what());
  return 1;
}
