// The part of RunState that says when it must be asked again what is near what (contact_lists.h).
#pragma once
#include <cstdint>
#include <vector>

namespace pliant {

/// When it was last asked what is near what in contact, and how far things may move until it must be asked again.
struct ContactLook {
  std::int64_t tools = -1, tissue = -1;  ///< steps of the last looks; -1: one is due
  std::vector<double> room;              ///< per tool: how far it may come nearer until the next look [m]
  std::vector<double> travel;            ///< how far it has since the last one, at most [m]
  double tissue_travel = 0;              ///< the same of tissue [m]
};

template <class V>
void visit(V& v, ContactLook& s) {
  v("tools", s.tools), v("tissue", s.tissue), v("room", s.room), v("travel", s.travel);
  v("tissue_travel", s.tissue_travel);
}

}  // namespace pliant
