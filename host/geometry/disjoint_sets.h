// Union-find over indices.
#pragma once
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace pliant {

/// Sets of indices that are joined pairwise; the representative is the lowest index.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::int32_t find(std::int32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace pliant
