// Twin of kernels/contact/contact_settle.cl.
#include <bit>

#include "cpu_ref/contact/contact_corners.h"
#include "cpu_ref/contact/contact_grip.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

using namespace contact;

/// Friction of both parts together, towards the anchor; where the point slips, the anchor follows.
template <class Scalar>
Vec<Scalar> settle_friction(const Meeting<Scalar>& m, const Scalar* next, const PointNumbers<Scalar>& anchor, Scalar stiffness,
                            Scalar friction, const Vec<Scalar>& f) {
  const Vec<Scalar> slip = turned(next, difference(m.inside, {anchor[0], anchor[1], anchor[2]}));
  const Scalar along = dot(slip, m.normal), across = dot(f, m.normal);
  const Vec<Scalar> side = scaled_sum(minus(along), m.normal, slip);
  const Vec<Scalar> pull = scaled_sum(-stiffness, side, scaled_sum(minus(across), m.normal, f));
  const Scalar length = std::sqrt(dot(pull, pull)), most = across > Scalar(0) ? friction * across : Scalar(0);
  if (length > most) {
    const Scalar size = std::sqrt(dot(side, side)), hold = stiffness > Scalar(0) ? most / stiffness : Scalar(0);
    const Scalar kept = size > hold ? hold / size : Scalar(1);
    const Vec<Scalar> back = turned_back(next, scaled_sum(-kept, side, times(m.normal, minus(along))));
    for (std::size_t k = 0; k < 3; ++k) anchor[static_cast<std::int64_t>(k)] = m.inside[k] + back[k];
  }
  return scaled_sum(length > most ? most / length : Scalar(1), pull, times(m.normal, across));
}

/// The second part of a grip, added to `f`; a point that both parts together tear off has slipped out after this step. `more`:
/// of the first part what `f` has not.
template <class Scalar>
Vec<Scalar> settle_grip(const Tools<Scalar>& tools, std::int32_t t, const Meeting<Scalar>& m,
                        const PointNumbers<Scalar>& anchor, Scalar stiffness, Scalar area, const Vec<Scalar>* more,
                        const Vec<Scalar>& f) {
  const Vec<Scalar> both = scaled_sum(-stiffness, grip_slip(tools, t, anchor, m), f);
  Vec<Scalar> all = both;
  for (std::size_t k = 0; more != nullptr && k < 3; ++k) all[k] += (*more)[k];
  if (tears_off(all, m.normal, area * grip_of(tools, t))) anchor[3] = slipped_from<Scalar>(t);
  return both;
}

template <class Scalar>
Vec<Scalar> force_of(const Quanta& q, Scalar quantum) {
  return {static_cast<Scalar>(q[0]) * quantum, static_cast<Scalar>(q[1]) * quantum, static_cast<Scalar>(q[2]) * quantum};
}

/// Weights of the nodes where the point meets its tools.
template <int EDGES, class Scalar>
const Scalar* weights_of(std::int64_t i, bool by_tools, const Scalar* contact_weight, const Scalar* contact_corner_weight) {
  return EDGES != 0 && by_tools ? contact_corner_weight + tile_base(i, 9) : contact_weight + tile_base(i, 8);
}

/// W of the points that touch or may touch; `weight`: weights of the nodes at the place of contact.
template <class Scalar>
Scalar yield_of_touching(const Points<Scalar>& points, const Scalar* contact_share, const Scalar* contact_node_sum,
                         std::int64_t i, Scalar half_hh, const Scalar* weight) {
  Scalar w = 0, whole = 0, moving = 0;
  for (std::int64_t a = 0, base = tile_base(i, 8); a < 8; ++a) {
    const std::int64_t at = base + a * PLIANT_TILE, texel = std::int64_t{4} * points.node[at];
    const Scalar b = std::fma(half_hh, points.node_w[texel + 3], half_hh);
    const Scalar c = weight[a * PLIANT_TILE], own = c > Scalar(0) ? c * contact_node_sum[texel + 3] : Scalar(0);
    const Scalar free = contact_share[at] > Scalar(0) ? own : Scalar(0);
    w = std::fma(free, b * points.node_u[texel + 3], w);
    whole = whole + own;
    moving = moving + free;
  }
  return moving > Scalar(0) ? w * (whole / moving) : Scalar(0);
}

}  // namespace

