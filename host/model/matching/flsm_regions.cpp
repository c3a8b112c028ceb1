// Finds regions by three integer passes along links, and by a search where those passes may be incomplete.
#include "model/matching/flsm_regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "geometry/parallel.h"
#include "pliant/error.h"

namespace pliant {
namespace {

constexpr int kMostWidth = 5;
constexpr std::int64_t kBlock = 512;  // nodes per block of a thread

// Calls work(first, last) for blocks of [0, count).
template <class Work>
void for_blocks(std::int64_t count, const Work& work) {
  parallel_for((count + kBlock - 1) / kBlock, [&](std::int64_t b) { work(b * kBlock, std::min(count, (b + 1) * kBlock)); });
}

void check_width(int width) {
  if (width < 1 || width > kMostWidth) {
    throw Error(ErrorCode::bad_input,
                fmt::format("the half-width of the regions is {}; allowed are 1 to {}", width, kMostWidth));
  }
}

// Precondition: a link leads to the next grid point along its axis, and back.
void check_links(const LinkedLattice& lattice) {
  const auto nodes = static_cast<std::int64_t>(lattice.index.size());
  if (lattice.link.size() != lattice.index.size() || nodes > std::numeric_limits<std::int32_t>::max()) {
    throw Error(ErrorCode::internal, "the lattice of the regions has not one set of links per node, or too many nodes");
  }
  for_blocks(nodes, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) {
      for (int d = 0; d < 6; ++d) {
        const std::int32_t n = lattice.link[i][d];
        if (n == -1) continue;
        auto expected = lattice.index[i];
        expected[d / 2] += (d & 1) != 0 ? 1 : -1;
        if (n < 0 || n >= nodes || lattice.index[n] != expected || lattice.link[n][d ^ 1] != i) {
          throw Error(ErrorCode::internal, fmt::format("link {} of node {} leads to {}, which is not its neighbour", d, i, n));
        }
      }
    }
  });
}

// A flagged node shares its grid point with another one. The sums hold the number of nodes in the low half and of flagged
// nodes in the high half; both stay below (2 * 5 + 1)^3 = 1331.
constexpr std::uint32_t kFlag = 1U << 16, kCount = kFlag - 1;

// 1 for each node, 0 for each filler, and the flag for those that share their grid point.
std::vector<std::uint32_t> ones_and_flags(const LinkedLattice& lattice) {
  const auto nodes = static_cast<std::int32_t>(lattice.index.size());
  const auto key = [&](std::int32_t i) {
    const auto& p = lattice.index[i];
    return std::array{p[2], p[1], p[0]};
  };
  const auto before = [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); };
  std::vector<std::int32_t> order(nodes);
  std::iota(order.begin(), order.end(), 0);
  if (!std::is_sorted(order.begin(), order.end(), before)) std::sort(order.begin(), order.end(), before);
  std::vector<std::uint32_t> ones(nodes, 1);
  std::fill(ones.end() - lattice.fillers, ones.end(), 0);
  for (std::int32_t n = 1; n < nodes; ++n) {
    if (key(order[n - 1]) == key(order[n])) ones[order[n - 1]] = ones[order[n]] = 1 + kFlag;
  }
  return ones;
}

// The sum of `in` over the bar of each node: itself and up to `width` links to both sides along `axis`.
std::vector<std::uint32_t> bar_sums(const LinkedLattice& lattice, const std::vector<std::uint32_t>& in, int axis, int width) {
  std::vector<std::uint32_t> out(in.size());
  for_blocks(static_cast<std::int64_t>(in.size()), [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) {
      std::uint32_t sum = in[i];
      for (int d = 2 * axis; d < 2 * axis + 2; ++d) {
        std::int32_t n = lattice.link[i][d];
        for (int k = 0; k < width && n >= 0; ++k, n = lattice.link[n][d]) sum += in[n];
      }
      out[i] = sum;
    }
  });
  return out;
}

std::vector<std::uint32_t> ordered_sums(const LinkedLattice& lattice, const std::vector<std::uint32_t>& in, int width,
                                        const std::array<int, 3>& axes) {
  auto sums = bar_sums(lattice, in, axes[0], width);
  for (int a = 1; a < 3; ++a) sums = bar_sums(lattice, sums, axes[a], width);
  return sums;
}

