// Buffer contents of a shape-matching batch. Private to host/schedule.
#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "schedule/program_layout.h"

namespace pliant {

/// Order of the regions of a batch in its buffers: own nodes, the region that represents absent ones (number `own`), padding,
/// the interface from `interface_base` on, padding; these are `nodes` regions. Then the fillers, which have only sums, and
/// padding.
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

/// Corrections of the ordered sums (kernels/matching/flsm_records.cl).
struct MissingList {
  std::vector<std::int32_t> offset, other;
  std::vector<double> factor;
};

/// Contents of the buffers, in region order. `weight` and `missing` are for displacements; `rate_weight` and `rate_missing`
/// for increments, which are shorter at interface nodes by the number of substeps (only set if damping needs them).
struct RegionData {
  std::vector<std::int32_t> slot, link[3];
  MissingList missing, missing_of, rate_missing;
  std::vector<double> weight, rate_weight, rest, spin, inverse_holders, elastic;
};

RegionData region_data(const FlsmBatch& b, const RegionLayout& places);

}  // namespace pliant
