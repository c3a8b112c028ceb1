// A soft block under gravity, pulled at one corner: the smallest program with Pliant.
#include <pliant/world.h>

#include <cstdio>

int main() try {
  pliant::SceneSpec scene;
  scene.gravity = {0, -9.81, 0};
  pliant::BodySpec block;
  block.surface = pliant::box_surface({0, 0, 0}, {0.1, 0.08, 0.06});  // or surface_file = "liver.obj"
  block.lattice_spacing = 0.01;
  block.material.young = 3000;
  block.material.damping = 5;
  block.fixed.push_back({pliant::RegionSpec::plane({0, 0.001, 0}, {0, -1, 0})});
  scene.bodies.push_back(block);

  pliant::WorldOptions options;
  options.interactive = true;
  pliant::World world(scene, options);
  std::printf("%lld nodes on %s\n", static_cast<long long>(world.info().nodes), world.info().reason.c_str());

  const pliant::GrabId hand = world.grab(7);
  world.move_grab(hand, {0.12, 0.08, 0.06});
  for (int i = 0; i < 5; ++i) {
    world.advance(0.1);
    const pliant::FramePtr frame = world.frame();
    std::printf("t = %.3f s: the corner is at x = %.4f m\n", frame->time, static_cast<double>(frame->positions[7][0]));
  }
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "hello: %s\n", error.what());
  return static_cast<int>(error.code());
}
