// Regions of fast lattice shape matching (FLSM): for each node, the nodes connected to it by links within a cubic window.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

/// Nodes `low` and `high`, neighbours along `axis`, that are connected although their links in this direction lead to other
/// copies: a node has one link per side, but may have two copies of its neighbour there.
struct Branch {
  std::int32_t low = 0, high = 0, axis = 0;
  bool operator==(const Branch&) const = default;
};

/// Nodes on a grid with links along its axes. Several nodes may share a grid point (copies at a cut, or where parts of the
/// body are close to each other).
struct LinkedLattice {
  std::vector<std::array<std::int32_t, 3>> index;  ///< grid point of each node
  std::vector<std::array<std::int32_t, 6>> link;   ///< neighbour at -x, +x, -y, +y, -z, +z, or -1; symmetric
  std::vector<Branch> branches;                    ///< connections that regions follow and the ordered sums do not
  /// Number of fillers, which come last: empty grid points that the ordered sums may cross. They belong to no region and have
  /// none.
  std::int32_t fillers = 0;
  [[nodiscard]] std::int32_t nodes() const { return static_cast<std::int32_t>(index.size()) - fillers; }
};

/// A correction of the ordered sums: a node of the region that they miss, or with sign -1 a node that they include wrongly.
struct RegionEntry {
  std::int32_t other = 0;                ///< in `missing` the node, in `missing_of` the region (its centre node)
  std::array<std::int32_t, 3> offset{};  ///< grid point of the node minus that of the region's centre
  std::int32_t sign = 1;
  bool operator==(const RegionEntry&) const = default;
};

/// Region r is centred at node r. The kernels sum along links: first x bars, then y plates, then z regions, each over at most
/// `width` links on both sides; `missing` lists the differences from the region.
struct FlsmRegions {
  int width = 0;
  std::vector<std::int32_t> size;            ///< |R_r|, nodes in region r
  std::vector<std::int32_t> holders;         ///< number of regions that contain node i
  std::vector<std::int32_t> missing_offset;  ///< [nodes + 1] into `missing`, by region; entries ascending by `other`
  std::vector<RegionEntry> missing;
  std::vector<std::int32_t> missing_of_offset;  ///< [nodes + 1] into `missing_of`, by node; the transpose of `missing`
  std::vector<RegionEntry> missing_of;
};

/// Adds fillers where the path z, y, x to a node of a region crosses an empty grid point, so that the ordered sums reach it.
/// Without them, the staircase surface of an organ leaves 6 to 8 nodes per region in `missing` at half-width 2, and 20 to 26
/// at 3.
void add_fillers(LinkedLattice& lattice, const FlsmRegions& regions);

/// A lattice with known regions.
struct KnownRegions {
  const LinkedLattice& lattice;
  const FlsmRegions& regions;
};

/// Finds all regions, in linear time. `width`: 1 to 5. Fillers have no regions. `before` (may be null): a similar lattice,
/// for example before a cut, whose unchanged regions are reused.
FlsmRegions find_regions(const LinkedLattice& lattice, int width, const KnownRegions* before = nullptr);

/// Correspondence of two lattices: `now` [nodes and fillers of the previous one], `before` [nodes and fillers of the current
/// one], -1: none. `same` [current nodes]: everything within `width` of the node, including links, is unchanged.
struct LatticeMatch {
  std::vector<std::int32_t> now, before;
  std::vector<char> same;
};
LatticeMatch match_lattices(const LinkedLattice& now, const LinkedLattice& before, int width);

}  // namespace pliant
