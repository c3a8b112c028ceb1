#include "simulation/edits/blade_samples.h"

#include <cmath>
#include <map>

namespace pliant {

void BladeSamples::share_out() {
  std::map<std::int32_t, double> sums;
  for (std::size_t at = 0; at < node.size(); ++at) {
    if (weight[at] != 0) sums[node[at]] += std::abs(weight[at]);
  }
  for (std::size_t at = 0; at < node.size(); ++at) share[at] = weight[at] != 0 ? std::abs(weight[at]) * sums[node[at]] : 0;
}

BladeNodes blade_nodes(const BladeSamples& samples, const std::function<std::int32_t(std::int32_t)>& free) {
  std::map<std::int32_t, std::vector<std::int32_t>> at_slot;
  for (std::size_t at = 0; at < samples.node.size(); ++at) {
    if (samples.weight[at] != 0) at_slot[samples.node[at]].push_back(static_cast<std::int32_t>(at));
  }
  BladeNodes out;
  out.first.push_back(0);
  for (const auto& [slot, entries] : at_slot) {
    out.slot.push_back(slot);
    out.free.push_back(free(slot));
    out.entry.insert(out.entry.end(), entries.begin(), entries.end());
    out.first.push_back(static_cast<std::int32_t>(out.entry.size()));
  }
  const std::size_t size = samples.node.size();
  out.slot.resize(size, -1);
  out.free.resize(size, 0);
  out.first.resize(size + 1, out.first.back());
  out.entry.resize(size, 0);
  return out;
}

}  // namespace pliant
