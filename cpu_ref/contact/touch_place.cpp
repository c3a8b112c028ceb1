// Twin of kernels/contact/touch_place.cl.
#include "cpu_ref/contact/touch_tile.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

using namespace touch;

/// A corner of the elements of 16 points: texels of its node in node_u and node_w, and its area (again).
template <bool Again, class Scalar>
struct Corner {
  SortedTexels<Scalar> u, w;
  Lanes<Scalar> area;

  void load(const std::int32_t* node, const Scalar* node_u, const Scalar* node_w, const Scalar* contact_node_sum) {
    Scalar rows_u[PLIANT_TILE][4], rows_w[PLIANT_TILE][4];
    for (int l = 0; l < PLIANT_TILE; ++l) {
      const std::int64_t texel = std::int64_t{4} * node[l];
      std::copy_n(node_u + texel, 4, rows_u[l]);
      std::copy_n(node_w + texel, 4, rows_w[l]);
      area[l] = Again ? contact_node_sum[texel + 3] : Scalar(0);
    }
    load_texels(rows_u[0], u);
    load_texels(rows_w[0], w);
  }
};

/// Sums over the corners of 16 points.
template <class Scalar>
struct CornerSums {
  VecLanes<Scalar> x{}, moved{}, first_u{}, second_u{}, first_w{}, second_w{};
  Lanes<Scalar> compliance{}, whole{}, moving{};

  [[nodiscard, gnu::always_inline]] inline AlongTangents<Scalar> along(int l) const {
    return {lane(first_u, l), lane(second_u, l), lane(first_w, l), lane(second_w, l)};
  }
};

template <class Scalar>
[[gnu::always_inline]] inline void add_times(Scalar s, const SortedTexels<Scalar>& v, int l, VecLanes<Scalar>& sum) {
  set_lane(sum, l, scaled_sum(s, {v[0][l], v[1][l], v[2][l]}, lane(sum, l)));
}

/// `weight`, `shares`, `first`, `second`: of this corner. Again: the compliance is that of the points that touch.
template <bool Again, class Scalar>
[[gnu::always_inline]] inline void add_corner(const Corner<Again, Scalar>& corner, const Scalar* weight, const Scalar* shares,
                                              const Scalar* first, const Scalar* second, Scalar half_hh,
                                              CornerSums<Scalar>& sum) {
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
    const Scalar c = weight[l], share = shares[l], one = first[l], two = second[l], area = corner.area[l];
    add_times(c, corner.u, l, sum.x);
    add_times(c, corner.w, l, sum.moved);
    add_times(one, corner.u, l, sum.first_u);
    add_times(two, corner.u, l, sum.second_u);
    add_times(one, corner.w, l, sum.first_w);
    add_times(two, corner.w, l, sum.second_w);
    const Scalar b = std::fma(half_hh, corner.w[3][l], half_hh);
    const Scalar own = !Again ? share : c > Scalar(0) ? c * area : Scalar(0), free = share > Scalar(0) ? own : Scalar(0);
    sum.compliance[l] = std::fma(free, b * corner.u[3][l], sum.compliance[l]);
    sum.whole[l] = sum.whole[l] + own;
    sum.moving[l] = sum.moving[l] + free;
  }
}

/// `rest`, `counts`, `surface`, `yields`: of the first point.
template <bool Again, class Scalar>
[[gnu::always_inline]] inline void place_tile(const CornerSums<Scalar>& sum, const Scalar* rest, const std::int32_t* counts,
                                              const Scalar* surface, Scalar* yields, Places<Scalar>& places) {
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
    const Scalar yield = yields[l], w = sum.compliance[l], whole = sum.whole[l], moving = sum.moving[l];
    const AlongTangents<Scalar> along = sum.along(l);
    Place<Scalar> place = places.at(l);
    place.x = contact::sum_of(three(rest + l, 0, 0), lane(sum.x, l));
    place.moved = lane(sum.moved, l);
    if constexpr (!Again) set_frame(along, surface + l, place);
    place.tilt = tilt_of(along, place);
    if constexpr (Again) {
      const bool counted = (counts[l] != 0) & (moving > Scalar(0));
      yields[l] = counted ? w * (whole / moving) : Scalar(0);
    } else {
      place.yielding = yield > Scalar(0) ? yield : w;
    }
    places.set(l, place);
  }
}

}  // namespace

template <class Scalar>
void touch_place(Range range, const Scalar* node_u, const Scalar* node_w, const Scalar* contact_rest,
                 const std::int32_t* contact_node, const Scalar* contact_weight, const Scalar* contact_share,
                 const std::int32_t* contact_list, const std::int32_t* contact_near, Scalar* contact_yield,
                 const std::int32_t* contact_change, const Scalar* contact_node_sum, const Scalar* touch_surface,
                 Scalar* touch_place, const Scalar* step_params, std::int32_t again) {
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h;
  // Arrays of this function itself, and all inlined: gcc otherwise takes them for parts of the buffers.
  const auto place = [&](auto is_again) {
    Corner<is_again(), Scalar> corner;
    Places<Scalar> places;
    for (std::int64_t entry = range.begin; entry < range.end; entry += PLIANT_TILE) {
      const std::int64_t first = listed(contact_list, entry), corners = tile_base(first, 8);
      if ((contact_near[first / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) continue;
      const Scalar* surface = touch_surface + tile_base(first, PLIANT_TOUCH_SURFACE);
      CornerSums<Scalar> sum{};
      for (std::int64_t a = 0, plane = corners; a < 8; ++a, plane += PLIANT_TILE) {
        corner.load(contact_node + plane, node_u, node_w, contact_node_sum);
        add_corner(corner, contact_weight + plane, contact_share + plane, surface + a * PLIANT_TILE,
                   surface + (8 + a) * PLIANT_TILE, half_hh, sum);
      }
      load_tile(touch_place, first, places);
      place_tile<is_again()>(sum, contact_rest + tile_base(first, 4), contact_change + tile_base(first, 4) + 3 * PLIANT_TILE,
                             surface, contact_yield + first, places);
      store_tile(touch_place, first, places);
    }
  };
  again != 0 ? place(std::true_type{}) : place(std::false_type{});
}

void register_touch_place(Registry& registry) { registry.add("touch_place", touch_place<float>, touch_place<double>); }

}  // namespace pliant::ref
