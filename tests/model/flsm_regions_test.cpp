#include "model/matching/flsm_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "flsm_shapes.h"
#include "model/region_by_search.h"
#include "support/error_of.h"

namespace pliant {
namespace {

using namespace test;

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
    if (::testing::Test::HasFailure()) return 0;  // one region is enough to read
  }
  EXPECT_EQ(regions.holders, holders);
  for (std::int32_t n = 0; n < nodes; ++n) {
    const std::vector<RegionEntry> listed(regions.missing_of.begin() + regions.missing_of_offset[n],
                                          regions.missing_of.begin() + regions.missing_of_offset[n + 1]);
    EXPECT_EQ(listed, transpose[n]) << "node " << n;
    if (::testing::Test::HasFailure()) return 0;
  }
  EXPECT_EQ(regions.missing_offset.back(), static_cast<std::int32_t>(regions.missing.size()));
  EXPECT_EQ(regions.missing_of.size(), regions.missing.size());
  return static_cast<std::int64_t>(regions.missing.size());
}

class Regions : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Widths, Regions, ::testing::Values(1, 2, 3, 4));

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
  const LinkedLattice u = u_bend();
  check(u, GetParam());
  // At the ends of the limbs the other limb lies in the window, but the bend does not.
  const auto regions = find_regions(u, 2);
  const auto end = std::find(u.index.begin(), u.index.end(), Index{2, 7, 1}) - u.index.begin();
  EXPECT_EQ(regions.size[end], 3 * 3 * 4);
}

TEST_P(Regions, OfABallWithACut) { EXPECT_GT(check(cut_ball(), GetParam()), 0); }

TEST_P(Regions, FollowBranches) {
  LinkedLattice lattice = cut_ball();
  const LinkedLattice whole = ball(6);
  int cut = 0;
  for (std::int32_t n = 0; n < lattice.nodes(); ++n) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t other = whole.link[n][2 * axis + 1];
      if (other >= 0 && lattice.link[n][2 * axis + 1] < 0 && cut++ % 3 == 0) lattice.branches.push_back({n, other, axis});
    }
  }
  EXPECT_GT(lattice.branches.size(), 5U);
  EXPECT_GT(check(lattice, GetParam()), check(cut_ball(), GetParam()));
  LinkedLattice sheets = two_sheets();  // where grid points are shared, too: the first sheet beside the second
  for (std::int32_t n = 0; n < 7 * 8 * 5; ++n) {
    for (std::int32_t m = 0; m < 7 * 8 * 5; ++m) {
      const Index &a = sheets.index[n], &b = sheets.index[m];
      if (a[0] == 2 && b == Index{3, a[1], a[2]} && sheets.link[n][1] != m) sheets.branches.push_back({n, m, 0});
    }
  }
  EXPECT_EQ(sheets.branches.size(), 20U);
  check(sheets, GetParam());
}

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

void expect_equal(const FlsmRegions& a, const FlsmRegions& b) {
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.holders, b.holders);
  EXPECT_EQ(a.missing_offset, b.missing_offset);
  EXPECT_EQ(a.missing, b.missing);
  EXPECT_EQ(a.missing_of_offset, b.missing_of_offset);
  EXPECT_EQ(a.missing_of, b.missing_of);
}

/// A node gets a copy that takes over its links along x: what a cut does. The copy is the last node, or with `first` the first.
LinkedLattice with_copy(const LinkedLattice& lattice, std::int32_t node, bool first) {
  LinkedLattice out = lattice;
  const std::int32_t up = lattice.link[node][1];
  unlink(out, node, 1);
  out.index.push_back(lattice.index[node]);
  out.link.push_back({-1, -1, -1, -1, -1, -1});
  const auto copy = static_cast<std::int32_t>(out.index.size()) - 1;
  join(out, copy, up, 0);
  if (!first) return out;
  const auto moved = [&](std::int32_t n) { return n < 0 ? n : (n + 1) % (copy + 1); };
  std::rotate(out.index.rbegin(), out.index.rbegin() + 1, out.index.rend());
  std::rotate(out.link.rbegin(), out.link.rbegin() + 1, out.link.rend());
  for (auto& links : out.link) {
    for (std::int32_t& n : links) n = moved(n);
  }
  return out;
}

/// Regions that are taken over from a lattice before a cut are those that would have been found, with fillers and without.
TEST(FlsmRegions, AreTakenOverFromALatticeThatDiffersInPlaces) {
  const LinkedLattice whole = ball(7), cut = with_copy(whole, 500, false), shifted = with_copy(whole, 500, true);
  LinkedLattice branched = shifted;
  branched.branches.push_back({0, 900, 0});
  branched.branches[0].high = branched.link[branched.link[0][1]][1];
  branched.branches[0].low = branched.link[branched.branches[0].high][0];
  const std::vector<std::pair<LinkedLattice, LinkedLattice>> pairs{{whole, cut},
                                                                   {cut, whole},
                                                                   {whole, shifted},
                                                                   {shifted, with_copy(shifted, 900, true)},
                                                                   {branched, shifted},
                                                                   {shifted, branched},
                                                                   {torn_ball(0.01), ball(6)},
                                                                   {ball(6), ball(7)},
                                                                   {two_sheets(), shuffled(two_sheets())}};
  for (const int width : {1, 2, 3}) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      SCOPED_TRACE("pair " + std::to_string(p) + ", width " + std::to_string(width));
      const auto& [before, now] = pairs[p];
      const FlsmRegions known = find_regions(before, width), fresh = find_regions(now, width);
      const KnownRegions bare{before, known};
      expect_equal(find_regions(now, width, &bare), fresh);
      LinkedLattice filled_before = before, filled_now = now;
      add_fillers(filled_before, known);
      add_fillers(filled_now, fresh);
      const FlsmRegions filled = find_regions(filled_before, width);
      const KnownRegions with_fillers{filled_before, filled};
      expect_equal(find_regions(filled_now, width, &with_fillers), find_regions(filled_now, width));
      const auto same = match_lattices(now, before, width).same;
      const auto kept = std::count(same.begin(), same.end(), 1);
      if (p < 4) {
        EXPECT_GT(kept, 0.5 * static_cast<double>(same.size()));
      }
      if (p < 6) {
        EXPECT_LT(kept, static_cast<std::ptrdiff_t>(same.size()));
      }
      if (HasFailure()) return;
    }
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
