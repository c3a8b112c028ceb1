// Twin of kernels/links/spring_force.cl.
#include "cpu_ref/links/spring_pull.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar, int Law, bool Slack, bool Viscous>
void spring_force(Range range, const Scalar* link_u, const Scalar* link_w, const std::int32_t* spring_points,
                  const Scalar* spring_data, const Scalar* spring_curve, Scalar* link_force, const Scalar* step_params,
                  std::int32_t segments, std::int32_t force_base) {
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    const std::int32_t* points = spring_points + 2 * tile;
    const Scalar* data = spring_data + PLIANT_SPRING_PLANES * tile;
    Scalar u[3][PLIANT_TILE], w[3][PLIANT_TILE] = {}, out[3][PLIANT_TILE];
    for (int s = 0; s < PLIANT_TILE; ++s) {
      const std::int64_t a = std::int64_t{4} * points[s], b = std::int64_t{4} * points[PLIANT_TILE + s];
      for (int c = 0; c < 3; ++c) u[c][s] = link_u[b + c] - link_u[a + c];
      for (int c = 0; Viscous && c < 3; ++c) w[c][s] = link_w[b + c] - link_w[a + c];
    }
    for (int s = 0; s < PLIANT_TILE; ++s) {
      const auto number = [&](int plane) { return data[plane * PLIANT_TILE + s]; };
      const SpringNumbers<Scalar> numbers{
          {number(0), number(1), number(2)}, number(3), number(4), number(5), number(6), number(7)};
      Scalar d[3];
      const Scalar scale = spring_pull<Law, Slack, Viscous>(numbers, {u[0][s], u[1][s], u[2][s]}, {w[0][s], w[1][s], w[2][s]},
                                                            spring_curve, segments, step_params[0], d);
      for (int c = 0; c < 3; ++c) out[c][s] = scale * d[c];
    }
    for (int s = 0; s < PLIANT_TILE; ++s) {
      Scalar* texel = link_force + 4 * (force_base + tile + s);
      for (int c = 0; c < 3; ++c) texel[c] = out[c][s];
      texel[3] = 0;
    }
  }
}

void register_spring_force(Registry& registry) {
  registry.add_specialised<4, 2, 2>("spring_force", {"LAW", "SLACK", "VISCOUS"},
                                    [](auto scalar, auto law, auto slack, auto viscous) {
                                      return spring_force<decltype(scalar), law(), slack() != 0, viscous() != 0>;
                                    });
}

}  // namespace pliant::ref
