// Cuthill-McKee numbering of a body's nodes.
#include <algorithm>
#include <numeric>

#include "model/elements/body_mesh.h"

namespace pliant {
namespace {

/// Elements at each node, and nodes of each element, as one list of corners.
class Incidence {
 public:
  explicit Incidence(const BodyElements& solid) : width_(solid.tets.empty() ? 8 : 4), nodes_(solid.nodes.size()) {
    for (const auto& tet : solid.tets) corners_.insert(corners_.end(), tet.begin(), tet.end());
    for (const auto& hex : solid.hexes) corners_.insert(corners_.end(), hex.begin(), hex.end());
    offset_.assign(nodes_ + 1, 0);
    for (const std::int32_t n : corners_) ++offset_[n + 1];
    std::partial_sum(offset_.begin(), offset_.end(), offset_.begin());
    element_.resize(corners_.size());
    std::vector<std::int64_t> next(offset_.begin(), offset_.end() - 1);
    for (std::size_t c = 0; c < corners_.size(); ++c) element_[next[corners_[c]]++] = static_cast<std::int32_t>(c / width_);
  }
  [[nodiscard]] std::size_t nodes() const { return nodes_; }
  template <class Visit>
  void neighbors(std::int32_t node, Visit&& visit) const {
    for (std::int64_t i = offset_[node]; i < offset_[node + 1]; ++i) {
      const std::size_t first = width_ * static_cast<std::size_t>(element_[i]);
      for (std::size_t c = first; c < first + width_; ++c) visit(corners_[c]);
    }
  }

 private:
  std::size_t width_, nodes_;
  std::vector<std::int32_t> corners_, element_;
  std::vector<std::int64_t> offset_;
};

/// Breadth first from `start` over nodes whose mark differs from `mark`; appends them to `order`.
void breadth_first(const Incidence& incidence, std::int32_t start, std::int32_t mark, std::vector<std::int32_t>& marks,
                   std::vector<std::int32_t>& order) {
  std::size_t head = order.size();
  marks[start] = mark;
  order.push_back(start);
  while (head < order.size()) {
    incidence.neighbors(order[head++], [&](std::int32_t n) {
      if (marks[n] == mark) return;
      marks[n] = mark;
      order.push_back(n);
    });
  }
}

}  // namespace

std::vector<std::int32_t> sweep_order(const BodyElements& solid) {
  const Incidence incidence(solid);
  std::vector<std::int32_t> order, scout, marks(incidence.nodes(), 0);
  order.reserve(incidence.nodes());
  for (std::size_t n = 0; n < incidence.nodes(); ++n) {
    if (marks[n] == 2) continue;
    // The node reached last from any start lies at an end of the part: a sweep from there has a small front.
    scout.clear();
    breadth_first(incidence, static_cast<std::int32_t>(n), 1, marks, scout);
    breadth_first(incidence, scout.back(), 2, marks, order);
  }
  return order;
}

NodeOrder node_order(const BodyElements& solid) {
  NodeOrder out{sweep_order(solid), std::vector<std::int32_t>(solid.nodes.size(), 0)};
  for (const auto& tet : solid.tets) {
    for (const std::int32_t n : tet) ++out.valence[n];
  }
  for (const auto& hex : solid.hexes) {
    for (const std::int32_t n : hex) ++out.valence[n];
  }
  return out;
}

}  // namespace pliant
