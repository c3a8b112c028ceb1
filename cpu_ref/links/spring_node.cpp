// Twin of kernels/links/spring_node.cl.
#include <cmath>

#include "cpu_ref/links/node_sum.h"
#include "cpu_ref/links/spring_pull.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

/// Differences of what the other ends and the nodes of a tile have, x y z in planes.
template <class Scalar>
void differences(const Scalar* of, const std::int32_t* end, const Scalar (&own)[3][PLIANT_TILE],
                 Scalar (&out)[3][PLIANT_TILE]) {
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized in part
    for (int c = 0; c < 3; ++c) out[c][l] = of[std::int64_t{4} * end[l] + c] - own[c][l];
  }
}

template <class Scalar, int Law, bool Slack, bool Viscous>
void spring_node(Range range, Scalar* node_load, const Scalar* node_u, const Scalar* node_w, const std::int32_t* spring_node,
                 const std::int32_t* spring_offset, const std::int32_t* spring_end, const Scalar* spring_data,
                 const Scalar* spring_curve, const Scalar* step_params, std::int32_t segments, std::int32_t planes) {
  constexpr bool has_first = Law == 1 || Law == 2;
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    const NodeSum<Scalar> nodes(spring_node, tile);
    Scalar f[3][PLIANT_TILE], u[3][PLIANT_TILE], w[3][PLIANT_TILE] = {}, du[3][PLIANT_TILE], dw[3][PLIANT_TILE] = {};
    nodes.begin(node_load, f);
    for (int l = 0; l < PLIANT_TILE; ++l) {
      for (int c = 0; c < 3; ++c) u[c][l] = node_u[4 * nodes.slot(l) + c];
      for (int c = 0; Viscous && c < 3; ++c) w[c][l] = node_w[4 * nodes.slot(l) + c];
    }
    const std::int64_t last = spring_offset[tile / PLIANT_TILE + 1];
    for (std::int64_t k = spring_offset[tile / PLIANT_TILE]; k < last; ++k) {
      const std::int32_t* end = spring_end + k * PLIANT_TILE;
      const Scalar* data = spring_data + k * (planes * PLIANT_TILE);
      differences(node_u, end, u, du);
      if constexpr (Viscous) differences(node_w, end, w, dw);
      for (int l = 0; l < PLIANT_TILE; ++l) {
        const auto number = [&](int plane) { return data[plane * PLIANT_TILE + l]; };
        const SpringNumbers<Scalar> numbers{
            {number(0), number(1), number(2)}, number(3), number(4),
            has_first ? number(6) : Scalar(0), number(5), Viscous ? number(planes - 1) : Scalar(0)};
        Scalar d[3];
        const Scalar scale = spring_pull<Law, Slack, Viscous>(
            numbers, {du[0][l], du[1][l], du[2][l]}, {dw[0][l], dw[1][l], dw[2][l]}, spring_curve, segments, step_params[0], d);
        for (int c = 0; c < 3; ++c) f[c][l] = std::fma(scale, d[c], f[c][l]);
      }
    }
    nodes.store(f, node_load);
  }
}

void register_spring_node(Registry& registry) {
  registry.add_specialised<4, 2, 2>("spring_node", {"LAW", "SLACK", "VISCOUS"},
                                    [](auto scalar, auto law, auto slack, auto viscous) {
                                      return spring_node<decltype(scalar), law(), slack() != 0, viscous() != 0>;
                                    });
}

}  // namespace pliant::ref
