// A block that hangs under its weight is cut by a blade that the program moves, and comes apart.
#include <pliant/pliant.h>

#include <cstdio>

int main() try {
  pliant::SceneSpec scene;
  scene.gravity = {0, -9.81, 0};
  pliant::BodySpec block;
  block.surface = pliant::box_surface({0, 0, 0}, {0.04, 0.12, 0.04});
  block.lattice_spacing = 0.008;
  block.material.young = 8000;
  block.material.damping = 5;
  block.fixed.push_back({pliant::RegionSpec::plane({0, 0.119, 0}, {0, 1, 0})});
  scene.bodies.push_back(block);

  pliant::WorldOptions options;
  options.cutting = true;  // prepare now, so that the first cut takes no longer than the others
  pliant::World world(scene, options);
  std::printf("%lld pieces, %zu triangles\n", static_cast<long long>(world.pieces(0)), world.frame()->triangles.size());

  // The blade is a segment [m]; it cuts what it sweeps between two calls. The first call only puts it in front of the block.
  for (int i = 0; i <= 30; ++i) {
    const double x = -0.01 + 0.002 * i;
    const pliant::CutResult cut = world.move_blade("scalpel", {x, 0.06, -0.01}, {x, 0.06, 0.05});
    if (cut.changed) std::printf("x = %.3f m: %lld edges cut\n", x, static_cast<long long>(cut.edges));
    world.advance(1.0 / 60);
  }
  world.lift_blade("scalpel");
  world.advance(0.2);

  const pliant::FramePtr now = world.frame();
  std::size_t on_the_cut = 0;
  for (const std::uint8_t kind : now->cut_faces) on_the_cut += kind;
  std::printf("%lld pieces, %zu triangles, %zu of them on the cut\n", static_cast<long long>(world.pieces(0)),
              now->triangles.size(), on_the_cut);
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "cut: %s\n", error.what());
  return static_cast<int>(error.code());
}
