// The described keys of conditions, of their changes over time, and of probes (described.h).
#pragma once
#include "scene/described.h"

namespace pliant {

template <class V, class S>
void describe_gravity(V&& v, S&& s) {
  v(s.gravity, required({"acceleration", any, "m/s^2", "[0, -9.81, 0]", "the acceleration at factor 1"}));
}

template <class V, class S>
void describe_curve(V&& v, S&& s) {
  v(s.kind, curve_words(),
    {"curve", any, "", "\"smooth\"", "`constant`: 0 before `start`, then 1; `ramp`: linear; `smooth`: 10 s^3 - 15 s^4 + 6 s^5",
     "`constant` (`table` when there is a table)"});
  v(s.start, {"start", any, "s", "0.2", "time at which the curve begins; not with a table"});
  v(s.duration, {"duration", above(0).absent_at(0), "s", "0.5",
                 "length of the curve, required with `ramp` and `smooth`, refused otherwise"});
}

/// Of fixed nodes and of rotations.
template <class V, class S>
void describe_axes(V&& v, S&& s) {
  v(s.axes,
    {"axes", any, "", "\"yz\"", "axes that are held; in `prescribed` with `rotate`: those that it prescribes", "`\"xyz\"`"});
}

template <class V, class S>
void describe_rotation(V&& v, S&& s) {
  v(s.axis, required({"axis", any, "", "[0, 0, 1]", "the direction of the axis, not zero"}));
  v(s.about, {"about", any, "m", "[0, 0.1, 0]", "a point on the axis"});
  v(s.angle, required({"angle", any, "degrees", "360", "the angle at factor 1"}));
}

/// Of motion at the start.
template <class V, class S>
void describe_field(V&& v, S&& s) {
  v(s.linear, required({"linear", any, "1/s, or 1", "[[0, -5, 0], [5, 0, 0], [0, 0, 0]]", "the matrix of the field"}));
  v(s.about, {"about", any, "m", "[0, 0.1, 0]", "where the field is its offset"});
  v(s.offset, {"offset", any, "m/s, or m", "[0, 0, 0.2]", "added everywhere"});
}

template <class V, class S>
void describe_force(V&& v, S&& s) {
  v(s.force,
    required({"force", any, "N", "[0, 0, 0.02]",
              "the total force at factor 1, shared by the nodes: in a lattice by their mass, in a mesh equally; nodes that "
              "a tear made of one share its part by mass"}));
}

template <class V, class S>
void describe_pressure(V&& v, S&& s) {
  v(s.pressure, required({"pressure", any, "Pa", "400",
                          "the pressure at factor 1; positive pushes along the inward normal of the deformed surface"}));
}

/// Of a change while the scene runs, without the changed parameters.
struct ChangePlace {
  double time = 0;
  std::string body{};
  std::optional<std::int64_t> inclusion{};
};
template <class V, class S>
void describe_change(V&& v, S&& s) {
  v(s.time, required({"time", at_least(0), "s", "0.5", "when it happens; times do not descend"}));
  v(s.body, {"body", any.absent_at(0), "", "\"liver\"", "the body that `material`, `model` and `fixed` belong to",
             "the only body of the scene"});
  v(s.inclusion,
    {"inclusion", from_to(0, 1e6), "", "0", "the `material` is that of this entry of `inclusions`", "that of the body"});
}

/// Of a probe that is no selection of nodes.
template <class V, class S>
void describe_place(V&& v, S&& s) {
  v(s.point, {"point", any, "m", "[0, 0.05, 0]", "at rest: the material there; or else a [selection](#selections)"});
}

template <class V, class S>
void describe_pace(V&& v, S&& s) {
  v(s.every_steps, required({"steps", from_to(1, 1e12), "", "10", "number of steps between two rows"}));
}

}  // namespace pliant
