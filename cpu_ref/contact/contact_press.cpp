// Twin of kernels/contact/contact_press.cl.
#include "cpu_ref/contact/contact_corners.h"
#include "cpu_ref/contact/contact_grip.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

using namespace contact;

/// The normal force on a point. `depth`: without what no force takes back.
template <class Scalar>
Scalar normal_force(Scalar depth, Scalar opening, const Scalar* law, Scalar area, Scalar stiffness, Scalar h) {
  const Scalar before = depth + opening;
  Scalar push = 0;
  if (law[12] > Scalar(0) && before > Scalar(0)) {
    const Scalar spring = (area * law[12]) * (law[16] > Scalar(0) ? before * std::sqrt(before) : before);
    const Scalar damped = spring * std::fma(law[13], -opening / h, Scalar(1));
    const Scalar most = Scalar(0.5) * (stiffness * before);
    push = damped > Scalar(0) ? (damped < most ? damped : most) : Scalar(0);
  }
  const Scalar rest = stiffness > Scalar(0) ? depth - push / stiffness - law[15] : Scalar(0);
  return rest > Scalar(0) ? std::fma(stiffness, rest, push) : push;
}

/// Friction towards the anchor, at most `most`.
template <class Scalar>
Vec<Scalar> press_friction(const Meeting<Scalar>& m, const Scalar* next, const PointNumbers<Scalar>& anchor, Scalar stiffness,
                           Scalar most, const Vec<Scalar>& f) {
  const Vec<Scalar> slip = turned(next, difference(m.inside, {anchor[0], anchor[1], anchor[2]}));
  const Vec<Scalar> side = scaled_sum(minus(dot(slip, m.normal)), m.normal, slip);
  const Scalar length = std::sqrt(dot(side, side));
  const Scalar factor = stiffness * length > most ? most / length : stiffness;
  return scaled_sum(-factor, side, f);
}

/// The point keeps its place on the tool from the start of the step on. `by`: what says that this tool has it.
template <class Scalar>
void hold_here(const Tools<Scalar>& tools, std::int32_t t, const Place<Scalar>& p, Scalar by,
               const PointNumbers<Scalar>& anchor) {
  set_three(anchor, turned_back(tools.now(t), difference(difference(p.now, p.moved), origin_of(tools.now(t)))));
  anchor[3] = by;
}

/// The normal force, and friction if the tool has any.
template <class Scalar>
Vec<Scalar> with_friction(const Tools<Scalar>& tools, std::int32_t t, const Place<Scalar>& p, const Meeting<Scalar>& m,
                          const PointNumbers<Scalar>& anchor, Scalar stiffness, Scalar push) {
  const Vec<Scalar> f = times(m.normal, push);
  const Scalar friction = tools.law(t)[14];
  const auto own = static_cast<Scalar>(t + 1);
  if (!(friction > Scalar(0))) return f;
  if (anchor[3] == Scalar(0)) hold_here(tools, t, p, own, anchor);
  return anchor[3] == own ? press_friction(m, tools.next(t), anchor, stiffness, friction * push, f) : f;
}

/// Drag of an edge on what slips along it (contact_edge.cl).
template <class Scalar, int EDGES>
Vec<Scalar> with_drag(const PatchMeeting<Scalar, EDGES>& met, Scalar push, Scalar stiffness, const Vec<Scalar>& f) {
  if (!met.edged || !(push > Scalar(0))) return f;
  const Vec<Scalar> side = scaled_sum(minus(dot(met.m.slip, met.m.normal)), met.m.normal, met.m.slip);
  return scaled_sum(-(EdgeNumbers<Scalar>::drag * stiffness), side, f);
}

/// The tools that a point touches, one bit each, and whether it may touch something in the next step.
struct Reached {
  std::int32_t touching = 0, gripped = 0, out = 0, count = 0, ready = 0;
};

/// Releases a point from a tool that it touches no longer, or that has let it go.
template <int GRIPS, class Scalar>
void let_go(const PointNumbers<Scalar>& anchor, const Reached& reached) {
  const std::int32_t stuck_to = static_cast<std::int32_t>(anchor[3]) - 1;
  if (stuck_to >= 0 && (reached.touching >> stuck_to & 1) == 0) anchor[3] = 0;
  if (GRIPS == 0 || !(anchor[3] < Scalar(0))) return;
  const auto by = static_cast<std::int32_t>(-anchor[3] - Scalar(1));
  if (((by < 64 ? reached.gripped >> by : reached.out >> (by - 64)) & 1) == 0) anchor[3] = 0;
}

/// W if the touching points are not known yet: that of all points around.
template <class Scalar>
Scalar yield_of_all(const Scalar* node_u, const Scalar* node_w, const std::int32_t* contact_node, const Scalar* contact_share,
                    std::int64_t i, Scalar half_hh) {
  Scalar w = 0;
  for (std::int64_t a = 0, base = tile_base(i, 8); a < 8; ++a) {
    const std::int64_t texel = std::int64_t{4} * contact_node[base + a * PLIANT_TILE];
    const Scalar b = std::fma(half_hh, node_w[texel + 3], half_hh);
    w = std::fma(contact_share[base + a * PLIANT_TILE], b * node_u[texel + 3], w);
  }
  return w;
}

