// The hexahedra of a Model one by one, wherever they are kept: lists, or bricks of a lattice.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "layout.h"
#include "model/model.h"

namespace pliant {

/// One hexahedron. `record` is that of kernels/layout.h for one point or, where `full`, eight.
struct HexView {
  const Material& material;
  bool full;
  std::array<std::int32_t, 8> slots;
  const std::vector<double>& record;
  double fill;
};

/// Slots of the corners of the brick cell whose low corner is `slot`.
std::array<std::int32_t, 8> brick_cell_corners(const Model& model, std::int32_t slot);
/// The record of every cell of a batch of bricks.
std::vector<double> brick_record(const BrickBatch& batch);

/// f(HexView) for every hexahedron that is a finite element.
template <class F>
void for_each_hex(const Model& model, const F& f) {
  for (const HexBatch& batch : model.hexes) {
    for (std::size_t e = 0; e < batch.nodes.size(); ++e) {
      f(HexView{batch.material, batch.full, batch.nodes[e], batch.records[batch.uniform ? 0 : e], batch.fill[e]});
    }
  }
  for (const BrickBatch& batch : model.brick_batches) {
    const std::vector<double> record = brick_record(batch);
    const std::int32_t first = batch.first * PLIANT_BRICK_NODES, end = first + batch.count * PLIANT_BRICK_NODES;
    for (std::int32_t slot = first; slot < end; ++slot) {
      if (!(model.brick_fill[slot] > 0)) continue;
      f(HexView{batch.material, false, brick_cell_corners(model, slot), record, model.brick_fill[slot]});
    }
  }
}

}  // namespace pliant
