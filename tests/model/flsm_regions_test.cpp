#include "model/flsm_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "support/error_of.h"

namespace pliant {
namespace {

using Index = std::array<std::int32_t, 3>;
using test::error_of;

void join(LinkedLattice& lattice, std::int32_t from, std::int32_t to, int axis) {
  lattice.link[from][2 * axis + 1] = to;
  lattice.link[to][2 * axis] = from;
}

void unlink(LinkedLattice& lattice, std::int32_t node, int side) {
  const std::int32_t n = lattice.link[node][side];
  if (n >= 0) lattice.link[n][side ^ 1] = -1;
  lattice.link[node][side] = -1;
}

// The grid points of [0, size) that `inside` chooses, linked to their neighbours.
template <class Inside>
LinkedLattice shape(const Index& size, const Inside& inside) {
  LinkedLattice lattice;
  std::map<Index, std::int32_t> at;
  for (std::int32_t k = 0; k < size[2]; ++k) {
    for (std::int32_t j = 0; j < size[1]; ++j) {
      for (std::int32_t i = 0; i < size[0]; ++i) {
        if (!inside(i, j, k)) continue;
        at[{i, j, k}] = static_cast<std::int32_t>(lattice.index.size());
        lattice.index.push_back({i, j, k});
      }
    }
  }
  lattice.link.assign(lattice.index.size(), {-1, -1, -1, -1, -1, -1});
  for (const auto& [p, n] : at) {
    for (int a = 0; a < 3; ++a) {
      Index q = p;
      ++q[a];
      if (at.contains(q)) join(lattice, n, at[q], a);
    }
  }
  return lattice;
}

LinkedLattice ball(int radius) {
  const int d = 2 * radius + 1;
  return shape({d, d, d}, [=](int i, int j, int k) {
    const int x = i - radius, y = j - radius, z = k - radius;
    return x * x + y * y + z * z <= radius * radius;
  });
}

LinkedLattice torus() {
  return shape({15, 15, 7}, [](int i, int j, int k) {
    const double ring = std::hypot(i - 7.0, j - 7.0) - 4.6;
    return std::hypot(ring, k - 3.0) < 2.4;
  });
}

LinkedLattice cut_ball() {
  LinkedLattice lattice = ball(6);
  const auto side = [](const Index& p) { return 3 * p[0] + 2 * p[1] + p[2] > 37; };
  for (std::size_t n = 0; n < lattice.index.size(); ++n) {
    const auto i = static_cast<std::int32_t>(n);
    for (int d = 0; d < 6; ++d) {
      const std::int32_t other = lattice.link[i][d];
      // The cut ends inside the ball.
      if (other >= 0 && lattice.index[i][2] > 4 && side(lattice.index[i]) != side(lattice.index[other])) unlink(lattice, i, d);
    }
  }
  return lattice;
}

LinkedLattice torn_ball(double share) {
  LinkedLattice lattice = ball(6);
  std::mt19937 random(7);
  for (std::size_t n = 0; n < lattice.index.size(); ++n) {
    for (int d = 1; d < 6; d += 2) {
      if (static_cast<double>(random()) < share * 4294967296.0) unlink(lattice, static_cast<std::int32_t>(n), d);
    }
  }
  return lattice;
}

// A box whose part x >= 3 exists twice at the same grid points. One sheet hangs on the rest below y = 4, the other above.
LinkedLattice two_sheets() {
  LinkedLattice lattice = shape({7, 8, 5}, [](int, int, int) { return true; });
  std::map<Index, std::int32_t> first, second;
  for (std::size_t n = 0; n < lattice.index.size(); ++n) first[lattice.index[n]] = static_cast<std::int32_t>(n);
  for (const auto& [p, n] : first) {
    if (p[0] < 3) continue;
    second[p] = static_cast<std::int32_t>(lattice.index.size());
    lattice.index.push_back(p);
    lattice.link.push_back({-1, -1, -1, -1, -1, -1});
  }
  for (const auto& [p, n] : second) {
    for (int a = 0; a < 3; ++a) {
      Index q = p;
      ++q[a];
      if (second.contains(q)) join(lattice, n, second[q], a);
    }
    if (p[0] == 3 && p[1] >= 4) {
      unlink(lattice, first[p], 0);
      join(lattice, first[{2, p[1], p[2]}], n, 0);
    }
  }
  return lattice;
}

// The same lattice with its nodes numbered in another order.
LinkedLattice shuffled(const LinkedLattice& lattice) {
  std::vector<std::int32_t> number(lattice.index.size());
  std::iota(number.begin(), number.end(), 0);
  std::mt19937 random(3);
  for (std::size_t n = number.size() - 1; n > 0; --n) std::swap(number[n], number[random() % (n + 1)]);
  LinkedLattice out = lattice;
  for (std::size_t n = 0; n < number.size(); ++n) {
    out.index[number[n]] = lattice.index[n];
    for (int d = 0; d < 6; ++d) out.link[number[n]][d] = lattice.link[n][d] < 0 ? -1 : number[lattice.link[n][d]];
  }
  return out;
}

// The nodes that one reaches from `centre` along z, then y, then x links.
std::set<std::int32_t> ordered_set(const LinkedLattice& lattice, std::int32_t centre, int width) {
  std::vector<std::int32_t> all{centre};
  for (int axis = 2; axis >= 0; --axis) {
    const auto starts = all;
    for (const std::int32_t start : starts) {
      for (const int side : {2 * axis, 2 * axis + 1}) {
        std::int32_t n = start;
        for (int k = 0; k < width; ++k) {
          n = lattice.link[n][side];
          if (n < 0) break;
          all.push_back(n);
        }
      }
    }
  }
  std::set<std::int32_t> set(all.begin(), all.end());
  EXPECT_EQ(set.size(), all.size()) << "a node is reached twice from " << centre;
  return set;
}

bool by_other(const RegionEntry& a, const RegionEntry& b) { return a.other < b.other; }

// Everything that FlsmRegions promises, from the definition. Returns the number of corrections.
std::int64_t check(const LinkedLattice& lattice, int width) {
  const FlsmRegions regions = find_regions(lattice, width);
  const auto nodes = static_cast<std::int32_t>(lattice.index.size());
  EXPECT_EQ(regions.width, width);
  EXPECT_EQ(regions.missing_offset.size(), lattice.index.size() + 1);
  EXPECT_EQ(regions.missing_of_offset.size(), lattice.index.size() + 1);
  std::vector<std::int32_t> holders(nodes, 0);
  std::vector<std::vector<RegionEntry>> transpose(nodes);
  for (std::int32_t r = 0; r < nodes; ++r) {
    const auto region = region_by_search(lattice, r, width);
    const auto ordered = ordered_set(lattice, r, width);
    std::vector<RegionEntry> expected;
    std::size_t shared = 0;
    for (const RegionEntry& e : region) {
      ++holders[e.other];
      shared += ordered.count(e.other);
      if (ordered.contains(e.other)) continue;
      expected.push_back(e);
      transpose[e.other].push_back({r, e.offset});
      for (int a = 0; a < 3; ++a) EXPECT_EQ(e.offset[a], lattice.index[e.other][a] - lattice.index[r][a]);
    }
    EXPECT_EQ(shared, ordered.size()) << "the bars of " << r << " leave its region";
    EXPECT_TRUE(std::is_sorted(region.begin(), region.end(), by_other));
    const std::vector<RegionEntry> listed(regions.missing.begin() + regions.missing_offset[r],
                                          regions.missing.begin() + regions.missing_offset[r + 1]);
    EXPECT_EQ(listed, expected) << "region " << r;
    EXPECT_EQ(regions.size[r], static_cast<std::int32_t>(region.size())) << "region " << r;
    if (testing::Test::HasFailure()) return 0;  // one region is enough to read
  }
  EXPECT_EQ(regions.holders, holders);
  for (std::int32_t n = 0; n < nodes; ++n) {
    const std::vector<RegionEntry> listed(regions.missing_of.begin() + regions.missing_of_offset[n],
                                          regions.missing_of.begin() + regions.missing_of_offset[n + 1]);
    EXPECT_EQ(listed, transpose[n]) << "node " << n;
    if (testing::Test::HasFailure()) return 0;
  }
  EXPECT_EQ(regions.missing_offset.back(), static_cast<std::int32_t>(regions.missing.size()));
  EXPECT_EQ(regions.missing_of.size(), regions.missing.size());
  return static_cast<std::int64_t>(regions.missing.size());
}

class Regions : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Widths, Regions, testing::Values(1, 2, 3, 4));

TEST_P(Regions, OfABoxAreItsOrderedSums) {
  EXPECT_EQ(check(shape({11, 9, 7}, [](int, int, int) { return true; }), GetParam()), 0);
}

TEST_P(Regions, OfABall) { EXPECT_GT(check(ball(6), GetParam()), 0); }

TEST_P(Regions, OfATorus) { EXPECT_GT(check(torus(), GetParam()), 0); }

TEST_P(Regions, OfAnLInThreeDirections) {
  // The same L lies the other way round in each plane: the order of the sums matters.
  for (int turn = 0; turn < 3; ++turn) {
    const auto inside = [turn](int i, int j, int k) {
      const std::array<int, 3> p{i, j, k};
      return p[turn] < 3 || p[(turn + 1) % 3] < 3;
    };
    check(shape({8, 8, 8}, inside), GetParam());
  }
}

TEST_P(Regions, OfAUDoNotLeapOverTheGap) {
  const LinkedLattice u = shape({7, 8, 4}, [](int i, int j, int) { return i < 3 || i > 3 || j < 2; });
  check(u, GetParam());
  // At the ends of the limbs the other limb lies in the window, but the bend does not.
  const auto regions = find_regions(u, 2);
  const auto end = std::find(u.index.begin(), u.index.end(), Index{2, 7, 1}) - u.index.begin();
  EXPECT_EQ(regions.size[end], 3 * 3 * 4);
}

TEST_P(Regions, OfABallWithACut) { EXPECT_GT(check(cut_ball(), GetParam()), 0); }

TEST_P(Regions, OfABallWithLinksMissingAtRandom) {
  EXPECT_GT(check(torn_ball(0.01), GetParam()), 0);
  EXPECT_GT(check(torn_ball(0.3), GetParam()), 0);
}

TEST_P(Regions, OfNodesThatShareGridPoints) {
  EXPECT_GT(check(two_sheets(), GetParam()), 0);
  EXPECT_GT(check(shuffled(two_sheets()), GetParam()), 0);
}

TEST(FlsmRegions, HoldBothNodesOfAGridPointWhereTheSheetsJoin) {
  const LinkedLattice lattice = two_sheets();
  const auto centre = std::find(lattice.index.begin(), lattice.index.end(), Index{2, 3, 2}) - lattice.index.begin();
  const auto region = region_by_search(lattice, static_cast<std::int32_t>(centre), 1);
  // The window holds 27 points; of the 9 on the doubled side all are found twice.
  EXPECT_EQ(region.size(), 36U);
  const auto regions = find_regions(lattice, 1);
  EXPECT_EQ(regions.size[centre], 36);
  EXPECT_EQ(regions.missing_offset[centre + 1] - regions.missing_offset[centre], 9);
}

TEST(FlsmRegions, OfSingleNodesAndOfNone) {
  EXPECT_EQ(check(shape({3, 1, 1}, [](int i, int, int) { return i != 1; }), 5), 0);
  const FlsmRegions none = find_regions({}, 2);
  EXPECT_EQ(none.missing_offset, std::vector<std::int32_t>{0});
  EXPECT_EQ(none.missing_of_offset, std::vector<std::int32_t>{0});
}

TEST(FlsmRegions, AreTheSameInEveryRun) {
  const LinkedLattice lattice = ball(13);  // several blocks
  const FlsmRegions a = find_regions(lattice, 3), b = find_regions(lattice, 3);
  EXPECT_GT(lattice.index.size(), 8192U);
  EXPECT_EQ(a.missing, b.missing);
  EXPECT_EQ(a.missing_of, b.missing_of);
  std::mt19937 random(1);
  for (int t = 0; t < 200; ++t) {
    const auto r = static_cast<std::int32_t>(random() % lattice.index.size());
    const auto region = region_by_search(lattice, r, 3);
    const auto ordered = ordered_set(lattice, r, 3);
    std::vector<RegionEntry> expected;
    std::copy_if(region.begin(), region.end(), std::back_inserter(expected),
                 [&](const RegionEntry& e) { return !ordered.contains(e.other); });
    EXPECT_EQ(a.size[r], static_cast<std::int32_t>(region.size()));
    EXPECT_EQ(expected,
              std::vector<RegionEntry>(a.missing.begin() + a.missing_offset[r], a.missing.begin() + a.missing_offset[r + 1]));
  }
}

TEST(FlsmRegions, RefuseOtherWidths) {
  const LinkedLattice lattice = ball(2);
  for (const int width : {-1, 0, 6}) {
    const std::string message = error_of([&] { find_regions(lattice, width); });
    EXPECT_NE(message.find(std::to_string(width)), std::string::npos) << message;
    EXPECT_NE(message.find("1 to 5"), std::string::npos) << message;
  }
}

TEST(FlsmRegions, RefuseLinksThatDoNotFitTheGrid) {
  LinkedLattice one_way = ball(2), leap = ball(2), beyond = ball(2);
  const std::int32_t n = one_way.link[1][1];
  ASSERT_GE(n, 0);
  one_way.link[n][0] = -1;
  leap.index[1][0] += 1;
  beyond.link[1][5] = 1000;
  for (const LinkedLattice* lattice : {&one_way, &leap, &beyond}) {
    try {
      find_regions(*lattice, 1);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::internal);
    }
  }
}

}  // namespace
}  // namespace pliant
