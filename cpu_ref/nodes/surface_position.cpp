// Twin of kernels/nodes/surface_position.cl.
#include <cmath>

#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar, int Width>
void surface_position(Range range, const Scalar* node_u, const Scalar* surface_rest, const std::int32_t* surface_node,
                      const Scalar* surface_weight, Scalar* surface_x) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar u[3] = {0, 0, 0};
    for (int a = 0; a < Width; ++a) {
      const std::int64_t entry = tile_base(i, Width) + a * PLIANT_TILE;
      const Scalar* texel = node_u + std::int64_t{4} * surface_node[entry];
      for (int c = 0; c < 3; ++c) u[c] = std::fma(surface_weight[entry], texel[c], u[c]);
    }
    for (int c = 0; c < 3; ++c) surface_x[4 * i + c] = surface_rest[4 * i + c] + u[c];
    surface_x[4 * i + 3] = surface_rest[4 * i + 3];
  }
}

void register_surface_position(Registry& registry) {
  registry.add_specialised<9>("surface_position", {"WIDTH"},
                              [](auto scalar, auto width) { return surface_position<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