template <class Scalar, int EDGES, int GRIPS>
void contact_settle(Range range, const Scalar* node_u, const Scalar* node_w, const Scalar* contact_rest,
                    const std::int32_t* contact_node, const Scalar* contact_weight, const Scalar* contact_share,
                    const Scalar* contact_held, const std::int32_t* contact_list, const std::int32_t* contact_near,
                    Scalar* contact_yield, Scalar* contact_anchor, const Scalar* contact_start, std::int32_t* contact_force,
                    std::int32_t* contact_change, const Scalar* contact_node_sum, std::int32_t* contact_tool_force,
                    const std::int32_t* tool_kind, const Scalar* tool_data, const Scalar* tool_grid, const Scalar* tool_edge,
                    const Scalar* tool_pose, const Scalar* touch_surface, const Scalar* contact_patch,
                    Scalar* contact_corner_weight, std::int32_t* contact_corner_force, const Scalar* contact_params,
                    const Scalar* step_params, std::int32_t point_count, std::int32_t tools, std::int32_t step) {
  const Points<Scalar> points{node_u, node_w, contact_rest, contact_node, contact_weight};
  const EdgedTools<Scalar, EDGES> all{
      {tool_kind, tool_data, tool_grid, tool_pose, tools, step}, tool_edge, {points, touch_surface, contact_patch}};
  const Corners<Scalar, EDGES> corners{contact_corner_force, contact_corner_weight};
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h, quantum = contact_params[0];
  for (std::int64_t entry = range.begin; entry < range.end; ++entry) {
    const std::int64_t i = listed(contact_list, entry);
    if (contact_near[i / PLIANT_TILE] == 0) continue;
    const PointNumbers<Scalar> anchor = numbers_of(contact_anchor, i);
    const PointNumbers<std::int32_t> force = numbers_of(contact_force, i), change = numbers_of(contact_change, i);
    const std::int32_t touching = force[3];
    Quanta sum{};
    corners.clear(i);
    if (touching != 0) {
      const Place<Scalar> p = points.at(i);
      const Scalar known = contact_yield[i];
      const bool by_tools = (contact_near[i / PLIANT_TILE] & ~PLIANT_TOUCH_BIT) != 0;
      const Scalar* weight = weights_of<EDGES>(i, by_tools, contact_weight, contact_corner_weight);
      contact_yield[i] = yield_of_touching(points, contact_share, contact_node_sum, i, half_hh, weight);
      const int count = std::popcount(static_cast<std::uint32_t>(touching) & ((1U << tools) - 1));
      const Scalar whole = known > Scalar(0) ? points.area(i) / (known * static_cast<Scalar>(count)) : Scalar(0);
      for (std::int32_t t = 0; t < tools; ++t) {
        if ((touching >> t & 1) == 0) continue;
        const PatchMeeting<Scalar, EDGES> met = all.meet_patch(t, i, p);
        const Meeting<Scalar>& m = met.m;
        const Scalar stiffness = (whole * met.share) * met.ease;
        const PointNumbers<std::int32_t> on_tool = tool_force_of(contact_tool_force, point_count, t, i);
        const Scalar* law = all.law(t);
        const Scalar held = held_depth(points, contact_share, contact_held, i, met.place, m);
        const bool held_fast = GRIPS != 0 && anchor[3] == gripped_by<Scalar>(t);
        const Scalar lag = left_in(contact_start + tile_base(i, 2), t), rest = ((-m.distance - held) - lag) - law[15];
        const Scalar push = rest > Scalar(0) && !held_fast ? stiffness * rest : Scalar(0);
        const Quanta pressed{-on_tool[0], -on_tool[1], -on_tool[2]}, before = count == 1 ? pressed : Quanta{};
        const Vec<Scalar> first = force_of(pressed, quantum), own = times(m.normal, push);
        Vec<Scalar> f = count == 1 ? sum_of(own, first) : own;
        if (held_fast) f = settle_grip(all, t, m, anchor, stiffness, points.area(i), count == 1 ? nullptr : &first, f);
        if (count == 1 && anchor[3] == static_cast<Scalar>(t + 1))
          f = settle_friction(m, all.next(t), anchor, stiffness, law[14], f);
        corners.add(all, t, i, met, p, f, count == 1 ? first : Vec<Scalar>{}, before, contact_params, on_tool, sum);
        if (all.is_face(t)) spread_by_face(on_tool, contact_params, lag, m.normal, all.given_back(t, contact_params));
      }
      for (std::size_t k = 0; k < 3; ++k) force[static_cast<std::int64_t>(k)] += sum[k];
    } else {
      contact_yield[i] = 0;
    }
    for (std::size_t k = 0; k < 3; ++k) change[static_cast<std::int64_t>(k)] = sum[k];
    change[3] = touching;
  }
}

void register_contact_settle(Registry& registry) {
  registry.add_specialised<2, 2>("contact_settle", {"EDGES", "GRIPS"}, [](auto scalar, auto edges, auto grips) {
    return contact_settle<decltype(scalar), edges(), grips()>;
  });
}

}  // namespace pliant::ref
