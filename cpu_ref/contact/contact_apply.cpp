// Twin of kernels/contact/contact_apply.cl.
#include <cmath>

#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"
#include "layout.h"

namespace pliant::ref {

namespace {

/// Returns true if a point at the tile of nodes is marked as touching in contact_force.
bool touched(std::int64_t tile, const std::int32_t* offset, const std::int32_t* tiles, const std::int32_t* near,
             const std::int32_t* force) {
  for (std::int32_t t = offset[tile]; t < offset[tile + 1]; ++t) {
    if (near[tiles[t]] == 0) continue;
    const std::int32_t* marks = force + std::int64_t{4 * PLIANT_TILE} * tiles[t] + 3 * PLIANT_TILE;
    std::int32_t any = 0;
    for (int l = 0; l < PLIANT_TILE; ++l) any |= marks[l];
    if (any != 0) return true;
  }
  return false;
}

}  // namespace

template <class Scalar, int MOMENT, int EDGES>
void contact_apply(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* contact_slot,
                   const std::int32_t* contact_free, const std::int32_t* contact_node_list,
                   const std::int32_t* contact_tiles_offset, const std::int32_t* contact_tiles,
                   const std::int32_t* contact_gather_offset, const std::int32_t* contact_gather,
                   const std::int32_t* contact_gather_units, const std::int32_t* contact_gather_turns,
                   const std::int32_t* contact_near, const std::int32_t* contact_force, const std::int32_t* touch_moment,
                   const std::int32_t* contact_gather_corner, const std::int32_t* contact_corner_force,
                   const Scalar* contact_corner_weight, const Scalar* contact_rest, Scalar* contact_node_sum,
                   const Scalar* contact_params, const Scalar* step_params) {
  constexpr std::int64_t area_plane = std::int64_t{3} * PLIANT_TILE;
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h, quantum = contact_params[2];
  std::int64_t seen = -1;
  bool gathers = false;
  for (std::int64_t n = range.begin; n < range.end; ++n) {
    const std::int64_t i = listed(contact_node_list, n), tile = i / PLIANT_TILE;
    if (tile != seen) gathers = touched(tile, contact_tiles_offset, contact_tiles, contact_near, contact_force);
    seen = tile;
    std::int64_t sum[3] = {};
    Scalar area = 0;
    for (std::int64_t k = contact_gather_offset[tile]; gathers && k < contact_gather_offset[tile + 1]; ++k) {
      const std::int64_t entry = k * PLIANT_TILE + i % PLIANT_TILE, at = contact_gather[entry];
      const std::int64_t units = contact_gather_units[entry];
      if ((units == 0 && MOMENT == 0 && EDGES == 0) || contact_near[at / (4 * PLIANT_TILE)] == 0 ||
          contact_force[at + area_plane] == 0)
        continue;
      for (std::int64_t c = 0; c < 3; ++c) sum[c] += contact_force[at + c * PLIANT_TILE] * units;
      if (MOMENT != 0 && (contact_near[at / (4 * PLIANT_TILE)] & PLIANT_TOUCH_BIT) != 0) {
        const std::int32_t* moment =
            touch_moment + at / (4 * PLIANT_TILE) * (PLIANT_TOUCH_MOMENT * PLIANT_TILE) + at % PLIANT_TILE;
        for (std::int64_t along = 0; along < 2; ++along) {
          const std::int64_t turns = contact_gather_turns[(2 * k + along) * PLIANT_TILE + i % PLIANT_TILE];
          for (std::int64_t c = 0; c < 3; ++c) sum[c] += moment[(3 * along + c) * PLIANT_TILE] * turns;
        }
      }
      Scalar weight = static_cast<Scalar>(units) * Scalar(1.0 / 4096);
      if (EDGES != 0 && contact_gather_corner[entry] >= 0 && (contact_near[at / (4 * PLIANT_TILE)] & ~PLIANT_TOUCH_BIT) != 0) {
        const std::int64_t corner = contact_gather_corner[entry], point = at / (4 * PLIANT_TILE), lane = at % PLIANT_TILE;
        const std::int32_t* part = contact_corner_force + point * 24 * PLIANT_TILE + 3 * corner * PLIANT_TILE + lane;
        const Scalar* weights = contact_corner_weight + point * 9 * PLIANT_TILE + lane;
        for (std::int64_t c = 0; c < 3; ++c) sum[c] += std::int64_t{4096} * part[c * PLIANT_TILE];
        weight = std::abs(weights[corner * PLIANT_TILE]) * weights[std::int64_t{8} * PLIANT_TILE];
      }
      area = std::fma(weight, contact_rest[at + area_plane], area);
    }
    const std::int64_t slot = contact_slot[i];
    const std::int32_t free = contact_free[i];
    Scalar *u = node_u + 4 * slot, *w = node_w + 4 * slot, *out = contact_node_sum + 4 * slot;
    for (int c = 0; c < 3; ++c) out[c] = static_cast<Scalar>(sum[c]) * quantum;
    out[3] = area;
    if (free == 0) continue;
    const Scalar bm = std::fma(half_hh, w[3], half_hh) * u[3];
    for (int c = 0; c < 3; ++c) {
      if ((free >> c & 1) == 0) continue;
      u[c] = std::fma(bm, out[c], u[c]);
      w[c] = std::fma(bm, out[c], w[c]);
    }
  }
}

void register_contact_apply(Registry& registry) {
  registry.add_specialised<2, 2>("contact_apply", {"MOMENT", "EDGES"}, [](auto scalar, auto moment, auto edges) {
    return contact_apply<decltype(scalar), moment, edges>;
  });
}

}  // namespace pliant::ref
