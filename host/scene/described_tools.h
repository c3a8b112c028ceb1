// The described keys of tools and contact (described.h).
#pragma once
#include "scene/described.h"

namespace pliant {

/// Of a tool, and of tissue on tissue.
template <class V, class S>
void describe_friction(V&& v, S&& s) {
  v(s.friction, {"friction", at_least(0), "", "0.3", "Coulomb's coefficient"});
}

/// The law of Hunt and Crossley.
template <class V, class S>
void describe_contact_law(V&& v, S&& s) {
  v(s.stiffness,
    {"stiffness", above(0).or_word("auto").absent_at(0), "Pa/m^exponent", "1e6",
     "`\"auto\"`: hard at once, without a number from you; a number is lambda of the law of Hunt and Crossley, per "
     "area, to a depth of a quarter of a cell, from where it is hard"});
  v(s.exponent, {"exponent", from_to(1, 1).or_number(1.5).absent_at(1), "", "1.5",
                 "power of the depth; only with a stiffness that is a number"});
  v(s.alpha, {"alpha", at_least(0).absent_at(0), "s/m", "0.5",
              "slope of the coefficient of restitution, which is 1 - alpha v at small speeds v; only with a stiffness that is "
              "a number"});
}

template <class V, class S>
void describe_tool(V&& v, S&& s) {
  describe_friction(v, s);
  v(s.edges, {"edges", any, "", "true",
              "`true`, of a sphere, capsule, box or mesh: where it is thinner than half a cell it is met along its edges "
              "instead of passing between points of contact ([contact](contact.md#thin-tools))"});
  v(s.scale, {"scale", above(0).absent_at(1), "", "0.001", "factor on the coordinates of a mesh or a sequence"});
  v(s.frames_per_second, {"frames_per_second", above(0).absent_at(30), "1/s", "25",
                          "rate of a sequence, whose first mesh stands at time 0 and whose last one stays"});
}

/// Of a tool that can hold tissue.
template <class V, class S>
void describe_grip(V&& v, S&& s) {
  v(s.strength, {"strength", above(0).absent_at(0), "Pa", "20000",
                 "traction at which a point of the surface slips out: along the tool or away from it; none: none does"});
}

}  // namespace pliant
