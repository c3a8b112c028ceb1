// Boxes on a hashed grid (Teschner, Heidelberger, Mueller, Pomerantes and Gross 2003): what overlaps a box, without a bound on
// where things are.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "model/vec.h"

namespace pliant {

class SpatialHash {
 public:
  /// `edge` [m] of a grid cell, positive: about the size of what is looked for. `buckets`: a power of two.
  explicit SpatialHash(double edge, std::size_t buckets = 1024) : edge_(edge), bucket_(buckets) {}

  /// Enter number `item`, 0 .. . Its box is kept.
  void insert(const vec::Box& box, std::int32_t item) {
    if (static_cast<std::size_t>(item) >= box_.size()) {
      box_.resize(item + 1);
      seen_.resize(item + 1, 0);
    }
    box_[item] = box;
    for_cells(box, [&](std::size_t b) {
      Bucket& bucket = bucket_[b];
      if (bucket.last >= 0 && entry_[bucket.last].item == item) return;
      const auto added = static_cast<std::int32_t>(entry_.size());
      entry_.push_back({item, -1});
      (bucket.last >= 0 ? entry_[bucket.last].next : bucket.first) = added;
      bucket.last = added;
    });
  }

  [[nodiscard]] const vec::Box& box(std::int32_t item) const { return box_[item]; }

  /// Call visit(item) once for each item whose box overlaps `box`.
  template <class Visit>
  void query(const vec::Box& box, Visit&& visit) {
    ++stamp_;
    for_cells(box, [&](std::size_t b) {
      for (std::int32_t e = bucket_[b].first; e >= 0; e = entry_[e].next) {
        const std::int32_t item = entry_[e].item;
        if (seen_[item] == stamp_) continue;
        seen_[item] = stamp_;
        if (box_[item].overlaps(box)) visit(item);
      }
    });
  }

 private:
  template <class Work>
  void for_cells(const vec::Box& box, Work&& work) const {
    std::int64_t low[3], high[3];
    double cells = 1;
    for (int a = 0; a < 3; ++a) {
      const double lower = std::floor(box.lower[a] / edge_), upper = std::floor(box.upper[a] / edge_);
      cells *= upper - lower + 1;
      if (!(std::abs(lower) < 1e15 && std::abs(upper) < 1e15)) cells = HUGE_VAL;
      low[a] = std::abs(lower) < 1e15 ? static_cast<std::int64_t>(lower) : 0;
      high[a] = std::abs(upper) < 1e15 ? static_cast<std::int64_t>(upper) : 0;
    }
    if (!(cells < 4.0 * static_cast<double>(bucket_.size()))) {  // it covers every bucket, or nearly
      for (std::size_t b = 0; b < bucket_.size(); ++b) work(b);
      return;
    }
    for (std::int64_t k = low[2]; k <= high[2]; ++k) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t i = low[0]; i <= high[0]; ++i) work(hash(i, j, k));
      }
    }
  }
  [[nodiscard]] std::size_t hash(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto h = (static_cast<std::uint64_t>(i) * 73856093U) ^ (static_cast<std::uint64_t>(j) * 19349663U) ^
                   (static_cast<std::uint64_t>(k) * 83492791U);
    return h & (bucket_.size() - 1);
  }

  /// Items in the order in which they came, as a list in entry_: no allocation per bucket.
  struct Bucket {
    std::int32_t first = -1, last = -1;
  };
  struct Entry {
    std::int32_t item, next;
  };

  double edge_;
  std::vector<Bucket> bucket_;
  std::vector<Entry> entry_;
  std::vector<vec::Box> box_;
  std::vector<std::uint32_t> seen_;
  std::uint32_t stamp_ = 0;
};

}  // namespace pliant
