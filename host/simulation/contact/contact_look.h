// The part of RunState that decides when the next broad-phase search of contact is due (contact_lists.h).
#pragma once
#include <cstdint>
#include <vector>

namespace pliant {

/// Steps of the last broad-phase searches, and how far things may move until the next.
struct ContactLook {
  std::int64_t tools = -1, tissue = -1;  ///< steps of the last searches; -1: due now
  std::vector<double> room;              ///< per tool: distance it may approach until the next search [m]
  std::vector<double> travel;            ///< upper bound of its motion relative to the tissue since the last search [m]
  double tissue_travel = 0;              ///< the same for tissue against tissue [m]
};

template <class V>
void visit(V& v, ContactLook& s) {
  v("tools", s.tools), v("tissue", s.tissue), v("room", s.room), v("travel", s.travel);
  v("tissue_travel", s.tissue_travel);
}

}  // namespace pliant
