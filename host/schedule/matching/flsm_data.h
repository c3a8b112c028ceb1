// A batch of shape matching as its buffers hold it. Private to host/schedule.
#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "schedule/program_layout.h"

namespace pliant {

/// Where the regions of a batch stand in its buffers: own nodes, the one that stands for absent ones (number `own`), padding,
/// the interface from `interface_base` on, padding; these `nodes` have regions. Then come the fillers, which have sums only,
/// and padding.
struct RegionLayout {
  std::int32_t own, interface, interface_base, nodes, count;
  explicit RegionLayout(const FlsmBatch& b)
      : own(b.own),
        interface(b.interface),
        interface_base(b.slots - PLIANT_TILE),
        nodes(interface_base + padded(static_cast<std::size_t>(b.interface))),
        count(nodes + padded(static_cast<std::size_t>(b.fillers))) {}
  [[nodiscard]] std::int32_t of(std::int32_t node) const {
    if (node < 0) return own;
    if (node < own) return node;
    return node < own + interface ? interface_base + node - own : nodes + node - own - interface;
  }
};

/// What to add to the ordered sums (kernels/matching/flsm_records.cl).
struct MissingList {
  std::vector<std::int32_t> offset, other;
  std::vector<double> factor;
};

/// What the buffers hold of the model, in the order of the regions. `weight` and `missing` are for displacements; `rate_weight`
/// and `rate_missing` for increments, those of interface nodes being shorter by the number of substeps (filled where damping
/// needs them).
struct RegionData {
  std::vector<std::int32_t> slot, link[3];
  MissingList missing, missing_of, rate_missing;
  std::vector<double> weight, rate_weight, rest, spin, inverse_holders, elastic;
};

RegionData region_data(const FlsmBatch& b, const RegionLayout& places);

}  // namespace pliant
