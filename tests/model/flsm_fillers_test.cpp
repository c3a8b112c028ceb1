// Fillers: what the ordered sums reach with them, and what the list of missing entries corrects, is the region without them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "flsm_shapes.h"
#include "model/region_by_search.h"

namespace pliant {
namespace {

using namespace test;

struct Shape {
  std::string name;
  LinkedLattice lattice;
};

std::vector<Shape> shapes() {
  std::vector<Shape> all{{"box", shape({11, 9, 7}, [](int, int, int) { return true; })}, {"ball", ball(6)}, {"torus", torus()}};
  for (int turn = 0; turn < 3; ++turn) all.push_back({"L turned " + std::to_string(turn) + " times", el(turn)});
  all.push_back({"U", u_bend()});
  all.push_back({"ball with a cut", cut_ball()});
  all.push_back({"ball with 1 of 100 links missing", torn_ball(0.01)});
  all.push_back({"ball with 3 of 10 links missing", torn_ball(0.3)});
  all.push_back({"two sheets", two_sheets()});
  all.push_back({"two sheets, shuffled", shuffled(two_sheets())});
  all.push_back({"single nodes", shape({3, 1, 1}, [](int i, int, int) { return i != 1; })});
  return all;
}

LinkedLattice filled(const LinkedLattice& lattice, int width) {
  LinkedLattice out = lattice;
  add_fillers(out, find_regions(lattice, width));
  return out;
}

// The nodes stay as they were, numbers and links between them; fillers stand on grid points of their own.
void expect_added_at_the_end(const LinkedLattice& before, const LinkedLattice& after) {
  const std::int32_t nodes = before.nodes(), all = static_cast<std::int32_t>(after.index.size());
  ASSERT_EQ(after.nodes(), nodes);
  ASSERT_EQ(after.link.size(), after.index.size());
  std::set<Index> taken(before.index.begin(), before.index.end());
  for (std::int32_t i = 0; i < all; ++i) {
    if (i < nodes) {
      EXPECT_EQ(after.index[i], before.index[i]);
    } else {
      EXPECT_TRUE(taken.insert(after.index[i]).second) << "filler " << i << " stands where another node does";
    }
    for (int d = 0; d < 6; ++d) {
      const std::int32_t n = after.link[i][d];
      const std::int32_t old = i < nodes ? before.link[i][d] : -1;
      if (i < nodes && (old >= 0 || n < nodes)) {
        EXPECT_EQ(n, old) << "link " << d << " of node " << i;
      }
      if (n < 0) continue;
      ASSERT_LT(n, all);
      EXPECT_EQ(after.link[n][d ^ 1], i) << "link " << d << " of " << i << " does not lead back";
      Index next = after.index[i];
      next[d / 2] += d % 2 != 0 ? 1 : -1;
      EXPECT_EQ(after.index[n], next) << "link " << d << " of " << i;
    }
  }
}

// The ordered sums over the nodes alone, plus and minus the list, against the search on the lattice without fillers.
void expect_the_same_sets(const LinkedLattice& before, const LinkedLattice& after, const FlsmRegions& regions) {
  for (std::int32_t r = 0; r < before.nodes(); ++r) {
    const std::set<std::int32_t> ordered = ordered_set(after, r, regions.width);
    std::set<std::int32_t> held(ordered.begin(), ordered.lower_bound(before.nodes()));
    std::int32_t last = -1;
    for (std::int32_t m = regions.missing_offset[r]; m < regions.missing_offset[r + 1]; ++m) {
      const RegionEntry& e = regions.missing[m];
      EXPECT_GT(e.other, last) << "the entries of region " << r << " do not ascend";
      last = e.other;
      ASSERT_LT(e.other, before.nodes()) << "a filler among the nodes of region " << r;
      for (int a = 0; a < 3; ++a) EXPECT_EQ(e.offset[a], before.index[e.other][a] - before.index[r][a]);
      ASSERT_EQ(std::abs(e.sign), 1);
      const bool changed = e.sign == 1 ? held.insert(e.other).second : held.erase(e.other) == 1;
      EXPECT_TRUE(changed) << "region " << r << ": entry " << e.other << " of sign " << e.sign << " changes nothing";
    }
    std::set<std::int32_t> expected;
    for (const RegionEntry& e : region_by_search(before, r, regions.width)) expected.insert(e.other);
    EXPECT_EQ(held, expected) << "region " << r;
    EXPECT_EQ(regions.size[r], static_cast<std::int32_t>(expected.size())) << "region " << r;
    if (::testing::Test::HasFailure()) return;  // one region is enough to read
  }
}

void expect_transpose(const FlsmRegions& regions) {
  std::vector<std::vector<RegionEntry>> expected(regions.size.size());
  for (std::int32_t r = 0; r < static_cast<std::int32_t>(regions.size.size()); ++r) {
    for (std::int32_t m = regions.missing_offset[r]; m < regions.missing_offset[r + 1]; ++m) {
      const RegionEntry& e = regions.missing[m];
      expected[e.other].push_back({r, e.offset, e.sign});
    }
  }
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(std::vector<RegionEntry>(regions.missing_of.begin() + regions.missing_of_offset[n],
                                       regions.missing_of.begin() + regions.missing_of_offset[n + 1]),
              expected[n])
        << "node " << n;
  }
}

class Fillers : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Widths, Fillers, ::testing::Values(1, 2, 3, 4));

