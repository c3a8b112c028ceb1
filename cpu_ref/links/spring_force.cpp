// Twin of kernels/links/spring_force.cl.
#include <algorithm>
#include <cmath>

#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {
namespace {

/// Force over elongation of one spring: 0 linear, 1 cubic, 2 measured, 3 curve.
template <int Law, class Scalar>
Scalar spring_law_force(Scalar e, Scalar first, Scalar second, const Scalar* spring_curve, std::int32_t segments) {
  if constexpr (Law == 1) {
    return std::fma(first * e, e, second) * e;
  } else if constexpr (Law == 2) {
    const Scalar size = std::abs(e);
    const Scalar limit = first < Scalar(0) ? (Scalar(-0.75) * second) / first : Scalar(1e30F);
    const Scalar most = size < limit ? size : limit;
    const Scalar inverse = Scalar(1) / std::fma(first, most, second);
    const Scalar force = std::fma((second * inverse) * inverse, size - most, most * inverse);
    return e < Scalar(0) ? -force : force;
  } else if constexpr (Law == 3) {
    Scalar force = std::fma(spring_curve[2], e - spring_curve[0], spring_curve[1]);
    for (std::int32_t k = 1; k < segments; ++k) {
      const Scalar* s = spring_curve + std::ptrdiff_t{3} * k;
      const Scalar here = std::fma(s[2], e - s[0], s[1]);
      force = e >= s[0] ? here : force;
    }
    return second * force;
  } else {
    return second * e;
  }
}

}  // namespace

template <class Scalar, int Law, bool Slack, bool Viscous>
void spring_force(Range range, const Scalar* link_u, const Scalar* link_w, const std::int32_t* spring_points,
                  const Scalar* spring_data, const Scalar* spring_curve, Scalar* link_force, const Scalar* step_params,
                  std::int32_t segments, std::int32_t force_base) {
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    const std::int32_t* points = spring_points + 2 * tile;
    const Scalar* data = spring_data + PLIANT_SPRING_PLANES * tile;
    Scalar u[3][PLIANT_TILE], w[3][PLIANT_TILE], out[3][PLIANT_TILE];
    for (int s = 0; s < PLIANT_TILE; ++s) {
      const std::int64_t a = std::int64_t{4} * points[s], b = std::int64_t{4} * points[PLIANT_TILE + s];
      for (int c = 0; c < 3; ++c) u[c][s] = link_u[b + c] - link_u[a + c];
      for (int c = 0; Viscous && c < 3; ++c) w[c][s] = link_w[b + c] - link_w[a + c];
    }
    for (int s = 0; s < PLIANT_TILE; ++s) {
      const auto number = [&](int plane) { return data[plane * PLIANT_TILE + s]; };
      const Scalar x = number(0), y = number(1), z = number(2);
      const Scalar dx = x + u[0][s], dy = y + u[1][s], dz = z + u[2][s];
      const Scalar length = std::sqrt(std::fma(dz, dz, std::fma(dy, dy, dx * dx)));
      const Scalar squares = std::fma(u[2][s], z + dz, std::fma(u[1][s], y + dy, u[0][s] * (x + dx))) + number(4);
      const Scalar both = length + number(3);
      // Divided first and chosen then, which a compiler can do for several springs at once.
      const Scalar ratio = squares / both, reciprocal = Scalar(1) / length;
      const Scalar e = both > Scalar(0) ? ratio : Scalar(0);
      const Scalar inverse = length > Scalar(0) ? reciprocal : Scalar(0);
      Scalar force = spring_law_force<Law>(e, number(5), number(6), spring_curve, segments);
      if constexpr (Viscous) {
        const Scalar rate = (std::fma(w[2][s], dz, std::fma(w[1][s], dy, w[0][s] * dx)) * inverse) / step_params[0];
        force = std::fma(number(7), rate, force);
      }
      if constexpr (Slack) force = e > Scalar(0) && force > Scalar(0) ? force : Scalar(0);
      const Scalar scale = force * inverse;
      out[0][s] = scale * dx;
      out[1][s] = scale * dy;
      out[2][s] = scale * dz;
    }
    std::copy(&out[0][0], &out[0][0] + std::ptrdiff_t{3} * PLIANT_TILE, link_force + force_base + 3 * tile);
  }
}

void register_spring_force(Registry& registry) {
  registry.add_specialised<4, 2, 2>("spring_force", {"LAW", "SLACK", "VISCOUS"},
                                    [](auto scalar, auto law, auto slack, auto viscous) {
                                      return spring_force<decltype(scalar), law(), slack() != 0, viscous() != 0>;
                                    });
}

}  // namespace pliant::ref
