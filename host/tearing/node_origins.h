// Where the nodes of an edited body come from.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pliant {

/// A node that is new on an edge: its values are (1 - share) times those of NodeOrigins::from plus `share` times those of
/// `other`.
struct MixedNode {
  std::int32_t node = 0;   ///< of the body now
  std::int32_t other = 0;  ///< of the body before the edit
  double share = 0;        ///< in (0, 1)
};

/// For each node of an edited body, the node that it was copied from, or the two that it lies between.
struct NodeOrigins {
  std::vector<std::int32_t> from = {};  ///< node of the body before the edit; empty: the body was not edited
  std::vector<MixedNode> mixed = {};    ///< ascending by node
  [[nodiscard]] std::size_t of(std::size_t node) const { return from.empty() ? node : static_cast<std::size_t>(from[node]); }
};

}  // namespace pliant
