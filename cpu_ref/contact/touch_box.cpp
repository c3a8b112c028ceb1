// Twin of kernels/contact/touch_box.cl.
#include <algorithm>

#include "cpu_ref/contact/touch_point.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void touch_box(Range range, const Scalar* node_u, const Scalar* node_w, const Scalar* contact_rest,
               const std::int32_t* contact_node, const Scalar* contact_weight, const Scalar* touch_surface, Scalar* touch_place,
               Scalar* touch_box) {
  using namespace touch;
  const contact::Points<Scalar> points{node_u, node_w, contact_rest, contact_node, contact_weight};
  for (std::int64_t tile = range.begin; tile < range.end; ++tile) {
    Scalar* box = touch_box + tile * PLIANT_TOUCH_BOX;
    for (std::int64_t k = 0; k < 9; ++k) {
      box[2 * k] = Scalar(1e30);
      box[2 * k + 1] = Scalar(-1e30);
    }
    box[18] = 0;
    for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
      const contact::Place<Scalar> p = points.at(i);
      const AlongTangents<Scalar> along = along_tangents(points, touch_surface, i);
      Place<Scalar> place{p.now, p.moved};
      set_frame(along, touch_surface + tile_base(i, PLIANT_TOUCH_SURFACE), place);
      place.tilt = tilt_of(along, place);
      write_place(touch_place, i, place);
      const Scalar spacing = touch_surface[tile_base(i, PLIANT_TOUCH_SURFACE) + std::int64_t{22} * PLIANT_TILE];
      if (!(spacing > Scalar(0))) continue;
      box[18] = box[18] < spacing ? spacing : box[18];
      for (std::size_t k = 0; k < 9; ++k) {
        const Scalar v = k < 3 ? p.now[k] : k < 6 ? p.moved[k - 3] : place.normal[k - 6];
        box[2 * k] = v < box[2 * k] ? v : box[2 * k];
        box[2 * k + 1] = v > box[2 * k + 1] ? v : box[2 * k + 1];
      }
    }
  }
}

void register_touch_box(Registry& registry) { registry.add("touch_box", touch_box<float>, touch_box<double>); }

}  // namespace pliant::ref