TEST_P(Fillers, StandOnEmptyGridPointsAndLeaveTheNodesAsTheyWere) {
  std::int64_t fillers = 0;
  for (const Shape& s : shapes()) {
    SCOPED_TRACE(s.name);
    const LinkedLattice after = filled(s.lattice, GetParam());
    expect_added_at_the_end(s.lattice, after);
    fillers += after.fillers;
    if (HasFatalFailure()) return;
  }
  if (GetParam() > 1) {
    EXPECT_GT(fillers, 100);
  }
}

TEST_P(Fillers, LeaveTheRegionsTheSame) {
  std::int64_t in_vain = 0;
  for (const Shape& s : shapes()) {
    SCOPED_TRACE(s.name);
    const FlsmRegions before = find_regions(s.lattice, GetParam());
    const LinkedLattice after = filled(s.lattice, GetParam());
    const FlsmRegions regions = find_regions(after, GetParam());
    EXPECT_EQ(regions.size, before.size);
    EXPECT_EQ(regions.holders, before.holders);
    ASSERT_EQ(regions.missing_offset.size(), before.missing_offset.size());
    ASSERT_EQ(regions.missing_of_offset.size(), before.missing_of_offset.size());
    expect_the_same_sets(s.lattice, after, regions);
    expect_transpose(regions);
    in_vain += std::count_if(regions.missing.begin(), regions.missing.end(), [](const auto& e) { return e.sign < 0; });
    if (HasFailure()) return;
  }
  if (GetParam() > 1) {
    EXPECT_GT(in_vain, 0) << "no shape needs an entry that takes away";
  }
}

// A box has no entries to save, and single nodes have none beyond the gap.
TEST(FlsmFillers, AreNotAddedWhereNothingIsMissing) {
  for (const Shape& s : shapes()) {
    if (s.name == "box" || s.name == "single nodes") {
      EXPECT_EQ(filled(s.lattice, 3).fillers, 0) << s.name;
    }
  }
  LinkedLattice none;
  add_fillers(none, find_regions(none, 2));
  EXPECT_EQ(none.fillers, 0);
}

TEST(FlsmFillers, SaveMostOfTheListOfABall) {
  const LinkedLattice before = ball(12), after = filled(before, 3);
  const std::size_t entries = find_regions(before, 3).missing.size(), left = find_regions(after, 3).missing.size();
  std::printf("             %d nodes, %d fillers, %zu entries without them and %zu with them\n", before.nodes(), after.fillers,
              entries, left);
  EXPECT_GE(entries, 5 * left);
  EXPECT_GT(entries - left, 10 * static_cast<std::size_t>(after.fillers)) << "a filler costs as much as ten entries";
}

}  // namespace
}  // namespace pliant
