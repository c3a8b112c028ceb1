// A hand presses a soft block and feels it a thousand times a second: haptics [SECONDS [DEVICE]], for example haptics 60
// udp:5000.
#include <pliant/pliant.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

int main(int argc, char** argv) try {
  pliant::SceneSpec scene;
  pliant::BodySpec block;
  block.surface = pliant::box_surface({0, 0, 0}, {0.1, 0.05, 0.1});
  block.lattice_spacing = 0.0125;
  block.material.young = 10000;
  block.material.damping = 40;
  block.fixed.push_back({pliant::RegionSpec::plane({0, 0.001, 0}, {0, -1, 0})});
  scene.bodies.push_back(block);
  pliant::ToolSpec ball;
  ball.name = "probe";
  ball.radius = 0.012;
  ball.path = {{0, 0.05, 0.064, 0.05, 0, 0, 0, 1}};  // it waits 2 mm above the block
  scene.tools.push_back(ball);
  pliant::World world(scene);

  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  const auto manual = std::make_shared<pliant::ManualDevice>();  // moved below; a device in a hand moves by itself
  pliant::HapticLoop loop(world, "probe", argc > 2 ? pliant::open_haptic_device(argv[2]) : manual);
  world.run_live();
  for (int i = 0; i < 100 * seconds; ++i) {
    manual->set_pose({0, -0.006 * (1 - std::cos(0.01 * i * 3.14159)), 0});  // 12 mm down and up again, in two seconds
    world.frame();                                                          // a viewer draws it
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (i % 10 != 9) continue;
    const pliant::HapticSample now = loop.state().last;
    std::printf("t = %.2f s: at y = %.4f m the hand feels %.3f N\n", now.time, now.position[1], now.force[1]);
  }
  const pliant::HapticState state = loop.state();
  std::printf("%lld ticks, a tick takes %.3f ms\n", static_cast<long long>(state.ticks), 1000 * state.work_mean);
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "haptics: %s\n", error.what());
  return static_cast<int>(error.code());
}
