// Which cells of a hybrid body are operational (TLED) and which are left to shape matching.
#pragma once
#include <cstdint>
#include <vector>

#include "lattice/lattice.h"
#include "scene/scene.h"

namespace pliant {

/// What a node of a partitioned lattice is: of operational cells only, of shape-matching cells only, or on both.
enum class NodeKind : std::uint8_t { operational, matching, interface };

struct Partition {
  std::vector<char> operational;  ///< per cell
  std::vector<NodeKind> kind;     ///< per node
  std::int64_t operational_nodes = 0, matching_nodes = 0, interface_nodes = 0;
};

/// Partition the lattice of a body with body.model.type hybrid (or flsm: no cell is operational; tled: all are).
/// With `ratio` the region grows from the seed cell by cell, nearest centre first (ties: lowest cell number) over cells that
/// share a face with it, until (operational + interface nodes) / nodes is as near to the ratio as it gets; it is connected.
/// Ratio 0 gives none, 1 all, and any other at least one cell; growth never leaves the face-connected piece that holds the
/// seed. Cells left over that would leave an isolated piece (a face-connected group of shape-matching cells without a node of
/// kind `matching`) become operational too. DeformationModel::cells, where given, are operational instead. Throws Error
/// (pointer, value, what is allowed) when a region holds no cell, or the seed is further from the body than its own size.
Partition partition_lattice(const Body& body, const Lattice& lattice);

}  // namespace pliant
