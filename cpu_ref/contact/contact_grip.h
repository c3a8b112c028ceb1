// Twin of kernels/contact/contact_grip.cl, which describes the computation.
#pragma once
#include "cpu_ref/contact/contact_edge.h"

namespace pliant::ref::contact {

/// What a gripped point has in place of the number of the tool that it sticks to.
template <class Scalar>
Scalar gripped_by(std::int32_t t) {
  return -static_cast<Scalar>(t + 1);
}

/// What a point has that has slipped out of a tool's grip.
template <class Scalar>
Scalar slipped_from(std::int32_t t) {
  return -static_cast<Scalar>(t + 65);
}

/// Strength of the grip in this step; 0: it does not grip.
template <class Scalar>
Scalar grip_of(const Tools<Scalar>& tools, std::int32_t t) {
  return tools.next(t)[14];
}

template <class Scalar>
Vec<Scalar> grip_slip(const Tools<Scalar>& tools, std::int32_t t, const PointNumbers<Scalar>& anchor,
                      const Meeting<Scalar>& m) {
  return turned(tools.next(t), difference(m.inside, {anchor[0], anchor[1], anchor[2]}));
}

constexpr float grip_reach = 0.08F;  // of the margin

/// Whether a point has slipped out of a tool that still grips, and is still within its reach.
template <class Scalar>
bool slipped(const Tools<Scalar>& tools, const PointNumbers<Scalar>& anchor, std::int32_t t, const Meeting<Scalar>& m,
             Scalar margin) {
  return anchor[3] == slipped_from<Scalar>(t) && grip_of(tools, t) > Scalar(0) && m.distance < Scalar(grip_reach) * margin;
}

template <class Scalar>
bool grips(const Tools<Scalar>& tools, const Scalar* contact_held, const PointNumbers<Scalar>& anchor, std::int32_t t,
           std::int64_t i, const Meeting<Scalar>& m, Scalar margin) {
  constexpr auto limit = Scalar(4);  // of the margin
  if (!(grip_of(tools, t) > Scalar(0)) || contact_held[tile_base(i, 4) + std::int64_t{3} * PLIANT_TILE] > Scalar(0))
    return false;
  const Scalar by = anchor[3];
  if (!(by < Scalar(0))) return m.distance < Scalar(grip_reach) * margin;
  if (by != gripped_by<Scalar>(t)) return false;
  const Vec<Scalar> slip = grip_slip(tools, t, anchor, m);
  return dot(slip, slip) <= (limit * margin) * (limit * margin);
}

/// Whether a force takes a point off the tool.
template <class Scalar>
bool tears_off(const Vec<Scalar>& f, const Vec<Scalar>& normal, Scalar most) {
  const Scalar along = dot(f, normal), push = along > Scalar(0) ? along : Scalar(0);
  const Vec<Scalar> off = scaled_sum(-push, normal, f);
  return dot(off, off) > most * most;
}

}  // namespace pliant::ref::contact
