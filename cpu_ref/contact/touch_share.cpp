// Twin of kernels/contact/touch_share.cl.
#include "cpu_ref/contact/touch_point.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void touch_share(Range range, const Scalar* contact_rest, const std::int32_t* contact_near, const std::int32_t* touch_partner,
                 const Scalar* touch_weight, Scalar* touch_pair) {
  constexpr std::int64_t slots = PLIANT_TOUCH_SLOTS;
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    if ((contact_near[i / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) continue;
    const std::int64_t own = tile_base(i, slots), own_weight = tile_base(i, slots + 1);
    for (std::int64_t s = 0; s < slots; ++s) {
      const std::int64_t j = touch_partner[own + s * PLIANT_TILE] - 1;
      Scalar* numbers = touch::pair_numbers(touch_pair, i, s);
      Scalar area = 0;
      if (j >= 0) {
        std::int64_t back = 0;
        while (back < slots && touch_partner[tile_base(j, slots) + back * PLIANT_TILE] != i + 1) ++back;
        if (back < slots) {
          const Scalar one = touch_weight[own_weight + slots * PLIANT_TILE];
          const Scalar two = touch_weight[tile_base(j, slots + 1) + slots * PLIANT_TILE];
          const Scalar both = contact_rest[tile_base(i, 4) + std::int64_t{3} * PLIANT_TILE] *
                              contact_rest[tile_base(j, 4) + std::int64_t{3} * PLIANT_TILE];
          area = both * (touch_weight[own_weight + s * PLIANT_TILE] / (one > two ? one : two));
        }
      }
      numbers[0] = area;
      if (!(area > Scalar(0))) numbers[std::int64_t{5} * PLIANT_TILE] = 0;
    }
  }
}

void register_touch_share(Registry& registry) { registry.add("touch_share", touch_share<float>, touch_share<double>); }

}  // namespace pliant::ref
