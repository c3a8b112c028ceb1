// Placing the cells and nodes of hex8 lattices into bricks of 16 x 4 x 4 (kernels/layout.h).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "model/elements/body_mesh.h"
#include "model/model.h"

namespace pliant {

/// Give every first copy of a lattice node that finite elements move a slot in new bricks at the end of `model`, and put the
/// cells of `solid` that consist of such nodes and have `in_brick[cell]` into them. Returns the slot of each node, -1 for those
/// that stay outside; cells that were placed have `in_brick[cell]` left true, the others set to false.
/// `stiff`: stiff_fills() of `solid`.
std::vector<std::int32_t> place_in_bricks(const BodyElements& solid, std::span<const double> stiff, std::int32_t body,
                                          std::vector<char>& in_brick, Model& model);

/// Append the empty brick, which stands in for absent neighbours.
void close_bricks(Model& model);

}  // namespace pliant