template <int GRIPS, class Scalar, int EDGES>
Reached reach(const EdgedTools<Scalar, EDGES>& all, [[maybe_unused]] const Corners<Scalar, EDGES>& corners,
              [[maybe_unused]] const Scalar* contact_weight, [[maybe_unused]] const Scalar* contact_held,
              [[maybe_unused]] const PointNumbers<Scalar>& anchor, std::int64_t i, const Place<Scalar>& p, std::int32_t near,
              Scalar margin, Scalar within) {
  Reached out;
  [[maybe_unused]] typename Corners<Scalar, EDGES>::Counted counted;
  for (std::int32_t t = 0; t < all.count; ++t) {
    if ((near >> t & 1) == 0) continue;
    const PatchMeeting<Scalar, EDGES> met = all.meet_patch(t, i, p);
    const bool soon = met.m.may_touch_next(margin, within);
    if (soon) out.ready = PLIANT_READY_BIT;
    if constexpr (EDGES != 0) corners.write_weights(contact_weight, i, met, soon, counted);
    bool gripped = false;
    if constexpr (GRIPS != 0) {
      gripped = !met.edged && grips(all, contact_held, anchor, t, i, met.m, margin);
      out.out |= (slipped(all, anchor, t, met.m, margin) ? 1 : 0) << t;
    }
    if (!(met.m.distance < Scalar(0)) && !gripped) continue;
    out.gripped |= (gripped ? 1 : 0) << t;
    out.touching |= 1 << t;
    ++out.count;
  }
  return out;
}

}  // namespace

template <class Scalar, int EDGES, int GRIPS>
void contact_press(Range range, const Scalar* node_u, const Scalar* node_w, const Scalar* contact_rest,
                   const std::int32_t* contact_node, const Scalar* contact_weight, const Scalar* contact_share,
                   const Scalar* contact_held, const std::int32_t* contact_list, const std::int32_t* contact_near,
                   Scalar* contact_yield, Scalar* contact_anchor, Scalar* contact_start, std::int32_t* contact_force,
                   std::int32_t* contact_tool_force, const std::int32_t* tool_kind, const Scalar* tool_data,
                   const Scalar* tool_grid, const Scalar* tool_edge, const Scalar* tool_pose, const Scalar* touch_surface,
                   const Scalar* contact_patch, Scalar* contact_corner_weight, std::int32_t* contact_corner_force,
                   const Scalar* contact_params, const Scalar* step_params, std::int32_t point_count, std::int32_t tools,
                   std::int32_t step) {
  const Points<Scalar> points{node_u, node_w, contact_rest, contact_node, contact_weight};
  const EdgedTools<Scalar, EDGES> all{
      {tool_kind, tool_data, tool_grid, tool_pose, tools, step}, tool_edge, {points, touch_surface, contact_patch}};
  const Corners<Scalar, EDGES> corners{contact_corner_force, contact_corner_weight};
  const Scalar h = step_params[0], half_hh = (Scalar(0.5) * h) * h;
  for (std::int64_t entry = range.begin; entry < range.end; ++entry) {
    const std::int64_t i = listed(contact_list, entry);
    const std::int32_t near = contact_near[i / PLIANT_TILE];
    const Place<Scalar> p = points.at(i);
    const Scalar area = points.area(i), within = ready_share(contact_yield[i]);  // padding has no area
    const PointNumbers<Scalar> anchor = numbers_of(contact_anchor, i);
    const Reached reached = area > Scalar(0) ? reach<GRIPS>(all, corners, contact_weight, contact_held, anchor, i, p, near,
                                                            contact_params[5], within)
                                             : Reached{};
    const std::int32_t touching = reached.touching, count = reached.count;
    const PointNumbers<std::int32_t> force = numbers_of(contact_force, i);
    let_go<GRIPS>(anchor, reached);
    LeftDeep<Scalar> left{contact_start + tile_base(i, 2)};
    Quanta sum{};
    corners.clear(i);
    Scalar w = contact_yield[i];
    if (touching != 0 && !(w > Scalar(0)))
      contact_yield[i] = w = yield_of_all(node_u, node_w, contact_node, contact_share, i, half_hh);
    const Scalar whole = w > Scalar(0) ? area / (w * static_cast<Scalar>(count)) : Scalar(0);
    for (std::int32_t t = 0; t < tools; ++t) {
      if ((near >> t & 1) == 0) continue;
      const PointNumbers<std::int32_t> on_tool = tool_force_of(contact_tool_force, point_count, t, i);
      on_tool[7] = touching >> t & 1;
      if (on_tool[7] == 0) continue;
      const PatchMeeting<Scalar, EDGES> met = all.meet_patch(t, i, p);
      const Meeting<Scalar>& m = met.m;
      const Scalar stiffness = (whole * met.share) * met.ease;
      const Scalar* law = all.law(t);
      const Scalar held = held_depth(points, contact_share, contact_held, i, met.place, m);
      const Scalar beyond = -m.distance - held,
                   depth = beyond - left.in(t, beyond + m.opening, all.given_back(t, contact_params));
      const Scalar push = normal_force(depth, m.opening, law, area, stiffness, h);
      if (GRIPS != 0 && (reached.gripped >> t & 1) != 0 && anchor[3] >= Scalar(0))
        hold_here(all, t, p, gripped_by<Scalar>(t), anchor);
      const bool gripped = GRIPS != 0 && anchor[3] == gripped_by<Scalar>(t);
      const Vec<Scalar> f =
          gripped ? times(grip_slip(all, t, anchor, m), -stiffness) : with_friction(all, t, p, m, anchor, stiffness, push);
      begin_touch(on_tool, m.opening - m.distance);
      corners.add(all, t, i, met, p, with_drag(met, push, stiffness, f), {}, {}, contact_params, on_tool, sum);
    }
    left.keep();
    set_three(force, sum);
    force[3] = touching | reached.ready;
  }
}

void register_contact_press(Registry& registry) {
  registry.add_specialised<2, 2>("contact_press", {"EDGES", "GRIPS"}, [](auto scalar, auto edges, auto grips) {
    return contact_press<decltype(scalar), edges(), grips()>;
  });
}

}  // namespace pliant::ref
