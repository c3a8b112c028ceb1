// Twin of kernels/contact/touch_place.cl.
#include "cpu_ref/contact/touch_point.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void touch_place(Range range, const Scalar* node_u, const Scalar* node_w, const Scalar* contact_rest,
                 const std::int32_t* contact_node, const Scalar* contact_weight, const Scalar* contact_share,
                 const std::int32_t* contact_list, const std::int32_t* contact_near, Scalar* contact_yield,
                 const std::int32_t* contact_change, const Scalar* contact_node_sum, const Scalar* touch_surface,
                 Scalar* touch_place, const Scalar* step_params, std::int32_t again) {
  using namespace touch;
  const contact::Points<Scalar> points{node_u, node_w, contact_rest, contact_node, contact_weight};
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h;
  for (std::int64_t entry = range.begin; entry < range.end; ++entry) {
    const std::int64_t i = listed(contact_list, entry);
    if ((contact_near[i / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) continue;
    const contact::Place<Scalar> p = points.at(i);
    const AlongTangents<Scalar> along = along_tangents(points, touch_surface, i);
    Place<Scalar> place = place_of(touch_place, i);
    place.x = p.now;
    place.moved = p.moved;
    if (again == 0) set_frame(along, touch_surface, i, place);
    place.tilt = tilt_of(along, place);
    Scalar w = 0, whole = 0, moving = 0;
    for (std::int64_t a = 0, first = tile_base(i, 8); a < 8; ++a) {
      const std::int64_t at = first + a * PLIANT_TILE, texel = std::int64_t{4} * contact_node[at];
      const Scalar b = std::fma(half_hh, node_w[texel + 3], half_hh), share = contact_share[at];
      const Scalar c = contact_weight[at];
      const Scalar own = again == 0 ? share : c > Scalar(0) ? c * contact_node_sum[texel + 3] : Scalar(0);
      const Scalar free = share > Scalar(0) ? own : Scalar(0);
      w = std::fma(free, b * node_u[texel + 3], w);
      whole = whole + own;
      moving = moving + free;
    }
    if (again != 0) {
      const bool counted = contact::numbers_of(contact_change, i)[3] != 0;
      contact_yield[i] = counted && moving > Scalar(0) ? w * (whole / moving) : Scalar(0);
    } else {
      place.yielding = contact_yield[i] > Scalar(0) ? contact_yield[i] : w;
    }
    write_place(touch_place, i, place);
  }
}

void register_touch_place(Registry& registry) { registry.add("touch_place", touch_place<float>, touch_place<double>); }

}  // namespace pliant::ref
