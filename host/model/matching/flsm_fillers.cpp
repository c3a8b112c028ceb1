// Fillers: empty grid points that the ordered sums of shape matching may cross.
#include <algorithm>
#include <cstdlib>

#include "model/matching/flsm_regions.h"

namespace pliant {
namespace {

// Creates paths across empty grid points.
class FillerPaths {
 public:
  using Point = std::array<std::int32_t, 3>;

  explicit FillerPaths(LinkedLattice& lattice) : lattice_(lattice), low_(lattice.index[0]) {
    Point high = low_;
    for (const Point& p : lattice.index) {
      for (int a = 0; a < 3; ++a) {
        low_[a] = std::min(low_[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    }
    for (int a = 0; a < 3; ++a) size_[a] = high[a] - low_[a] + 1;
    at_.assign(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]), kEmpty);
    uses_.assign(at_.size(), 0);
    for (std::size_t n = 0; n < lattice.index.size(); ++n) {
      std::int32_t& here = at(lattice.index[n]);
      here = here == kEmpty ? static_cast<std::int32_t>(n) : kShared;
    }
  }

  // Counts the paths that would cross each empty grid point.
  void survey(std::int32_t node, const Point& offset) {
    for_empty(node, offset, [&](std::uint16_t& uses) {
      if (uses < kMost) ++uses;
    });
  }

  // Creates the path from `node` along z, y, x to the grid point at `offset`. Ends early at a cut or at a point that several
  // nodes share. Skips paths across a point that few others cross; the entry then stays in the correction list.
  void open(std::int32_t node, const Point& offset) {
    bool pays = true;
    for_empty(node, offset, [&](std::uint16_t uses) { pays = pays && uses >= kLeastUses; });
    if (!pays) return;
    for (const int axis : {2, 1, 0}) {
      for (int k = 0; k < std::abs(offset[axis]) && node >= 0; ++k) node = next(node, 2 * axis + (offset[axis] > 0 ? 1 : 0));
    }
  }

 private:
  static constexpr std::int32_t kEmpty = -1, kShared = -2;
  // A filler takes part in four passes of sums; an entry of the list costs about a tenth of that.
  static constexpr std::uint16_t kLeastUses = 10, kMost = 60000;

  [[nodiscard]] std::size_t place(const Point& p) const {
    return static_cast<std::size_t>(p[0] - low_[0] + size_[0] * (p[1] - low_[1] + size_[1] * (p[2] - low_[2])));
  }
  std::int32_t& at(const Point& p) { return at_[place(p)]; }

  // Visits the empty grid points on the path z, y, x.
  template <class Work>
  void for_empty(std::int32_t node, const Point& offset, const Work& work) {
    Point p = lattice_.index[node];
    for (const int axis : {2, 1, 0}) {
      for (int k = 0; k < std::abs(offset[axis]); ++k) {
        p[axis] += offset[axis] > 0 ? 1 : -1;
        const std::int32_t there = at(p);
        if (there == kEmpty || (there >= 0 && filler(there))) work(uses_[place(p)]);
      }
    }
  }

  [[nodiscard]] bool filler(std::int32_t n) const { return n >= lattice_.nodes(); }

  std::int32_t next(std::int32_t n, int d) {
    if (lattice_.link[n][d] >= 0) return lattice_.link[n][d];
    Point p = lattice_.index[n];
    p[d / 2] += (d & 1) != 0 ? 1 : -1;
    std::int32_t& there = at(p);
    if (there == kShared || (there >= 0 && !filler(there) && !filler(n))) return -1;
    if (there == kEmpty) {
      there = static_cast<std::int32_t>(lattice_.index.size());
      lattice_.index.push_back(p);
      lattice_.link.push_back({-1, -1, -1, -1, -1, -1});
      ++lattice_.fillers;
    }
    if (lattice_.link[there][d ^ 1] >= 0) return -1;  // it belongs to another node at the grid point of n
    lattice_.link[there][d ^ 1] = n;
    lattice_.link[n][d] = there;
    return there;
  }

  LinkedLattice& lattice_;
  Point low_;
  std::array<std::int64_t, 3> size_{};
  std::vector<std::int32_t> at_;     // per grid point of the bounding box: a node, a filler, or one of the above
  std::vector<std::uint16_t> uses_;  // per grid point: paths that would cross it
};

}  // namespace

void add_fillers(LinkedLattice& lattice, const FlsmRegions& regions) {
  if (regions.missing.empty()) return;
  const auto for_entries = [&](const auto& work) {
    for (std::int32_t r = 0; r < static_cast<std::int32_t>(regions.size.size()); ++r) {
      for (std::int32_t m = regions.missing_offset[r]; m < regions.missing_offset[r + 1]; ++m)
        work(r, regions.missing[m].offset);
    }
  };
  FillerPaths paths(lattice);
  for_entries([&](std::int32_t r, const auto& offset) { paths.survey(r, offset); });
  for_entries([&](std::int32_t r, const auto& offset) { paths.open(r, offset); });
}

}  // namespace pliant
