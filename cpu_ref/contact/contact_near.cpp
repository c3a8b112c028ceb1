// Twin of kernels/contact/contact_near.cl.
#include "cpu_ref/contact/contact_edge.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int EDGES>
void contact_near(Range range, const Scalar* node_u, const Scalar* node_w, const Scalar* contact_rest,
                  const std::int32_t* contact_node, const Scalar* contact_weight, std::int32_t* contact_near,
                  Scalar* contact_gap, Scalar* contact_yield, Scalar* contact_anchor, const std::int32_t* tool_kind,
                  const Scalar* tool_data, const Scalar* tool_grid, const Scalar* tool_pose, const Scalar* touch_surface,
                  const Scalar* contact_params, std::int32_t tools, std::int32_t step) {
  using namespace contact;
  const Points<Scalar> points{node_u, node_w, contact_rest, contact_node, contact_weight};
  const EdgedTools<Scalar, EDGES> all{
      {tool_kind, tool_data, tool_grid, tool_pose, tools, step}, nullptr, {points, touch_surface, nullptr}};
  const Scalar margin = contact_params[5], ahead = Scalar(2) * contact_params[6];
  for (std::int64_t tile = range.begin; tile < range.end; ++tile) {
    std::int32_t near = 0;
    Scalar* least = contact_gap + tile * tools;
    for (std::int32_t t = 0; t < tools; ++t) least[t] = Scalar(1e30);
    for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
      const Place<Scalar> p = points.at(i);
      for (std::int32_t t = 0; t < tools; ++t) {
        const Meeting<Scalar> m = all.meet(t, p);
        const Scalar reach = all.has_edges(t) ? EdgeNumbers<Scalar>::stretch * all.patches.reach(i) : Scalar(0);
        const Scalar gap = std::fma(-ahead, std::sqrt(dot(m.slip, m.slip)), m.distance) - reach;
        least[t] = gap < least[t] ? gap : least[t];
      }
    }
    for (std::int32_t t = 0; t < tools; ++t) near |= least[t] < margin ? 1 << t : 0;
    for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
      const Scalar by = numbers_of(contact_anchor, i)[3];
      if (by < Scalar(0) && by > Scalar(-64)) near |= 1 << static_cast<std::int32_t>(-by - Scalar(1));
    }
    const std::int32_t before = contact_near[tile];
    if (near == 0 && (before & ~PLIANT_TOUCH_BIT) != 0) {
      const std::int64_t base = tile * 4 * PLIANT_TILE;
      for (std::int64_t k = base; k < base + std::int64_t{4} * PLIANT_TILE; ++k) contact_anchor[k] = 0;
      for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE && (before & PLIANT_TOUCH_BIT) == 0; ++i)
        contact_yield[i] = 0;
    }
    contact_near[tile] = near | (before & PLIANT_TOUCH_BIT);
  }
}

void register_contact_near(Registry& registry) {
  registry.add_specialised<2>("contact_near", {"EDGES"},
                              [](auto scalar, auto edges) { return contact_near<decltype(scalar), edges>; });
}

}  // namespace pliant::ref
