// Twin of corner_lanes.cl, which describes the computation (kernels/contact).
#pragma once
#include "cpu_ref/contact/contact_edge.h"

namespace pliant::ref::contact {

/// Forces of edges on the nodes of points, and the weights for the compliance W.
template <class Scalar, int EDGES>
struct Corners {
  std::int32_t* force;
  Scalar* weight;

  /// Which tools have written the weights of a point.
  struct Counted {
    bool any = false;   ///< of those that meet it soon
    bool flat = false;  ///< of these, one without edges
    bool first = true;
  };
  void write_weights(const Scalar* contact_weight, std::int64_t i, const PatchMeeting<Scalar, EDGES>& met, bool soon,
                     Counted& counted) const {
    const bool first = counted.first;
    counted.first = false;
    if ((!soon && !first) || (!met.edged && counted.flat)) return;
    Scalar* out = weight + tile_base(i, 9);
    Scalar& whole = out[std::int64_t{8} * PLIANT_TILE];
    const Scalar before = counted.any ? whole : Scalar(0), share = met.edged ? met.spread_share : Scalar(1),
                 all = before + share;
    for (std::int64_t k = 0; k < 8; ++k) {
      const Scalar at_point = contact_weight[tile_base(i, 8) + k * PLIANT_TILE];
      const Scalar own = met.edged ? met.spread[static_cast<std::size_t>(k)] : at_point;
      Scalar& w = out[k * PLIANT_TILE];
      w = before > Scalar(0) ? std::fma(share, own, before * w) / all : own;
    }
    whole = all;
    counted.any = counted.any || soon;
    counted.flat = counted.flat || (soon && !met.edged);
  }
  void clear(std::int64_t i) const {
    if (EDGES == 0) return;
    for (std::int64_t k = 0; k < 24; ++k) force[tile_base(i, 24) + k * PLIANT_TILE] = 0;
  }
  /// The force of tool t on point i: at the point itself, or where an edge touches, its normal part there and its friction at
  /// the point, where slip is measured. `had`: what was added in this step.
  void add(const EdgedTools<Scalar, EDGES>& tools, std::int32_t t, std::int64_t i, const PatchMeeting<Scalar, EDGES>& met,
           const Place<Scalar>& p, const Vec<Scalar>& f, const Vec<Scalar>& had, const Quanta& before, const Scalar* params,
           const PointNumbers<std::int32_t>& on_tool, Quanta& sum) const {
    if constexpr (EDGES != 0) {
      if (met.edged) {
        const Vec<Scalar> along = times(met.m.normal, dot(f, met.m.normal));
        const Quanta pressed = quanta(times(met.m.normal, dot(had, met.m.normal)), params[1]);
        const Quanta push = difference(quanta(along, params[1]), pressed);
        const Quanta pull = difference(quanta(difference(f, along), params[1]), difference(before, pressed));
        add_to_tool(on_tool, tools.next(t), params, met.place, push);
        add_to_tool(on_tool, tools.next(t), params, p.now, pull);
        share_out(i, met, push);
        sum = sum_of(sum, pull);
        return;
      }
    }
    const Quanta q = difference(quanta(f, params[1]), before);
    add_to_tool(on_tool, tools.next(t), params, met.place, q);
    sum = sum_of(sum, q);
  }

 private:
  /// Distributes a force over the nodes; the rounding remainder goes to the node with the largest weight.
  void share_out(std::int64_t i, const PatchMeeting<Scalar, EDGES>& met, const Quanta& f) const {
    std::int32_t* out = force + tile_base(i, 24);
    Quanta left = f;
    std::size_t largest = 0;
    const auto give = [&](std::size_t k, const Quanta& part) {
      for (std::size_t c = 0; c < 3; ++c) out[static_cast<std::int64_t>(3 * k + c) * PLIANT_TILE] += part[c];
      left = difference(left, part);
    };
    for (std::size_t k = 0; k < 8; ++k) {
      const Scalar w = met.weight[k];
      give(k, {quanta(w * static_cast<Scalar>(f[0])), quanta(w * static_cast<Scalar>(f[1])),
               quanta(w * static_cast<Scalar>(f[2]))});
      largest = w > met.weight[largest] ? k : largest;
    }
    give(largest, Quanta(left));
  }
};

}  // namespace pliant::ref::contact
