// The linear tetrahedron with averaged nodal pressure (Bonet and Burton 1998), which does not lock when nearly incompressible.
#pragma once
#include "elements/element_tet4.h"

namespace pliant {

struct Tet4Anp : Tet4 {
  static constexpr ElementInfo info = [] {
    ElementInfo out = Tet4::info;
    out.word = "tet4anp";
    out.what = "the same with averaged nodal pressure, which does not lock when nearly incompressible";
    out.averaged = true;
    out.statics = false;
    out.trial = 2;
    return out;
  }();
  static ElementCost cost(double law, bool uniform) {
    ElementCost out = Tet4::cost(law, uniform);
    out.texels = 1.25;
    return out;
  }
};

}  // namespace pliant
