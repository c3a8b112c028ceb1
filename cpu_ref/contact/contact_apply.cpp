// Twin of kernels/contact/contact_apply.cl.
#include <algorithm>
#include <cmath>
#include <utility>

#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"
#include "layout.h"

namespace pliant::ref {

namespace {

/// Returns true if a point of the tile is marked as touching in contact_force.
bool touched(std::int64_t points, const std::int32_t* near, const std::int32_t* force) {
  if (near[points] == 0) return false;
  const std::int32_t* marks = force + 4 * PLIANT_TILE * points + std::int64_t{3 * PLIANT_TILE};
  return std::any_of(marks, marks + PLIANT_TILE, [](std::int32_t mark) { return mark != 0; });
}

constexpr std::int64_t area_plane = std::int64_t{3} * PLIANT_TILE;  ///< of contact_rest; of contact_force its bits

template <class... T>
void only_for_one_lane(const T&... /*rows*/) {}

/// What the points give to the nodes of a tile: force in quanta, and area.
template <class Scalar>
struct TileSum {
  std::int64_t force[PLIANT_TILE][3] = {};
  Scalar area[PLIANT_TILE] = {};
};

}  // namespace

template <class Scalar, int MOMENT, int EDGES>
void contact_apply(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* contact_slot,
                   const std::int32_t* contact_free, const std::int32_t* contact_node_list,
                   const std::int32_t* contact_tiles_offset, const std::int32_t* contact_tiles,
                   const std::int32_t* contact_entry_offset, const std::int32_t* contact_entry,
                   const std::int32_t* contact_gather_offset, const std::int32_t* contact_gather,
                   const std::int32_t* contact_gather_units, const std::int32_t* contact_gather_turns,
                   const std::int32_t* contact_near, const std::int32_t* contact_force, const std::int32_t* touch_moment,
                   const std::int32_t* contact_gather_corner, const std::int32_t* contact_corner_force,
                   const Scalar* contact_corner_weight, const Scalar* contact_rest, Scalar* contact_node_sum,
                   const Scalar* contact_params, const Scalar* step_params) {
  only_for_one_lane(contact_gather_offset, contact_gather, contact_gather_units, contact_gather_turns, contact_gather_corner);
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h, quantum = contact_params[2];
  TileSum<Scalar> sum;
  std::int64_t seen = -1;
  const auto add = [&](std::int64_t tile, const std::int32_t* entry) {
    const std::int64_t lane = entry[0] % 16, of_tile = entry[0] / 16 % 16, units = entry[1];
    const std::int32_t* force = contact_force + tile * 4 * PLIANT_TILE + of_tile;
    if ((units == 0 && MOMENT == 0 && EDGES == 0) || force[area_plane] == 0) return;
    std::int64_t* own = sum.force[lane];
    for (std::int64_t c = 0; c < 3; ++c) own[c] += force[c * PLIANT_TILE] * units;
    if (MOMENT != 0 && (contact_near[tile] & PLIANT_TOUCH_BIT) != 0) {
      const std::int32_t* moment = touch_moment + PLIANT_TOUCH_MOMENT * (tile * PLIANT_TILE + of_tile);
      for (std::int64_t c = 0; c < 3; ++c)
        own[c] += std::int64_t{moment[c]} * entry[2] + std::int64_t{moment[4 + c]} * entry[3];
    }
    Scalar weight = static_cast<Scalar>(units) * Scalar(1.0 / 4096);
    const std::int64_t corner = entry[0] / 256;
    if (EDGES != 0 && (contact_near[tile] & ~PLIANT_TOUCH_BIT) != 0) {
      const std::int32_t* part = contact_corner_force + tile * 24 * PLIANT_TILE + 3 * corner * PLIANT_TILE + of_tile;
      const Scalar* weights = contact_corner_weight + tile * 9 * PLIANT_TILE + of_tile;
      for (std::int64_t c = 0; c < 3; ++c) own[c] += std::int64_t{4096} * part[c * PLIANT_TILE];
      weight = std::abs(weights[corner * PLIANT_TILE]) * weights[std::int64_t{8} * PLIANT_TILE];
    }
    sum.area[lane] = std::fma(weight, contact_rest[tile * 4 * PLIANT_TILE + of_tile + area_plane], sum.area[lane]);
  };
  for (std::int64_t n = range.begin; n < range.end; ++n) {
    const std::int64_t i = listed(contact_node_list, n), tile = i / PLIANT_TILE, lane = i % PLIANT_TILE;
    if (std::exchange(seen, tile) != tile) {
      sum = {};
      for (std::int32_t t = contact_tiles_offset[tile]; t < contact_tiles_offset[tile + 1]; ++t) {
        if (!touched(contact_tiles[t], contact_near, contact_force)) continue;
        for (std::int32_t e = contact_entry_offset[t]; e < contact_entry_offset[t + 1]; ++e)
          add(contact_tiles[t], contact_entry + std::int64_t{4} * e);
      }
    }
    const std::int64_t slot = contact_slot[i];
    if (slot < 0) continue;
    const std::int32_t free = contact_free[i];
    Scalar *u = node_u + 4 * slot, *w = node_w + 4 * slot, *out = contact_node_sum + 4 * slot;
    for (int c = 0; c < 3; ++c) out[c] = static_cast<Scalar>(sum.force[lane][c]) * quantum;
    out[3] = sum.area[lane];
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
