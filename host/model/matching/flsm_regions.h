// Regions of fast lattice shape matching (FLSM): for each node the nodes connected to it through links inside a cubic window.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

/// Nodes `low` and `high`, next to each other along `axis`, that hang together although links in this direction lead elsewhere:
/// a node has one link to each side, and may have two copies of its neighbour there.
struct Branch {
  std::int32_t low = 0, high = 0, axis = 0;
  bool operator==(const Branch&) const = default;
};

/// Nodes on a grid with links along its axes. Several nodes may share a grid point (copies at a cut or where parts of the body
/// pass near each other).
struct LinkedLattice {
  std::vector<std::array<std::int32_t, 3>> index;  ///< grid point of each node
  std::vector<std::array<std::int32_t, 6>> link;   ///< neighbour at -x, +x, -y, +y, -z, +z, or -1; symmetric
  std::vector<Branch> branches;                    ///< paths of the sums do not follow them, regions do
  /// Fillers come last: empty grid points that paths of the ordered sums may cross. They belong to no region and have none.
  std::int32_t fillers = 0;
  [[nodiscard]] std::int32_t nodes() const { return static_cast<std::int32_t>(index.size()) - fillers; }
};

/// A node of a region that the ordered sums do not reach, or with sign -1 one that they reach and that is not in the region.
struct RegionEntry {
  std::int32_t other = 0;                ///< in `missing` the node, in `missing_of` the region (number of its centre)
  std::array<std::int32_t, 3> offset{};  ///< grid point of the node minus that of the region's centre
  std::int32_t sign = 1;
  bool operator==(const RegionEntry&) const = default;
};

/// Region r is centred at node r. The kernels sum along links: first x bars, then y plates, then z regions, each over at most
/// `width` links to both sides; where that is not the region, `missing` says what to add and what to take away.
struct FlsmRegions {
  int width = 0;
  std::vector<std::int32_t> size;            ///< |R_r|, nodes in region r
  std::vector<std::int32_t> holders;         ///< regions that hold node i
  std::vector<std::int32_t> missing_offset;  ///< [nodes + 1] into `missing`, by region; entries ascending by other
  std::vector<RegionEntry> missing;
  std::vector<std::int32_t> missing_of_offset;  ///< [nodes + 1] into `missing_of`, by node; the transpose of `missing`
  std::vector<RegionEntry> missing_of;
};

/// Add fillers where a node of a region is beyond an empty grid point on the path z, y, x, so that the ordered sums reach it.
/// Without them the staircase surface of an organ leaves 6 to 8 nodes per region to `missing` at half-width 2, and 20 to 26
/// at 3.
void add_fillers(LinkedLattice& lattice, const FlsmRegions& regions);

/// A lattice whose regions are known.
struct KnownRegions {
  const LinkedLattice& lattice;
  const FlsmRegions& regions;
};

/// Find all regions; linear in the nodes. `width` is 1 to 5. All lists are over nodes, without fillers. `before`: a lattice
/// that differs in places, as before a cut, whose regions are taken over where they are the same; nullptr: none.
FlsmRegions find_regions(const LinkedLattice& lattice, int width, const KnownRegions* before = nullptr);

/// Which nodes of two lattices stand for each other: `now` [nodes and fillers of the one before], `before` [nodes and fillers
/// of the one now], -1: none. `same` [nodes now]: all within `width` of the node, links among it, is as it was.
struct LatticeMatch {
  std::vector<std::int32_t> now, before;
  std::vector<char> same;
};
LatticeMatch match_lattices(const LinkedLattice& now, const LinkedLattice& before, int width);

}  // namespace pliant
