// The samples of blades that cut by force as arrays for the kernels (kernels/contact/blade_press.cl).
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "schedule/contact/blade_data.h"

namespace pliant {

/// Of `size()` samples; one that presses nothing has the limit -1 in `data`.
struct BladeSamples {
  std::vector<std::int32_t> node;  ///< [samples][8] slots that carry the front point
  std::vector<double> weight;      ///< [samples][8]; 0: no node
  std::vector<double> share;       ///< [samples][8], by share_out()
  std::vector<double> data;        ///< [samples][12] (blade_press.cl)
  std::vector<double> front;       ///< [samples][2] (blade_press.cl)
  std::vector<double> depth;       ///< [samples] way of the front through material, up to its front point [m]
  double edge = 0;                 ///< typical_edge() [m]

  explicit BladeSamples(std::size_t samples = 0)
      : node(blade_sample_nodes * samples),
        weight(node.size()),
        share(node.size()),
        data(blade_sample_numbers * samples, -1.0),
        front(2 * samples),
        depth(samples) {}
  [[nodiscard]] std::size_t size() const { return depth.size(); }
  /// Computes `share` from the weights of all samples at a node.
  void share_out();
};

/// For blade_apply.cl: the nodes that any sample moves, and for each of them where in BladeSamples::node it stands.
struct BladeNodes {
  std::vector<std::int32_t> slot, free, first, entry;
};
/// `free`: bits of the components in which a node can move.
BladeNodes blade_nodes(const BladeSamples& samples, const std::function<std::int32_t(std::int32_t)>& free);

}  // namespace pliant
