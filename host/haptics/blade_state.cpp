#include "haptics/blade_state.h"

#include <algorithm>

namespace pliant::haptics {
namespace {

/// Returns false if a node of a sample is none of the buffer's.
bool renumber(BladeSamples& samples, std::size_t i, const std::vector<std::int32_t>& slots) {
  for (std::size_t at = blade_sample_nodes * i; at < blade_sample_nodes * (i + 1); ++at) {
    if (samples.weight[at] == 0) {
      samples.node[at] = 0;
      continue;
    }
    const auto own = std::lower_bound(slots.begin(), slots.end(), samples.node[at]);
    if (own == slots.end() || *own != samples.node[at]) return false;
    samples.node[at] = static_cast<std::int32_t>(own - slots.begin());
  }
  return true;
}

std::vector<float> rounded(const std::vector<double>& values) { return {values.begin(), values.end()}; }

}  // namespace

BladeState blade_state(BladeSamples samples, const std::vector<std::int32_t>& slots, const std::vector<std::int32_t>& free,
                       bool& covered) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (renumber(samples, i, slots)) continue;
    covered = false;
    std::fill_n(samples.weight.begin() + static_cast<std::ptrdiff_t>(blade_sample_nodes * i), blade_sample_nodes, 0.0);
    std::fill_n(samples.node.begin() + static_cast<std::ptrdiff_t>(blade_sample_nodes * i), blade_sample_nodes, 0);
    samples.data[blade_sample_numbers * i + 6] = -1;
  }
  samples.share_out();
  const BladeNodes nodes = blade_nodes(samples, [&](std::int32_t n) { return free[static_cast<std::size_t>(n)]; });
  BladeState out;
  out.node = samples.node;
  out.weight = rounded(samples.weight);
  out.share = rounded(samples.share);
  out.data = rounded(samples.data);
  out.front = rounded(samples.front);
  out.depth = rounded(samples.depth);
  out.edge = samples.edge;
  out.slot = nodes.slot;
  out.free = nodes.free;
  out.first = nodes.first;
  out.entry = nodes.entry;
  return out;
}

}  // namespace pliant::haptics
