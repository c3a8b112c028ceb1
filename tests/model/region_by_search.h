// The definition of a shape-matching region, as find_regions is tested against it.
#pragma once
#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <vector>

#include "model/matching/flsm_regions.h"

namespace pliant {

/// The nodes of one region by breadth-first search, with their offsets, ascending by node.
inline std::vector<RegionEntry> region_by_search(const LinkedLattice& lattice, std::int32_t centre, int width) {
  std::map<std::int32_t, std::array<std::int32_t, 3>> region{{centre, {0, 0, 0}}};
  std::set<std::int32_t> front{centre};
  while (!front.empty()) {
    const std::int32_t i = *front.begin();
    front.erase(front.begin());
    std::vector<std::int32_t> next(lattice.link[i].begin(), lattice.link[i].end());
    for (const Branch& b : lattice.branches) {
      if (b.low == i || b.high == i) next.push_back(b.low == i ? b.high : b.low);
    }
    for (const std::int32_t n : next) {
      if (n < 0 || region.contains(n)) continue;
      std::array<std::int32_t, 3> offset{};
      for (int a = 0; a < 3; ++a) offset[a] = lattice.index[n][a] - lattice.index[centre][a];
      if (std::max({std::abs(offset[0]), std::abs(offset[1]), std::abs(offset[2])}) > width) continue;
      region.emplace(n, offset);
      front.insert(n);
    }
  }
  std::vector<RegionEntry> list;
  for (const auto& [node, offset] : region) list.push_back({node, offset});
  return list;
}

}  // namespace pliant
