#include "model/matching/flsm.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/disjoint_sets.h"
#include "layout.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Upper limit of the Poisson's ratio of a region: near 1/2 its volumetric stiffness would require shorter steps than alpha =
/// 1.
constexpr double kMostPoisson = 0.3;

/// Orders cells in tiles of 8 x 8 rows, so that the planes read by the sums along y and z stay in the cache.
std::array<std::int32_t, 5> place_in_tiles(const LatticeNode& n) {
  return {n.index[2] >> 3, n.index[1] >> 3, n.index[2], n.index[1], n.index[0]};
}

std::vector<std::int32_t> nodes_in_order(const BodyElements& solid, NodeKind kind) {
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < solid.partition.kind.size(); ++n) {
    if (solid.partition.kind[n] == kind) nodes.push_back(static_cast<std::int32_t>(n));
  }
  std::stable_sort(nodes.begin(), nodes.end(), [&](std::int32_t a, std::int32_t b) {
    return place_in_tiles(solid.lattice_nodes[a]) < place_in_tiles(solid.lattice_nodes[b]);
  });
  return nodes;
}

/// Calls work(low, high, axis) for the edges of the shape-matching cells. `number`: index in the batch of each node of the
/// body.
template <class Work>
void for_each_edge(const BodyElements& solid, const std::vector<std::int32_t>& number, const Work& work) {
  for (const Cell& cell : solid.matching_cells) {
    for (int a = 0; a < 8; ++a) {
      for (int axis = 0; axis < 3; ++axis) {
        if ((a >> axis & 1) == 0) work(number[cell.nodes[a]], number[cell.nodes[a | 1 << axis]], axis);
      }
    }
  }
}

/// A node has one link in each direction. Where the lattice branches (one node, two copies of its neighbour), the edge of the
/// first cell becomes the link. Copies that would then be unconnected, such as one with only a corner of a cell, are
/// connected by a branch.
void link_nodes(const BodyElements& solid, const std::vector<std::int32_t>& number, FlsmBatch& batch) {
  batch.link.assign(batch.slot.size(), {-1, -1, -1, -1, -1, -1});
  DisjointSets linked(batch.slot.size());
  for_each_edge(solid, number, [&](std::int32_t low, std::int32_t high, int axis) {
    std::int32_t &up = batch.link[low][2 * axis + 1], &down = batch.link[high][2 * axis];
    if (up >= 0 || down >= 0) return;
    up = high;
    down = low;
    linked.join(low, high);
  });
  for_each_edge(solid, number, [&](std::int32_t low, std::int32_t high, int axis) {
    if (linked.find(low) == linked.find(high)) return;
    batch.branches.push_back({low, high, axis});
    linked.join(low, high);
  });
}

/// Returns true if two batches have the same nodes and links, before fillers.
bool same_links(const FlsmBatch& batch, const FlsmBatch& other) {
  if (other.index != batch.index || other.branches != batch.branches) return false;
  const auto nodes = static_cast<std::int32_t>(batch.slot.size());
  for (std::int32_t n = 0; n < nodes; ++n) {
    for (int d = 0; d < 6; ++d) {
      const std::int32_t link = other.link[n][d];
      if ((link < nodes ? link : -1) != batch.link[n][d]) return false;
    }
  }
  return true;
}

void require_width(const Body& body, const FlsmBatch& batch) {
  std::array<std::int32_t, 3> low = batch.index[0], high = low;
  for (const auto& at : batch.index) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], at[c]);
      high[c] = std::max(high[c], at[c]);
    }
  }
  const std::int32_t longest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  if (batch.settings.width <= longest) return;
  throw Error(
      ErrorCode::bad_input,
      fmt::format("{}/width: got {}, but the shape-matching part of body '{}' is only {} cells long; allowed are 1 to {}, or a "
                  "finer lattice",
                  body.model.pointer, batch.settings.width, body.name, longest, longest));
}

