#include "model/pieces.h"

#include <map>

#include "geometry/disjoint_sets.h"

namespace pliant {

std::int64_t pieces_of(const ModelBody& body, std::vector<std::int32_t>* piece) {
  DisjointSets sets(body.rest.size());
  const auto join = [&](const auto& elements) {
    for (const auto& nodes : elements) {
      for (std::size_t a = 1; a < nodes.size(); ++a) sets.join(nodes[0], nodes[a]);
    }
  };
  join(body.tets);
  join(body.hexes);
  std::map<std::int64_t, std::int32_t> number;
  const auto count = [&](const auto& elements) {
    for (const auto& nodes : elements) {
      const auto found = number.try_emplace(sets.find(nodes[0]), static_cast<std::int32_t>(number.size())).first;
      if (piece != nullptr) piece->push_back(found->second);
    }
  };
  if (piece != nullptr) piece->clear();
  count(body.tets);
  count(body.hexes);
  return static_cast<std::int64_t>(number.size());
}

std::vector<std::int32_t> pieces_of_slots(const ModelBody& body, std::int32_t slots) {
  std::vector<std::int32_t> piece, out(static_cast<std::size_t>(slots), -1);
  static_cast<void>(pieces_of(body, &piece));
  std::size_t e = 0;
  const auto mark = [&](const auto& elements) {
    for (const auto& nodes : elements) {
      for (const std::int32_t n : nodes) out[static_cast<std::size_t>(body.slot[static_cast<std::size_t>(n)])] = piece[e];
      ++e;
    }
  };
  mark(body.tets);
  mark(body.hexes);
  return out;
}

}  // namespace pliant
