// Twin of kernels/links/node_sum.cl.
#pragma once
#include <cstdint>

#include "layout.h"

namespace pliant::ref {

/// Sums of forces at the nodes of one tile of a list.
template <class Scalar>
class NodeSum {
 public:
  NodeSum(const std::int32_t* node, std::int64_t tile) : slot_(node + 2 * tile), written_(slot_ + PLIANT_TILE) {}
  [[nodiscard]] std::int64_t slot(int lane) const { return slot_[lane]; }
  void begin(const Scalar* node_load, Scalar (&sum)[3][PLIANT_TILE]) const {
    for (int l = 0; l < PLIANT_TILE; ++l) {
      for (int c = 0; c < 3; ++c) sum[c][l] = written_[l] > 0 ? node_load[4 * slot(l) + c] : Scalar(0);
    }
  }
  void store(const Scalar (&sum)[3][PLIANT_TILE], Scalar* node_load) const {
    for (int l = 0; l < PLIANT_TILE; ++l) {
      if (written_[l] < 0) continue;
      for (int c = 0; c < 3; ++c) node_load[4 * slot(l) + c] = sum[c][l];
    }
  }

 private:
  const std::int32_t *slot_, *written_;
};

}  // namespace pliant::ref