/// Fraction of each node's material in shape-matching cells. `number`: index in the batch of each node.
std::vector<double> matter_of(const BodyElements& solid, const std::vector<std::int32_t>& number, std::size_t nodes) {
  std::vector<double> inside(nodes), all(nodes);
  const auto add = [&](const auto& corners, std::size_t e) {
    for (const std::int32_t n : corners) {
      if (number[n] < 0) continue;
      all[number[n]] += solid.fill[e];
      if (!solid.operational(e)) inside[number[n]] += solid.fill[e];
    }
  };
  for (std::size_t e = 0; e < solid.hexes.size(); ++e) add(solid.hexes[e], e);
  for (std::size_t e = 0; e < solid.tets.size(); ++e) add(solid.tets[e], e);
  for (std::size_t n = 0; n < nodes; ++n) inside[n] = all[n] > 0 ? inside[n] / all[n] : 0;
  return inside;
}

/// Sums of moments along one axis, over `width` links on each side.
std::vector<RestMoments> along(int axis, const FlsmBatch& batch, const std::vector<RestMoments>& in) {
  constexpr int second[3][3] = {{4, 7, 8}, {7, 5, 9}, {8, 9, 6}};  // index of m o_i o_j
  std::vector<RestMoments> out = in;
  for (std::size_t i = 0; i < in.size(); ++i) {
    for (const int side : {-1, 1}) {
      std::int32_t n = static_cast<std::int32_t>(i);
      for (int o = 1; o <= batch.settings.width; ++o) {
        n = batch.link[n][2 * axis + (side > 0)];
        if (n < 0) break;
        const RestMoments& m = in[n];
        const double s = side * o;
        for (int k = 0; k < 10; ++k) out[i][k] += m[k];
        for (int j = 0; j < 3; ++j) out[i][second[axis][j]] += s * m[1 + j] * (j == axis ? 2 : 1);
        out[i][1 + axis] += s * m[0];
        out[i][4 + axis] += s * s * m[0];
      }
    }
  }
  return out;
}

LinkedLattice bare_lattice(const FlsmBatch& batch) {
  LinkedLattice lattice{batch.index, batch.link, batch.branches};
  const auto nodes = static_cast<std::int32_t>(batch.index.size());
  lattice.link.resize(batch.index.size());
  for (auto& links : lattice.link) {
    for (std::int32_t& n : links) {
      if (n >= nodes) n = -1;
    }
  }
  return lattice;
}

LinkedLattice filled_lattice(const FlsmBatch& batch) {
  LinkedLattice lattice{batch.index, batch.link, batch.branches, batch.fillers};
  lattice.index.insert(lattice.index.end(), batch.filler_index.begin(), batch.filler_index.end());
  return lattice;
}

/// Returns the batch of the same body and width in the previous model.
const FlsmBatch* batch_before(const FlsmBatch& batch, const Model* previous) {
  if (previous == nullptr) return nullptr;
  const auto found = std::find_if(previous->flsm.begin(), previous->flsm.end(), [&](const FlsmBatch& other) {
    return other.body == batch.body && other.settings.width == batch.settings.width;
  });
  return found == previous->flsm.end() ? nullptr : &*found;
}

}  // namespace