// Searches one region at a time. A position is a place in the window, which has a border of one place; each holds a chain of
// the nodes visited there, with several nodes only if they share a grid point.
class RegionSearch {
 public:
  RegionSearch(const LinkedLattice& lattice, int width, bool shared_points)
      : lattice_(lattice), width_(width), shared_points_(shared_points) {
    const int edge = 2 * width + 3;
    for (int p = 0; p < edge * edge * edge; ++p) {
      const std::array<int, 3> offset{p % edge - width - 1, p / edge % edge - width - 1, p / (edge * edge) - width - 1};
      const bool inside = std::max({std::abs(offset[0]), std::abs(offset[1]), std::abs(offset[2])}) <= width;
      at_.push_back(inside ? kFree : kOutside);
      offset_.push_back(offset);
    }
    for (int a = 0, step = 1; a < 3; ++a, step *= edge) {
      step_[2 * a] = -step;
      step_[2 * a + 1] = step;
    }
    centre_ = step_[1] * (width + 1) + step_[3] * (width + 1) + step_[5] * (width + 1);
    for (const Branch& b : lattice.branches) {
      branch_.emplace(b.low, std::pair{2 * b.axis + 1, b.high});
      branch_.emplace(b.high, std::pair{2 * b.axis, b.low});
    }
  }

  // Finds the region of `centre`, appends the nodes that the ordered sums miss or include wrongly to `missing` and returns
  // its size. `ordered`: number of nodes in the ordered sums.
  std::int32_t run(std::int32_t centre, std::uint32_t ordered, std::vector<RegionEntry>& missing) {
    found_.clear();
    visit(centre, centre_);
    walk(4);
    walk(2);
    walk(0);
    const std::size_t walked = found_.size();
    const auto counted = std::count_if(found_.begin(), found_.end(), [&](const Found& f) { return f.node < lattice_.nodes(); });
    if (counted != static_cast<std::ptrdiff_t>(ordered)) {
      throw Error(ErrorCode::internal,
                  fmt::format("the sums of region {} count {} nodes, its bars hold {}", centre, ordered, counted));
    }
    reached_.assign(1, 0);
    found_[0].reached = true;
    for (std::size_t r = 0; r < reached_.size(); ++r) spread(reached_[r]);
    const auto begin = static_cast<std::ptrdiff_t>(missing.size());
    for (std::size_t f = 0; f < found_.size(); ++f) {
      if (found_[f].reached == (f < walked) || found_[f].node >= lattice_.nodes()) continue;
      const auto& offset = offset_[found_[f].position];
      missing.push_back({found_[f].node, {offset[0], offset[1], offset[2]}, f < walked ? -1 : 1});
    }
    std::sort(missing.begin() + begin, missing.end(), [](const auto& a, const auto& b) { return a.other < b.other; });
    for (const Found& f : found_) at_[f.position] = kFree;
    return static_cast<std::int32_t>(reached_.size());
  }

 private:
  struct Found {
    std::int32_t node, position, next;  // next: another node found at this position, or -1
    bool reached;                       // through links between nodes
  };
  static constexpr std::int32_t kFree = -1, kOutside = -2;

  void visit(std::int32_t node, std::int32_t position) {
    const auto number = static_cast<std::int32_t>(found_.size());
    found_.push_back({node, position, at_[position], false});
    at_[position] = number;
  }

  // Visits the bars along one axis through all nodes found so far, of which no two are on one bar.
  void walk(int axis) {
    const std::size_t count = found_.size();
    for (std::size_t f = 0; f < count; ++f) {
      for (int d = axis; d < axis + 2; ++d) {
        std::int32_t n = lattice_.link[found_[f].node][d], position = found_[f].position + step_[d];
        for (int k = 0; k < width_ && n >= 0; ++k, n = lattice_.link[n][d], position += step_[d]) visit(n, position);
      }
    }
  }

  void spread(std::int32_t from) {
    const Found here = found_[from];
    const auto& links = lattice_.link[here.node];
    for (int d = 0; d < 6; ++d) {
      const std::int32_t position = here.position + step_[d], there = at_[position];
      if (there == kOutside || (there >= 0 && !shared_points_ && found_[there].reached)) continue;
      if (links[d] >= 0 && links[d] < lattice_.nodes()) reach(links[d], position);
    }
    const auto [first, last] = branch_.equal_range(here.node);
    for (auto b = first; b != last; ++b) {
      const auto& [d, n] = b->second;
      if (at_[here.position + step_[d]] != kOutside) reach(n, here.position + step_[d]);
    }
  }

  void reach(std::int32_t node, std::int32_t position) {
    std::int32_t f = at_[position];
    while (f >= 0 && found_[f].node != node) f = found_[f].next;
    if (f < 0) {
      f = static_cast<std::int32_t>(found_.size());
      visit(node, position);
    }
    if (found_[f].reached) return;
    found_[f].reached = true;
    reached_.push_back(f);
  }

  const LinkedLattice& lattice_;
  const int width_;
  const bool shared_points_;
  std::array<std::int32_t, 6> step_{};  // position offset of each link direction
  std::int32_t centre_ = 0;
  std::multimap<std::int32_t, std::pair<int, std::int32_t>> branch_;  // of a node: direction and other end
  std::vector<std::int32_t> at_;            // per position: the node found last, as an index into found_
  std::vector<std::array<int, 3>> offset_;  // per position
  std::vector<Found> found_;
  std::vector<std::int32_t> reached_;  // the nodes of the region, as indices into found_
};

