// The edge of a blade in a buffer: what the simulation says of its samples, at the nodes of the buffer.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/contact_tool.h"
#include "simulation/edits/blade_samples.h"

namespace pliant::haptics {

/// In the arrays of blade_press.cl and blade_apply.cl, by nodes of a buffer.
struct BladeState {
  std::vector<std::int32_t> node;
  std::vector<float> weight, share, data, front, depth;
  double edge = 0;
  Pose pose;  ///< of the simulation's blade
  std::vector<std::int32_t> slot, free, first, entry;
};

/// `slots`: of the nodes of the buffer in the model, ascending. `free`: [nodes] bits of the components in which a node can
/// move. Samples with a node outside press nothing; then `covered` becomes false.
BladeState blade_state(BladeSamples samples, const std::vector<std::int32_t>& slots, const std::vector<std::int32_t>& free,
                       bool& covered);

}  // namespace pliant::haptics
