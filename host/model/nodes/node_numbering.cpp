#include "model/nodes/node_numbering.h"

#include <algorithm>

#include "layout.h"

namespace pliant {
namespace {

/// Assigns slots from `slot` on to nodes below `real` that have none yet; returns the next slot.
std::int32_t number_real_nodes(NodeNumbering& draft, std::int32_t real, std::int32_t slot) {
  const BodyElements& solid = draft.solid();
  const NodeOrder found = solid.uncut_order == nullptr ? node_order(solid) : NodeOrder{};
  const NodeOrder& all = solid.uncut_order == nullptr ? found : *solid.uncut_order;
  std::vector<std::int32_t> order = all.order;
  std::erase_if(order,
                [&](std::int32_t n) { return n >= real || draft.slot[n] >= 0 || solid.matching(static_cast<std::size_t>(n)); });
  constexpr std::size_t kWindow = 256;
  for (std::size_t begin = 0; begin < order.size(); begin += kWindow) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(std::min(begin + kWindow, order.size()));
    std::stable_sort(first, last, [&](std::int32_t a, std::int32_t b) { return all.valence[a] > all.valence[b]; });
  }
  for (const std::int32_t n : order) draft.slot[n] = slot++;
  return slot;
}

}  // namespace

void number_list_nodes(std::vector<NodeNumbering>& drafts, Model& model) {
  model.list_base = model.bricks > 0 ? (model.bricks + 1) * PLIANT_BRICK_NODES : 0;
  std::int32_t slot = model.list_base;
  for (NodeNumbering& draft : drafts) {
    const BodyElements& solid = draft.solid();
    const auto on_list = [&](std::int32_t n) { return draft.slot[n] < 0 && !solid.matching(static_cast<std::size_t>(n)); };
    const auto nodes = static_cast<std::int32_t>(solid.nodes.size());
    const std::int32_t real = solid.virtual_nodes.first < 0 ? nodes : solid.virtual_nodes.first;
    bool any = false;
    for (std::int32_t n = 0; n < real && !any; ++n) any = on_list(n);
    if (any) slot = number_real_nodes(draft, real, slot);
    // Nodes made by a cut come last, so that a cut renumbers no other node.
    for (std::int32_t n = real; n < nodes; ++n) {
      if (on_list(n)) draft.slot[n] = slot++;
    }
  }
  model.list_end = (slot + PLIANT_TILE - 1) / PLIANT_TILE * PLIANT_TILE;
  model.slots = model.list_end;
}

}  // namespace pliant
