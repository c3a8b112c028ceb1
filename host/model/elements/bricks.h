// Places the cells and nodes of lattices into bricks of 16 x 4 x 4 (kernels/layout.h).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "model/elements/body_mesh.h"
#include "model/model.h"

namespace pliant {

/// Assigns slots in new bricks at the end of `model` to the first copies of lattice nodes that finite elements move, and
/// places the cells of `solid` that consist of such nodes and have `in_brick[cell]`. Returns the slot of each node, -1 for
/// nodes outside. Sets `in_brick[cell]` to whether the cell was placed. `stiff`: stiff_fills() of `solid`.
std::vector<std::int32_t> place_in_bricks(const BodyElements& solid, std::span<const double> stiff, std::int32_t body,
                                          std::vector<char>& in_brick, Model& model);

/// Appends the empty brick, which represents absent neighbours.
void close_bricks(Model& model);

}  // namespace pliant
