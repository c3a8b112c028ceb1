// Which part of a surface is new: ranges against their definition.
#include "api/frame_pool.h"

#include <gtest/gtest.h>

#include <random>

namespace pliant::api {
namespace {

Frame frame_of(const std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& cut_faces) {
  Frame frame;
  frame.triangles = {triangles.data(), triangles.size()};
  frame.cut_faces = {cut_faces.data(), cut_faces.size()};
  return frame;
}

bool holds(const IndexRange& range, std::size_t i) { return i >= range.first && i < range.first + range.count; }

TEST(FramePool, TrianglesAreNewWhereCornersOrFlagsAre) {
  const std::vector<Triangle> all{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 5}}, same = all;
  const std::vector<std::uint8_t> none, third{0, 0, 1, 0}, two{0, 0, 1, 0, 1};
  const Frame plain = frame_of(all, none), flagged = frame_of(same, third);
  EXPECT_EQ(changed_triangles(plain, plain).count, 0U);
  EXPECT_EQ(changed_triangles(plain, frame_of(same, none)).count, 0U) << "equal, elsewhere";
  for (const auto& [from, to] : {std::pair{&plain, &flagged}, std::pair{&flagged, &plain}}) {
    const IndexRange range = changed_triangles(*from, *to);
    EXPECT_EQ(range.first, 2U);
    EXPECT_EQ(range.count, 1U);
  }
  std::vector<Triangle> other = all;
  other[1] = {1, 3, 2};
  other.push_back({4, 5, 6});
  const IndexRange more = changed_triangles(flagged, frame_of(other, two));
  EXPECT_EQ(more.first, 1U);
  EXPECT_EQ(more.count, 4U);
  const std::vector<Triangle> one{all[0]};
  const IndexRange fewer = changed_triangles(frame_of(other, none), frame_of(one, none));
  EXPECT_EQ(fewer.count, 0U) << "what is left is as it was";
}

TEST(FramePool, ChangedRangesAreTheSmallest) {
  std::mt19937 random(9);
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec4f> from(1 + pick(20), Vec4f{1, 2, 3, 0});
    std::vector<Vec4f> to = from;
    to.resize(1 + pick(20), Vec4f{});
    for (std::size_t k = pick(3); k > 0; --k) to[pick(to.size())][pick(3)] = -0.0F;
    const IndexRange range = changed_range({from.data(), from.size()}, {to.data(), to.size()});
    ASSERT_LE(range.first + range.count, to.size());
    const auto same = [&](std::size_t i) { return i < from.size() && from[i] == to[i]; };
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (same(i)) continue;
      ASSERT_TRUE(holds(range, i)) << trial;
    }
    if (range.count > 0) {
      EXPECT_FALSE(same(range.first));
      EXPECT_FALSE(same(range.first + range.count - 1));
    }
  }
}

}  // namespace
}  // namespace pliant::api
