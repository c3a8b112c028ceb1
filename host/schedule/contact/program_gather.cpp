// Which contact points act on each node, and which tiles of points on each tile of nodes: what contact_apply reads.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "schedule/contact/contact_data.h"
#include "schedule/program_builder.h"

namespace pliant {
namespace {

/// A point at a node: its position in contact_force, its weight and its gradients along both tangents there, in units, and
/// the index of the node within the point.
struct PointAtNode {
  std::int32_t at = 0, units = 0, corner = 0;
  std::array<std::int32_t, 2> turns{};
};

/// The nodes of contact points with their points, ascending. Nodes of neighbouring points come together, so that what touches
/// takes few tiles.
struct PointsAtNodes {
  std::vector<std::int32_t> slot;
  std::vector<std::size_t> offset;  ///< shape [nodes, padded to whole tiles, + 1]
  std::vector<PointAtNode> points;
  [[nodiscard]] std::size_t count() const { return offset.size() - 1; }
  [[nodiscard]] std::span<const PointAtNode> of(std::size_t node) const {
    return {points.data() + offset[node], offset[node + 1] - offset[node]};
  }
};

PointsAtNodes points_at_nodes(const Model& model, bool edged) {
  const ContactPoints& points = *model.contact;
  std::vector<std::pair<std::int32_t, PointAtNode>> all;  // with the number of the node
  all.reserve(8 * points.size());
  PointsAtNodes out;
  std::vector<std::int32_t> place(static_cast<std::size_t>(model.slots), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<std::array<std::int32_t, 8>, 2> turns{};
    if (model.tissue_contact) turns = contact_tangents(points, i, model.rest).units;
    for (std::size_t a = 0; a < 8; ++a) {
      const PointAtNode entry{static_cast<std::int32_t>(tile_base(i, 4)),
                              points.weights[i][a],
                              static_cast<std::int32_t>(a),
                              {turns[0][a], turns[1][a]}};
      if (!edged && entry.units <= 0 && entry.turns[0] == 0 && entry.turns[1] == 0) continue;
      std::int32_t& number = place[static_cast<std::size_t>(points.nodes[i][a])];
      if (number < 0) {
        number = static_cast<std::int32_t>(out.slot.size());
        out.slot.push_back(points.nodes[i][a]);
      }
      all.emplace_back(number, entry);
    }
  }
  out.offset.resize(padded(out.slot.size()) + 1);
  for (const auto& [number, entry] : all) ++out.offset[static_cast<std::size_t>(number) + 1];
  std::partial_sum(out.offset.begin(), out.offset.end(), out.offset.begin());
  out.points.resize(all.size());
  std::vector<std::size_t> next = out.offset;
  for (const auto& [number, entry] : all) out.points[next[static_cast<std::size_t>(number)]++] = entry;
  return out;
}

/// Where the rows of each tile of nodes begin: as many as the most points at one of its nodes.
std::vector<std::int32_t> row_offsets(const PointsAtNodes& nodes) {
  std::vector<std::int32_t> offset{0};
  for (std::size_t n = 0; n < nodes.count(); n += PLIANT_TILE) {
    std::size_t most = 0;
    for (std::size_t l = 0; l < PLIANT_TILE; ++l) most = std::max(most, nodes.of(n + l).size());
    offset.push_back(offset.back() + static_cast<std::int32_t>(most));
  }
  return offset;
}

/// `numbers` numbers of each point, in rows of [numbers][16]: set(point, at) sets at[0], at[16], ...
template <class Set>
std::vector<std::int32_t> rows_of(const PointsAtNodes& nodes, const std::vector<std::int32_t>& offset, std::size_t numbers,
                                  const Set& set, std::int32_t none = 0) {
  std::vector<std::int32_t> rows(static_cast<std::size_t>(offset.back()) * numbers * PLIANT_TILE, none);
  for (std::size_t n = 0; n < nodes.count(); ++n) {
    std::int32_t* at =
        rows.data() + static_cast<std::size_t>(offset[n / PLIANT_TILE]) * numbers * PLIANT_TILE + n % PLIANT_TILE;
    for (const PointAtNode& point : nodes.of(n)) {
      set(point, at);
      at += numbers * PLIANT_TILE;
    }
  }
  return rows;
}

/// The tiles of points at each tile of nodes, ascending, and for each of them the entries that lead there, in the order of rows
/// (contact_apply.cl).
struct TilesAtNodes {
  std::vector<std::int32_t> offset{0}, tiles, entry_offset{0}, entry;
};

TilesAtNodes tiles_at_nodes(const PointsAtNodes& nodes, const std::vector<std::int32_t>& rows, std::size_t tiles) {
  TilesAtNodes list;
  list.entry.reserve(4 * nodes.points.size());
  std::vector<std::vector<std::int32_t>> at(tiles);  // of the tile of nodes at work: four numbers of each entry
  for (std::size_t begin = 0; begin < nodes.count(); begin += PLIANT_TILE) {
    const std::size_t before = list.tiles.size();
    const std::int32_t first = rows[begin / PLIANT_TILE], last = rows[begin / PLIANT_TILE + 1];
    for (std::int32_t row = first; row < last; ++row) {
      for (std::int32_t l = 0; l < PLIANT_TILE; ++l) {
        const std::span<const PointAtNode> points = nodes.of(begin + static_cast<std::size_t>(l));
        const auto k = static_cast<std::size_t>(row - first);
        if (k >= points.size()) continue;
        const PointAtNode& p = points[k];
        const std::int32_t tile = p.at / (4 * PLIANT_TILE), lane = p.at % PLIANT_TILE;
        std::vector<std::int32_t>& own = at[static_cast<std::size_t>(tile)];
        if (own.empty()) list.tiles.push_back(tile);
        own.insert(own.end(), {l + 16 * lane + 256 * p.corner, p.units, p.turns[0], p.turns[1]});
      }
    }
    std::sort(list.tiles.begin() + static_cast<std::ptrdiff_t>(before), list.tiles.end());
    for (std::size_t t = before; t < list.tiles.size(); ++t) {
      std::vector<std::int32_t>& own = at[static_cast<std::size_t>(list.tiles[t])];
      list.entry.insert(list.entry.end(), own.begin(), own.end());
      list.entry_offset.push_back(static_cast<std::int32_t>(list.entry.size() / 4));
      own.clear();
    }
    list.offset.push_back(static_cast<std::int32_t>(list.tiles.size()));
  }
  return list;
}

}  // namespace

/// Lists the points at each node, and the tiles of points at each tile of nodes with the entries that lead there.
void ProgramBuilder::add_contact_gather() {
  std::map<std::int32_t, std::int32_t> axes;
  for (const Constraint& c : model_.constraints) axes[c.slot] = c.axes;
  PointsAtNodes nodes = points_at_nodes(model_, edged_tools_ != 0);
  std::vector<std::int32_t> free;
  for (const std::int32_t slot : nodes.slot) {
    const auto found = axes.find(slot);
    free.push_back(found == axes.end() ? 7 : 7 & ~found->second);
  }
  const std::size_t count = nodes.count();
  free.resize(count, 0);
  nodes.slot.resize(count, -1);
  std::vector<std::int32_t> offset = row_offsets(nodes);
  const auto rows = [&](std::size_t numbers, const auto& set, std::int32_t none = 0) {
    return rows_of(nodes, offset, numbers, set, none);
  };
  using Point = const PointAtNode&;
  TilesAtNodes tiles = tiles_at_nodes(nodes, offset, model_.contact->size() / PLIANT_TILE + 1);
  add(make_ints("contact_slot", BufferRole::constant, "[contact nodes]", std::move(nodes.slot)));
  add(make_ints("contact_free", BufferRole::constant, "[contact nodes]", std::move(free)));
  add(make_ints("contact_node_list", BufferRole::control, "[tiles + 16]",
                std::vector<std::int32_t>(count / PLIANT_TILE + contact_list_end, -1), 0, "host"));
  add(make_ints("contact_tiles_offset", BufferRole::constant, "[tiles + 1]", std::move(tiles.offset)));
  add(make_ints("contact_tiles", BufferRole::constant, "[tiles of points]", std::move(tiles.tiles)));
  add(make_ints("contact_entry_offset", BufferRole::constant, "[tiles of points + 1]", std::move(tiles.entry_offset)));
  add(make_ints("contact_entry", BufferRole::constant, "[entries][4]", std::move(tiles.entry)));
  add(make_ints("contact_gather_offset", BufferRole::constant, "[tiles + 1]", offset));
  add(make_ints("contact_gather", BufferRole::constant, "[rows][16]", rows(1, [](Point p, std::int32_t* at) { *at = p.at; })));
  add(make_ints("contact_gather_units", BufferRole::constant, "[rows][16]",
                rows(1, [](Point p, std::int32_t* at) { *at = p.units; })));
  if (edged_tools_ != 0) {
    add(make_ints("contact_gather_corner", BufferRole::constant, "[rows][16]",
                  rows(
                      1, [](Point p, std::int32_t* at) { *at = p.corner; }, -1)));
  }
  if (!model_.tissue_contact) return;
  add(make_ints("contact_gather_turns", BufferRole::constant, "[rows][2][16]", rows(2, [](Point p, std::int32_t* at) {
                  at[0] = p.turns[0];
                  at[PLIANT_TILE] = p.turns[1];
                })));
}

}  // namespace pliant
