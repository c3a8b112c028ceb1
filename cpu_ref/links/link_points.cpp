// Twin of kernels/links/link_points.cl.
#include <cmath>

#include "cpu_ref/registry.h"
#include "layout.h"

namespace pliant::ref {

template <class Scalar, bool Viscous>
void link_points(Range range, const Scalar* node_u, const Scalar* node_w, const std::int32_t* point_offset,
                 const std::int32_t* point_slot, const Scalar* point_weight, Scalar* link_u, Scalar* link_w) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int64_t first = point_offset[i / PLIANT_TILE], last = point_offset[i / PLIANT_TILE + 1];
    Scalar u[4] = {0, 0, 0, 0}, w[4] = {0, 0, 0, 0};
    for (std::int64_t k = first; k < last; ++k) {
      const std::int64_t at = k * PLIANT_TILE + i % PLIANT_TILE, node = std::int64_t{4} * point_slot[at];
      for (int c = 0; c < 3; ++c) u[c] = std::fma(point_weight[at], node_u[node + c], u[c]);
      for (int c = 0; Viscous && c < 3; ++c) w[c] = std::fma(point_weight[at], node_w[node + c], w[c]);
    }
    for (int c = 0; c < 4; ++c) link_u[4 * i + c] = u[c];
    for (int c = 0; Viscous && c < 4; ++c) link_w[4 * i + c] = w[c];
  }
}

void register_link_points(Registry& registry) {
  registry.add_specialised<2>("link_points", {"VISCOUS"},
                              [](auto scalar, auto viscous) { return link_points<decltype(scalar), viscous() != 0>; });
}

}  // namespace pliant::ref
