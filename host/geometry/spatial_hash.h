// Boxes on a hashed grid (Teschner, Heidelberger, Mueller, Pomerantes and Gross 2003): what overlaps a box, without a bound on
// where things are. A box is entered once, where its lower corner lies; a query begins as far back as the largest box reaches.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace pliant {

class SpatialHash {
 public:
  /// `edge` [m]: positive size of a grid cell, about the size of the queries. `buckets`: a power of two.
  explicit SpatialHash(double edge, std::size_t buckets = 1024) : edge_(edge), first_(buckets, -1) {}

  /// Adds number `item`, 0 .. , once. Its box is stored.
  void insert(const vec::Box& box, std::int32_t item) {
    if (static_cast<std::size_t>(item) >= item_.size()) item_.resize(item + 1);
    item_[item] = {box, -1, 0};
    Index at{};
    bool usual = true;  // also not so if it is not finite
    for (int a = 0; a < 3; ++a) {
      const double cell = std::floor(box.lower[a] / edge_), size = box.upper[a] - box.lower[a];
      usual = usual && std::abs(cell) < kFarthest && size < kLargest * edge_;
      at[a] = usual ? static_cast<std::int64_t>(cell) : 0;
    }
    if (!usual) return large_.push_back(item);
    for (int a = 0; a < 3; ++a) extent_[a] = std::max(extent_[a], box.upper[a] - box.lower[a]);
    std::int32_t& first = first_[hash(at)];
    item_[item].next = first;
    first = item;
  }

  [[nodiscard]] const vec::Box& box(std::int32_t item) const { return item_[item].box; }

  /// Call visit(item) once for each item whose box overlaps `box`.
  template <class Visit>
  void query(const vec::Box& box, Visit&& visit) {
    ++stamp_;
    const auto look = [&](std::int32_t i) {
      if (!item_[i].box.overlaps(box) || item_[i].seen == stamp_) return;
      item_[i].seen = stamp_;
      visit(i);
    };
    for (const std::int32_t i : large_) look(i);
    for_buckets(box, [&](std::size_t bucket) {
      for (std::int32_t i = first_[bucket]; i >= 0; i = item_[i].next) look(i);
    });
  }

 private:
  using Index = std::array<std::int64_t, 3>;
  static constexpr double kLargest = 4;      ///< size of an item that has a place in the grid, in its cells
  static constexpr double kFarthest = 1e15;  ///< from the origin, in cells

  template <class Work>
  void for_buckets(const vec::Box& box, Work&& work) const {
    Index low{}, high{}, at{};
    double cells = 1;
    for (int a = 0; a < 3; ++a) {
      const double back = extent_[a] + 1e-9 * (extent_[a] + std::abs(box.lower[a]));  // no rounding loses an item
      const double lower = std::floor((box.lower[a] - back) / edge_), upper = std::floor(box.upper[a] / edge_);
      cells *= upper - lower + 1;
      if (!(std::abs(lower) < kFarthest && std::abs(upper) < kFarthest)) cells = HUGE_VAL;
      low[a] = std::abs(lower) < kFarthest ? static_cast<std::int64_t>(lower) : 0;
      high[a] = std::abs(upper) < kFarthest ? static_cast<std::int64_t>(upper) : 0;
    }
    if (!(cells < 4.0 * static_cast<double>(first_.size()))) {  // it covers every bucket, or nearly
      for (std::size_t b = 0; b < first_.size(); ++b) work(b);
      return;
    }
    for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
      for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
        for (at[0] = low[0]; at[0] <= high[0]; ++at[0]) work(hash(at));
      }
    }
  }
  [[nodiscard]] std::size_t hash(const Index& at) const {
    const auto h = (static_cast<std::uint64_t>(at[0]) * 73856093U) ^ (static_cast<std::uint64_t>(at[1]) * 19349663U) ^
                   (static_cast<std::uint64_t>(at[2]) * 83492791U);
    return h & (first_.size() - 1);
  }

  struct Item {
    vec::Box box;
    std::int32_t next = -1;  ///< of its bucket
    std::uint32_t seen = 0;  ///< the query that met it last: two cells of the grid may share a bucket
  };

  double edge_;
  std::vector<std::int32_t> first_;  ///< of each bucket
  std::vector<Item> item_;
  std::vector<std::int32_t> large_;
  Vec3d extent_{};  ///< of the largest box with a place in the grid [m]
  std::uint32_t stamp_ = 0;
};

}  // namespace pliant