FlsmBatch place_matching_nodes(const BodyElements& solid, const Body& body, std::int32_t number,
                               std::vector<std::int32_t>& slot, const Model* previous, Model& model) {
  FlsmBatch batch;
  batch.body = number;
  batch.settings = body.model;
  batch.spacing = solid.spacing;
  batch.density = body.material.density;
  const std::vector<std::int32_t> own = nodes_in_order(solid, NodeKind::matching),
                                  shared = nodes_in_order(solid, NodeKind::interface);
  batch.own = static_cast<std::int32_t>(own.size());
  batch.interface = static_cast<std::int32_t>(shared.size());
  // One slot without a node for the region that represents absent ones, and one for each padding region in the interface's
  // last tile.
  batch.first_slot = model.slots;
  batch.slots = (batch.own + 1 + PLIANT_TILE + PLIANT_TILE - 1) / PLIANT_TILE * PLIANT_TILE;
  model.slots += batch.slots;
  for (std::size_t i = 0; i < own.size(); ++i) slot[own[i]] = batch.first_slot + static_cast<std::int32_t>(i);
  std::vector<std::int32_t> in_batch(solid.nodes.size(), -1);
  for (const auto* nodes : {&own, &shared}) {
    for (const std::int32_t n : *nodes) {
      in_batch[n] = static_cast<std::int32_t>(batch.slot.size());
      batch.slot.push_back(slot[n]);
      batch.index.push_back(solid.lattice_nodes[n].index);
    }
  }
  batch.matter = matter_of(solid, in_batch, batch.slot.size());
  batch.poisson = std::clamp(body.material.moduli.poisson(), 0.0, kMostPoisson);
  link_nodes(solid, in_batch, batch);
  require_width(body, batch);
  const FlsmBatch* before = batch_before(batch, previous);
  if (before != nullptr && same_links(batch, *before)) {
    batch.link = before->link;
    batch.fillers = before->fillers;
    batch.filler_index = before->filler_index;
    batch.regions = before->regions;
    batch.bare = before->bare;
  } else {
    find_batch_regions(batch, before);
  }
  return batch;
}

void find_batch_regions(FlsmBatch& batch, const FlsmBatch* before) {
  const int width = batch.settings.width;
  LinkedLattice lattice = bare_lattice(batch);
  FlsmRegions bare;
  if (before != nullptr && before->bare != nullptr) {
    const LinkedLattice known = bare_lattice(*before);
    const KnownRegions of_bare{known, *before->bare};
    bare = find_regions(lattice, width, &of_bare);
    add_fillers(lattice, bare);
    const LinkedLattice filled = filled_lattice(*before);
    const KnownRegions of_filled{filled, before->regions};
    batch.regions = find_regions(lattice, width, &of_filled);
  } else {
    bare = find_regions(lattice, width);
    add_fillers(lattice, bare);
    batch.regions = find_regions(lattice, width);
  }
  batch.fillers = lattice.fillers;
  batch.filler_index.assign(lattice.index.end() - lattice.fillers, lattice.index.end());
  batch.link = std::move(lattice.link);
  if (before != nullptr) batch.bare = std::make_shared<const FlsmRegions>(std::move(bare));
}

void weigh(FlsmBatch& batch, const std::vector<double>& mass) {
  batch.weight.resize(batch.slot.size());
  for (std::size_t i = 0; i < batch.slot.size(); ++i) batch.weight[i] = mass[batch.slot[i]] / batch.regions.holders[i];
}

std::vector<RestMoments> rest_moments(const FlsmBatch& batch) {
  std::vector<RestMoments> moments(batch.link.size(), RestMoments{});
  for (std::size_t i = 0; i < batch.slot.size(); ++i) moments[i][0] = batch.weight[i];
  for (int axis = 0; axis < 3; ++axis) moments = along(axis, batch, moments);
  moments.resize(batch.slot.size());
  const FlsmRegions& regions = batch.regions;
  for (std::size_t r = 0; r < moments.size(); ++r) {
    for (std::int32_t e = regions.missing_offset[r]; e < regions.missing_offset[r + 1]; ++e) {
      const RegionEntry& entry = regions.missing[e];
      const double m = entry.sign * batch.weight[entry.other], x = entry.offset[0], y = entry.offset[1], z = entry.offset[2];
      const RestMoments added{m, m * x, m * y, m * z, m * x * x, m * y * y, m * z * z, m * x * y, m * x * z, m * y * z};
      for (int k = 0; k < 10; ++k) moments[r][k] += added[k];
    }
  }
  return moments;
}

}  // namespace pliant
