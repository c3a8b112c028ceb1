#include "model/elements/bricks.h"

#include <algorithm>
#include <limits>

#include "layout.h"

namespace pliant {
namespace {

using Index3 = std::array<std::int32_t, 3>;
constexpr Index3 kSize{PLIANT_BRICK_X, PLIANT_BRICK_Y, PLIANT_BRICK_Z};
constexpr std::int32_t kAbsent = -1;  // until close_bricks assigns the empty brick

Index3 brick_of(const Index3& node) {
  return {node[2] / kSize[2], node[1] / kSize[1], node[0] / kSize[0]};
}  // sorts by z, y, x

std::int32_t place_of(const Index3& node) {
  return node[0] % kSize[0] + kSize[0] * (node[1] % kSize[1] + kSize[1] * (node[2] % kSize[2]));
}

/// Numbers the bricks of a body by their position in the box around all of them.
class BrickMap {
 public:
  explicit BrickMap(const BodyElements& solid) {
    for (const LatticeNode& node : solid.lattice_nodes) {
      const Index3 place = brick_of(node.index);
      for (std::size_t a = 0; a < 3; ++a) {
        low_[a] = std::min(low_[a], place[a]);
        size_[a] = std::max(size_[a], place[a] + 1);
      }
    }
    std::size_t all = solid.lattice_nodes.empty() ? 0 : 1;
    for (std::size_t a = 0; a < 3; ++a) {
      size_[a] -= low_[a];
      all *= static_cast<std::size_t>(size_[a]);
    }
    number_.assign(all, kAbsent);
  }
  std::int32_t& at(const Index3& place) { return number_[index(place)]; }
  [[nodiscard]] std::int32_t find(const Index3& place) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (place[a] < low_[a] || place[a] >= low_[a] + size_[a]) return kAbsent;
    }
    return number_[index(place)];
  }
  /// Numbers the present bricks in the order of their positions; returns the next number.
  std::int32_t number_from(std::int32_t first) {
    for (std::int32_t& number : number_) {
      if (number != kAbsent) number = first++;
    }
    return first;
  }
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t i = 0; i < number_.size(); ++i) {
      if (number_[i] == kAbsent) continue;
      const auto k = static_cast<std::int32_t>(i);
      visit(Index3{low_[0] + k / (size_[1] * size_[2]), low_[1] + k / size_[2] % size_[1], low_[2] + k % size_[2]}, number_[i]);
    }
  }

 private:
  [[nodiscard]] std::size_t index(const Index3& place) const {
    return (static_cast<std::size_t>(place[0] - low_[0]) * size_[1] + place[1] - low_[1]) * size_[2] + place[2] - low_[2];
  }
  static constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  Index3 low_{kMost, kMost, kMost}, size_{-kMost, -kMost, -kMost};
  std::vector<std::int32_t> number_;
};

/// Marks that the row of `slot` contains a cell (kind 0) or a node (kind 1).
void mark_row(std::int32_t slot, int kind, Model& model) {
  model.brick_rows[2 * (slot / PLIANT_BRICK_NODES) + kind] |= 1 << slot % PLIANT_BRICK_NODES / PLIANT_BRICK_X;
}

}  // namespace

std::vector<std::int32_t> place_in_bricks(const BodyElements& solid, std::span<const double> stiff, std::int32_t body,
                                          std::vector<char>& in_brick, Model& model) {
  const auto in_bricks = [&](std::size_t n) { return solid.lattice_nodes[n].copy == 0 && !solid.matching(n); };
  BrickMap bricks(solid);
  for (std::size_t n = 0; n < solid.lattice_nodes.size(); ++n) {
    if (in_bricks(n)) bricks.at(brick_of(solid.lattice_nodes[n].index)) = 0;
  }
  const std::int32_t next = bricks.number_from(model.bricks);
  model.bricks = next;
  model.brick_neighbor.resize(std::size_t{PLIANT_BRICK_NEIGHBORS} * next, kAbsent);
  model.brick_fill.resize(std::size_t{PLIANT_BRICK_NODES} * next, 0.0);
  model.brick_cell.resize(std::size_t{PLIANT_BRICK_NODES} * next, -1);
  model.brick_body.resize(next, body);
  model.brick_rows.resize(std::size_t{2} * next, 0);
  bricks.for_each([&](const Index3& place, std::int32_t number) {
    for (int side = 0; side < 16; ++side) {
      const int step = side < 8 ? 1 : -1;
      model.brick_neighbor[16 * number + side] =
          bricks.find({place[0] + (side & 4 ? step : 0), place[1] + (side & 2 ? step : 0), place[2] + (side & 1 ? step : 0)});
    }
  });
  std::vector<std::int32_t> slot(solid.nodes.size(), -1);
  for (std::size_t n = 0; n < solid.nodes.size(); ++n) {
    if (!in_bricks(n)) continue;
    const LatticeNode& node = solid.lattice_nodes[n];
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
    model.brick_fill[place] = stiff[c];
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
