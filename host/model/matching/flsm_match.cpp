// Finds the equal parts of two shape-matching lattices: most regions do not change in a cut.
#include <algorithm>

#include "model/matching/flsm_regions.h"

namespace pliant {
namespace {

using Point = std::array<std::int32_t, 3>;

/// The grid points of two lattices' common bounding box.
class GridPoints {
 public:
  GridPoints(const LinkedLattice& a, const LinkedLattice& b) {
    Point high{};
    bool first = true;
    for (const auto* lattice : {&a, &b}) {
      for (const Point& p : lattice->index) {
        for (int c = 0; c < 3; ++c) {
          low_[c] = first ? p[c] : std::min(low_[c], p[c]);
          high[c] = first ? p[c] : std::max(high[c], p[c]);
        }
        first = false;
      }
    }
    for (int c = 0; c < 3; ++c) size_[c] = high[c] - low_[c] + 1;
  }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(size_[0] * size_[1] * size_[2]); }
  [[nodiscard]] std::size_t operator()(const Point& p) const {
    return static_cast<std::size_t>(p[0] - low_[0] + size_[0] * (p[1] - low_[1] + size_[1] * (p[2] - low_[2])));
  }

  /// Extends the marks by `width` along each axis.
  void spread(std::vector<char>& marks, int width) const {
    std::int64_t step = 1;
    for (int c = 0; c < 3; step *= size_[c], ++c) {
      std::vector<char> out = marks;
      for (std::int64_t i = 0; i < static_cast<std::int64_t>(marks.size()); ++i) {
        if (marks[static_cast<std::size_t>(i)] == 0) continue;
        const std::int64_t at = i / step % size_[c], first = std::max<std::int64_t>(0, at - width),
                           last = std::min(size_[c] - 1, at + width);
        for (std::int64_t k = first; k <= last; ++k) out[static_cast<std::size_t>(i + (k - at) * step)] = 1;
      }
      marks.swap(out);
    }
  }

 private:
  Point low_{};
  std::array<std::int64_t, 3> size_{};
};

/// The nodes at each grid point as an ascending chain: the first node, and the successor of each.
struct Chains {
  std::vector<std::int32_t> first, next;
  Chains(const LinkedLattice& lattice, const GridPoints& grid) : first(grid.count(), -1), next(lattice.index.size(), -1) {
    for (auto n = static_cast<std::int32_t>(lattice.index.size()) - 1; n >= 0; --n) {
      std::int32_t& head = first[grid(lattice.index[static_cast<std::size_t>(n)])];
      next[static_cast<std::size_t>(n)] = head;
      head = n;
    }
  }
};

}  // namespace

LatticeMatch match_lattices(const LinkedLattice& now, const LinkedLattice& before, int width) {
  LatticeMatch match;
  match.before.assign(now.index.size(), -1);
  match.now.assign(before.index.size(), -1);
  match.same.assign(static_cast<std::size_t>(now.nodes()), 0);
  if (now.index.empty() || before.index.empty()) return match;
  const GridPoints grid(now, before);
  const Chains a(now, grid), b(before, grid);
  std::vector<char> differs(grid.count(), 0);
  for (std::size_t p = 0; p < differs.size(); ++p) {
    std::int32_t i = a.first[p], j = b.first[p];
    for (; i >= 0 && j >= 0 && (i < now.nodes()) == (j < before.nodes()); i = a.next[i], j = b.next[j]) {
      match.before[i] = j;
      match.now[j] = i;
    }
    if (i >= 0 || j >= 0) differs[p] = 1;
  }
  for (std::size_t i = 0; i < now.index.size(); ++i) {
    const std::int32_t j = match.before[i];
    if (j < 0) continue;
    for (int d = 0; d < 6; ++d) {
      const std::int32_t to = now.link[i][d], was = before.link[j][d];
      if (to < 0 ? was >= 0 : match.before[to] != was) differs[grid(now.index[i])] = 1;
    }
  }
  for (const auto* lattice : {&now, &before}) {
    for (const Branch& branch : lattice->branches) {
      differs[grid(lattice->index[branch.low])] = differs[grid(lattice->index[branch.high])] = 1;
    }
  }
  grid.spread(differs, width);
  for (std::size_t i = 0; i < match.same.size(); ++i) {
    match.same[i] = static_cast<char>(match.before[i] >= 0 && differs[grid(now.index[i])] == 0);
  }
  return match;
}

}  // namespace pliant
