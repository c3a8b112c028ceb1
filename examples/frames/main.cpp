// A renderer's loop: the worker steps while the program draws, and only the vertices that moved are sent on.
#include <pliant/pliant.h>

#include <cstdio>
#include <cstring>
#include <vector>

int main() try {
  pliant::SceneSpec scene;
  scene.gravity = {0, -9.81, 0};
  pliant::BodySpec block;
  block.surface = pliant::box_surface({0, 0, 0}, {0.1, 0.08, 0.06});
  block.lattice_spacing = 0.01;
  block.material.young = 3000;
  block.material.damping = 5;
  block.fixed.push_back({pliant::RegionSpec::plane({0, 0.079, 0}, {0, 1, 0})});
  scene.bodies.push_back(block);
  pliant::World world(scene);

  std::vector<pliant::Vec4f> vertex_buffer;  // stands for one on a graphics card
  std::size_t sent = 0, drawn = 0, same = 0;
  for (int i = 0; i < 120; ++i) {
    world.advance_async(1.0 / 60);  // returns at once; false where the worker has not finished what it was asked before
    const pliant::FramePtr frame = world.frame();  // the newest that is finished; never waits for the worker
    const pliant::IndexRange dirty = frame->dirty_vertices;
    vertex_buffer.resize(frame->positions.size());
    if (dirty.count > 0)
      std::memcpy(&vertex_buffer[dirty.first], &frame->positions[dirty.first], dirty.count * sizeof(pliant::Vec4f));
    sent += dirty.count;
    ++(dirty.count > 0 ? drawn : same);
    world.wait();  // a renderer would wait for the screen instead
  }
  float lowest = 1;
  for (const pliant::Vec4f& x : vertex_buffer) lowest = x[1] < lowest ? x[1] : lowest;
  std::printf("%zu frames with news, %zu without, %zu vertices sent; it hangs down to y = %.4f m\n", drawn, same, sent,
              static_cast<double>(lowest));
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "frames: %s\n", error.what());
  return static_cast<int>(error.code());
}
