// What the hash finds against a look at every box.
#include "geometry/spatial_hash.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace pliant {
namespace {

std::vector<vec::Box> random_boxes(std::mt19937& random, std::size_t count, double spread, double size) {
  std::uniform_real_distribution<double> at(-spread, spread), extent(0, size);
  std::vector<vec::Box> boxes(count);
  for (vec::Box& box : boxes) {
    for (int a = 0; a < 3; ++a) {
      box.lower[a] = at(random);
      box.upper[a] = box.lower[a] + extent(random);
    }
  }
  return boxes;
}

void expect_all_found(const std::vector<vec::Box>& boxes, const std::vector<vec::Box>& queries, std::size_t buckets) {
  SpatialHash hash(1, buckets);
  for (std::size_t i = 0; i < boxes.size(); ++i) hash.insert(boxes[i], static_cast<std::int32_t>(i));
  for (const vec::Box& query : queries) {
    std::vector<int> times(boxes.size(), 0);
    hash.query(query, [&](std::int32_t i) { ++times[i]; });
    for (std::size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(times[i], boxes[i].overlaps(query) ? 1 : 0) << i;
  }
}

TEST(SpatialHash, FindsWhatOverlapsOnce) {
  std::mt19937 random(1);
  const auto boxes = random_boxes(random, 300, 10, 1.5), queries = random_boxes(random, 100, 11, 4);
  expect_all_found(boxes, queries, 1024);
  expect_all_found(boxes, queries, 8);  // many places share a bucket
}

TEST(SpatialHash, BoxesThatOnlyTouchAreFound) {
  std::vector<vec::Box> boxes;
  for (int i = -3; i < 3; ++i) boxes.push_back({{1.0 * i, 0, 0}, {i + 1.0, 1, 1}});
  std::vector<vec::Box> queries;
  for (int i = -4; i < 5; ++i) queries.push_back({{1.0 * i, 1, 1}, {1.0 * i, 2, 2}});
  expect_all_found(boxes, queries, 1024);
}

TEST(SpatialHash, LargeFarAndUnboundedBoxesAreFound) {
  std::mt19937 random(2);
  auto boxes = random_boxes(random, 100, 5, 1), queries = random_boxes(random, 50, 6, 2);
  boxes.push_back({{-100, -0.1, -100}, {100, 0.1, 100}});
  boxes.push_back({{1e20, 0, 0}, {2e20, 1, 1}});
  boxes.push_back({{0, -HUGE_VAL, 0}, {1, HUGE_VAL, 1}});
  boxes.push_back({{NAN, 0, 0}, {NAN, 1, 1}});  // overlaps whatever overlaps it along the other axes
  queries.push_back({{1.5e20, 0.5, 0.5}, {1.5e20, 0.5, 0.5}});
  queries.push_back({{-1000, -1000, -1000}, {1000, 1000, 1000}});
  queries.push_back({{-HUGE_VAL, 0, 0}, {HUGE_VAL, 1, 1}});
  expect_all_found(boxes, queries, 1024);
}

}  // namespace
}  // namespace pliant
