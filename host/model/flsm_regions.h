// Regions of fast lattice shape matching (FLSM): for each node the nodes connected to it through links inside a cubic window.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

/// Nodes on a grid with links along its axes. Several nodes may share a grid point (copies at a cut or where parts of the body pass
/// near each other).
struct LinkedLattice {
  std::vector<std::array<std::int32_t, 3>> index;  ///< grid point of each node
  std::vector<std::array<std::int32_t, 6>> link;   ///< neighbour at -x, +x, -y, +y, -z, +z, or -1; symmetric
};

/// A node of a region that the ordered sums do not reach.
struct RegionEntry {
  std::int32_t other = 0;              ///< in `missing` the node, in `missing_of` the region (number of its centre)
  std::array<std::int32_t, 3> offset{};  ///< grid point of the node minus that of the region's centre
  bool operator==(const RegionEntry&) const = default;
};

/// Region r is centred at node r. The kernels sum along links: first x bars, then y plates, then z regions, each over at most `width`
/// links to both sides; the nodes of a region that no path z, y, x from its centre reaches are listed in `missing`.
struct FlsmRegions {
  int width = 0;
  std::vector<std::int32_t> size;     ///< |R_r|, nodes in region r
  std::vector<std::int32_t> holders;  ///< regions that hold node i
  std::vector<std::int32_t> missing_offset;  ///< [nodes + 1] into `missing`, by region; entries ascending by other
  std::vector<RegionEntry> missing;
  std::vector<std::int32_t> missing_of_offset;  ///< [nodes + 1] into `missing_of`, by node; the transpose of `missing`
  std::vector<RegionEntry> missing_of;
};

/// Find all regions; linear in the nodes. `width` is 1 to 5.
FlsmRegions find_regions(const LinkedLattice& lattice, int width);

/// The nodes of one region by breadth-first search, with their offsets, ascending by node: the definition.
std::vector<RegionEntry> region_by_search(const LinkedLattice& lattice, std::int32_t centre, int width);

}  // namespace pliant
