// Twin of kernels/contact/contact_face.cl, which describes the computation.
#pragma once
#include "cpu_ref/contact/contact_patch.h"

namespace pliant::ref::contact {

/// Points farther than this from the box around the blade need no normal [h].
template <class Scalar>
inline constexpr Scalar face_near = Scalar(0.25);

/// The face of a blade that a point belongs to (contact_face.cl): distance, opening and normal of the meeting.
template <class Scalar>
void meet_face(const Scalar* data, const Scalar* next, const PatchPlane<Scalar>& plane, Meeting<Scalar>& m) {
  constexpr Scalar looks_from = Scalar(0.6), none = 0;
  const Vec<Scalar>& y = plane.y;
  const Scalar side = data[1], half = data[4], looks = side * plane.normal[0], at = side * y[0];
  const Scalar low = (y[1] + data[5]) - data[7], high = data[5] - y[1], end = data[6] - std::fabs(y[2]);
  const Scalar up = (low < high ? low : high) * data[2], along = end * data[3], rise = up < along ? up : along;
  const Scalar wide = rise < half ? rise : half;
  if (!(looks < -looks_from) || !(wide > none) || !(at > Scalar(-2) * half) || !(next[12] > none)) {
    m.distance = Scalar(1e30);
    m.opening = 0;
    return;
  }
  const Scalar slope_y = rise < half && up < along ? (low < high ? data[2] : -data[2]) : none;
  const Scalar slope_z = rise < half && !(up < along) ? (y[2] > none ? -data[3] : data[3]) : none;
  const Scalar length = std::sqrt(dot<Scalar>({1, slope_y, slope_z}, {1, slope_y, slope_z}));
  const Vec<Scalar> normal{side / length, -slope_y / length, -slope_z / length};
  const Scalar inside = at > -wide ? at : -wide;
  m.opening = dot(normal, difference(m.inside, y));
  m.distance = (inside - wide) / length + m.opening;
  m.normal = turned(next, normal);
}

}  // namespace pliant::ref::contact
