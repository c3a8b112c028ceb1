// Division of a hybrid body into operational cells (TLED) and shape-matching cells.
#pragma once
#include <cstdint>
#include <vector>

#include "lattice/lattice.h"
#include "scene/scene.h"

namespace pliant {

/// Kind of a node: it touches only operational cells, only shape-matching cells, or both.
enum class NodeKind : std::uint8_t { operational, matching, interface };

struct Partition {
  std::vector<char> operational;  ///< per cell
  std::vector<NodeKind> kind;     ///< per node
  std::int64_t operational_nodes = 0, matching_nodes = 0, interface_nodes = 0;
};

/// Partitions the lattice of a body with body.model.type hybrid (flsm: no cell is operational; tled: all are). With `ratio`,
/// the region grows from the seed cell by cell, nearest centre first (ties: lowest cell number), over cells that share a face
/// with it, until (operational + interface nodes) / nodes is as close to the ratio as possible; it is connected. Ratio 0
/// selects no cell, 1 all, any other at least one; growth stays within the face-connected piece that contains the seed.
/// Remaining cells that would form an isolated piece (a face-connected group of shape-matching cells without a node of kind
/// `matching`) become operational too. If DeformationModel::cells is given, those cells are operational instead. Throws Error
/// (pointer, value, allowed values) if a region contains no cell, or if the seed is further from the body than its own size.
Partition partition_lattice(const Body& body, const Lattice& lattice);

}  // namespace pliant