// Copies the corrections of a known region, with the current node numbers.
std::int32_t take_over(const FlsmRegions& known, std::int32_t region, const std::vector<std::int32_t>& now,
                       std::vector<RegionEntry>& missing) {
  const auto begin = static_cast<std::ptrdiff_t>(missing.size());
  for (std::int32_t m = known.missing_offset[region]; m < known.missing_offset[region + 1]; ++m) {
    RegionEntry entry = known.missing[m];
    entry.other = now[entry.other];
    missing.push_back(entry);
  }
  const auto ascends = [](const auto& a, const auto& b) { return a.other < b.other; };
  if (!std::is_sorted(missing.begin() + begin, missing.end(), ascends)) {
    std::sort(missing.begin() + begin, missing.end(), ascends);
  }
  return known.size[region];
}

// Fills size, missing_offset and missing. `sums`: the ordered sums with x first.
void find_missing(const LinkedLattice& lattice, const std::vector<std::uint32_t>& sums, bool shared_points,
                  const KnownRegions* before, FlsmRegions& regions) {
  const std::int64_t nodes = lattice.nodes();
  const std::uint32_t edge = 2 * regions.width + 1, whole = edge * edge * edge;
  std::vector<std::vector<RegionEntry>> found((nodes + kBlock - 1) / kBlock);
  std::vector<std::int64_t> counts(nodes + 1, 0);
  LatticeMatch match;
  if (before != nullptr) match = match_lattices(lattice, before->lattice, regions.width);
  for_blocks(nodes, [&](std::int64_t first, std::int64_t last) {
    RegionSearch search(lattice, regions.width, shared_points);
    auto& list = found[first / kBlock];
    for (std::int64_t i = first; i < last; ++i) {
      // Sums over a full window miss nothing, unless a grid point in it has a further node.
      if (sums[i] == whole) {
        regions.size[i] = static_cast<std::int32_t>(whole);
        continue;
      }
      const std::size_t so_far = list.size();
      regions.size[i] = before != nullptr && match.same[i] != 0
                            ? take_over(before->regions, match.before[i], match.now, list)
                            : search.run(static_cast<std::int32_t>(i), sums[i] & kCount, list);
      counts[i + 1] = static_cast<std::int64_t>(list.size() - so_far);
    }
  });
  std::partial_sum(counts.begin(), counts.end(), counts.begin());
  if (counts[nodes] > std::numeric_limits<std::int32_t>::max()) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("regions of half-width {} need {} corrections, more than fit: use a smaller half-width or fewer nodes",
                    regions.width, counts[nodes]));
  }
  regions.missing_offset.assign(counts.begin(), counts.end());
  regions.missing.resize(counts[nodes]);
  parallel_for(static_cast<std::int64_t>(found.size()), [&](std::int64_t b) {
    std::copy(found[b].begin(), found[b].end(), regions.missing.begin() + regions.missing_offset[b * kBlock]);
    std::vector<RegionEntry>().swap(found[b]);
  });
}

// Fills missing_of_offset and missing_of from missing.
void transpose(FlsmRegions& regions) {
  const std::size_t nodes = regions.size.size();
  auto& begin = regions.missing_of_offset;
  begin.assign(nodes + 1, 0);
  for (const RegionEntry& e : regions.missing) ++begin[e.other + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  regions.missing_of.resize(regions.missing.size());
  std::vector<std::int32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t r = 0; r < nodes; ++r) {
    for (std::int32_t m = regions.missing_offset[r]; m < regions.missing_offset[r + 1]; ++m) {
      const RegionEntry& e = regions.missing[m];
      regions.missing_of[next[e.other]++] = {static_cast<std::int32_t>(r), e.offset, e.sign};
    }
  }
}

}  // namespace

FlsmRegions find_regions(const LinkedLattice& lattice, int width, const KnownRegions* before) {
  check_width(width);
  check_links(lattice);
  const auto nodes = static_cast<std::size_t>(lattice.nodes());
  FlsmRegions regions;
  regions.width = width;
  regions.size.resize(nodes);
  auto ones = ones_and_flags(lattice);
  const bool shared_points = std::any_of(ones.begin(), ones.end(), [](std::uint32_t one) { return one != 1; });
  find_missing(lattice, ordered_sums(lattice, ones, width, {0, 1, 2}), shared_points, before, regions);
  transpose(regions);
  // From a node back to the centres whose paths z, y, x reach it: the same links in reverse.
  const auto back = ordered_sums(lattice, ones, width, {2, 1, 0});
  regions.holders.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    regions.holders[i] = static_cast<std::int32_t>(back[i] & kCount);
    for (std::int32_t m = regions.missing_of_offset[i]; m < regions.missing_of_offset[i + 1]; ++m) {
      regions.holders[i] += regions.missing_of[m].sign;
    }
  }
  return regions;
}

}  // namespace pliant
