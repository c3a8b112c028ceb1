#include "model/bricks.h"

#include <algorithm>
#include <map>

#include "layout.h"

namespace pliant {
namespace {

using Index3 = std::array<std::int32_t, 3>;
constexpr Index3 kSize{PLIANT_BRICK_X, PLIANT_BRICK_Y, PLIANT_BRICK_Z};
constexpr std::int32_t kAbsent = -1;  // until close_bricks knows the empty brick

Index3 brick_of(const Index3& node) {
  return {node[2] / kSize[2], node[1] / kSize[1], node[0] / kSize[0]};
}  // sorts by z, y, x

std::int32_t place_of(const Index3& node) {
  return node[0] % kSize[0] + kSize[0] * (node[1] % kSize[1] + kSize[1] * (node[2] % kSize[2]));
}

/// Note that the row of `slot` holds a cell (kind 0) or a node (kind 1).
void mark_row(std::int32_t slot, int kind, Model& model) {
  model.brick_rows[2 * (slot / PLIANT_BRICK_NODES) + kind] |= 1 << slot % PLIANT_BRICK_NODES / PLIANT_BRICK_X;
}

}  // namespace

std::vector<std::int32_t> place_in_bricks(const Solid& solid, std::int32_t body, std::vector<char>& in_brick, Model& model) {
  std::map<Index3, std::int32_t> bricks;
  for (std::size_t n = 0; n < solid.lattice_nodes.size(); ++n) {
    if (solid.lattice_nodes[n].copy == 0 && !solid.matching(n)) bricks.emplace(brick_of(solid.lattice_nodes[n].index), 0);
  }
  const std::int32_t first = model.bricks;
  std::int32_t next = first;
  for (auto& [place, number] : bricks) number = next++;
  model.bricks = next;
  model.brick_neighbor.resize(std::size_t{PLIANT_BRICK_NEIGHBORS} * next, kAbsent);
  model.brick_fill.resize(std::size_t{PLIANT_BRICK_NODES} * next, 0.0);
  model.brick_cell.resize(std::size_t{PLIANT_BRICK_NODES} * next, -1);
  model.brick_body.resize(next, body);
  model.brick_rows.resize(std::size_t{2} * next, 0);
  for (const auto& [place, number] : bricks) {
    for (int side = 0; side < 16; ++side) {
      const int step = side < 8 ? 1 : -1;
      const auto found =
          bricks.find({place[0] + (side & 4 ? step : 0), place[1] + (side & 2 ? step : 0), place[2] + (side & 1 ? step : 0)});
      if (found != bricks.end()) model.brick_neighbor[16 * number + side] = found->second;
    }
  }
  std::vector<std::int32_t> slot(solid.nodes.size(), -1);
  for (std::size_t n = 0; n < solid.nodes.size(); ++n) {
    const LatticeNode& node = solid.lattice_nodes[n];
    if (node.copy != 0 || solid.matching(n)) continue;
    slot[n] = bricks.at(brick_of(node.index)) * PLIANT_BRICK_NODES + place_of(node.index);
    mark_row(slot[n], 1, model);
  }
  for (std::size_t c = 0; c < solid.cells.size(); ++c) {
    const Cell& cell = solid.cells[c];
    const bool first_copies = std::all_of(cell.nodes.begin(), cell.nodes.end(), [&](std::int32_t n) { return slot[n] >= 0; });
    const std::int32_t place = slot[cell.nodes[0]];
    if (!in_brick[c] || !first_copies || model.brick_cell[place] >= 0) {
      in_brick[c] = false;
      continue;
    }
    model.brick_fill[place] = cell.fill;
    mark_row(place, 0, model);
    model.brick_cell[place] = static_cast<std::int64_t>(c);
  }
  return slot;
}

void close_bricks(Model& model) {
  if (model.bricks == 0) return;
  for (std::int32_t& neighbor : model.brick_neighbor) {
    if (neighbor == kAbsent) neighbor = model.bricks;
  }
  model.brick_neighbor.resize(std::size_t{PLIANT_BRICK_NEIGHBORS} * (model.bricks + 1), model.bricks);
  model.brick_fill.resize(std::size_t{PLIANT_BRICK_NODES} * (model.bricks + 1), 0.0);
  model.brick_rows.resize(std::size_t{2} * (model.bricks + 1), 0);
}

}  // namespace pliant
