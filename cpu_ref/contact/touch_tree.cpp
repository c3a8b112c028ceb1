// Twin of kernels/contact/touch_tree.cl.
#include "cpu_ref/registry.h"
#include "layout.h"

namespace pliant::ref {

template <class Scalar>
void touch_tree(Range range, const std::int32_t* touch_node, Scalar* touch_box) {
  for (std::int64_t k = range.begin; k < range.end; ++k) {
    const std::int32_t* node = touch_node + k * PLIANT_TOUCH_TREE;
    if (node[3] - node[2] == 1) continue;  // a tile: touch_box has computed its box
    Scalar* box = touch_box + std::int64_t{PLIANT_TOUCH_BOX} * node[0];
    for (std::int64_t b = 0; b < PLIANT_TOUCH_BOX; ++b) {
      const bool high = b % 2 == 1 || b == 18;
      Scalar most = touch_box[std::int64_t{PLIANT_TOUCH_BOX} * node[2] + b];
      for (std::int64_t tile = node[2] + 1; tile < node[3]; ++tile) {
        const Scalar v = touch_box[PLIANT_TOUCH_BOX * tile + b];
        most = (high ? v > most : v < most) ? v : most;
      }
      box[b] = most;
    }
  }
}

void register_touch_tree(Registry& registry) { registry.add("touch_tree", touch_tree<float>, touch_tree<double>); }

}  // namespace pliant::ref
