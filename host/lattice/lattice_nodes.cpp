// Which parts share a node.
#include <algorithm>
#include <map>

#include "geometry/disjoint_sets.h"
#include "lattice/lattice_parts.h"

namespace pliant {
namespace {

using Index = std::array<std::int32_t, 3>;

// A fragment of at most this many cells that lost touch with its shell is an artefact of sampling, not a limb.
constexpr std::int32_t kSmallFragment = 8;

std::uint16_t dilate(std::uint16_t face) {
  const unsigned f = face;
  const unsigned row = f | ((f & 0x7777U) << 1) | ((f >> 1) & 0x7777U);
  return static_cast<std::uint16_t>(row | (row << 4) | (row >> 4));
}

Index up(Index cell, int axis) {
  ++cell[axis];
  return cell;
}

}  // namespace

bool Contacts::touch(std::int32_t a, std::int32_t b, int axis) const {
  const CellPart &x = parts_.list[a], &y = parts_.list[b];
  const std::uint16_t from = x.open[2 * axis + 1], to = y.open[2 * axis];
  if ((from & to) != 0) return true;
  if ((x.thin || y.thin) && (dilate(from) & to) != 0) return true;
  return tied(a, b);
}

bool Contacts::tied(std::int32_t a, std::int32_t b) const {
  return !ties_.empty() && std::binary_search(ties_.begin(), ties_.end(), std::pair{std::min(a, b), std::max(a, b)});
}

// Are a and b, which share a face across `axis`, connected through the two cells on the other side of one edge of that face
// (the edge towards `side` along `across`), and does that edge run through material?
bool Contacts::around_edge(std::int32_t a, std::int32_t b, int axis, int across, int side) const {
  Index below_a = parts_.list[a].index, below_b = parts_.list[b].index;
  below_a[across] += side;
  below_b[across] += side;
  const auto meet = [&](std::int32_t x, std::int32_t y) { return side < 0 ? touch(y, x, across) : touch(x, y, across); };
  const auto [first_c, last_c] = parts_.of(below_a);
  const auto [first_d, last_d] = parts_.of(below_b);
  bool connected = false;
  for (std::int32_t c = first_c; c < last_c && !connected; ++c) {
    if (!meet(a, c)) continue;
    for (std::int32_t d = first_d; d < last_d && !connected; ++d) connected = touch(c, d, axis) && meet(b, d);
  }
  if (!connected) return false;
  const int along = 3 - axis - across;
  Vec3d p{};
  for (int n = 0; n < 3; ++n) p[n] = grid_.origin[n] + grid_.spacing * parts_.list[a].index[n];
  p[axis] += grid_.spacing;
  p[across] += side > 0 ? grid_.spacing : 0;
  for (int s = 0; s < 4; ++s) {
    Vec3d q = p;
    q[along] += grid_.spacing * (s + 0.5) / 4;
    if (surface_.inside(q)) return true;
  }
  return false;
}

void Contacts::bridge() {
  ties_.clear();
  std::vector<std::pair<std::int32_t, std::int32_t>> found;
  for (std::int32_t a = 0; a < static_cast<std::int32_t>(parts_.list.size()); ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      if (parts_.list[a].mask == kAllSamples && parts_.list[a].open[2 * axis + 1] == 0xFFFF) continue;  // touches what is there
      const auto [first, last] = parts_.of(up(parts_.list[a].index, axis));
      for (std::int32_t b = first; b < last; ++b) {
        if (touch(a, b, axis)) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (around_edge(a, b, axis, u, -1) || around_edge(a, b, axis, u, 1) || around_edge(a, b, axis, v, -1) ||
            around_edge(a, b, axis, v, 1)) {
          found.emplace_back(a, b);
        }
      }
    }
  }
  ties_ = std::move(found);
  std::sort(ties_.begin(), ties_.end());
}

std::vector<std::int32_t> Contacts::fragments() const {
  const auto count = static_cast<std::int32_t>(parts_.list.size());
  DisjointSets sets(parts_.list.size());
  for (std::int32_t a = 0; a < count; ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto [first, last] = parts_.of(up(parts_.list[a].index, axis));
      for (std::int32_t b = first; b < last; ++b) {
        if (touch(a, b, axis)) sets.join(a, b);
      }
    }
  }
  std::vector<std::int32_t> root(parts_.list.size());
  for (std::int32_t a = 0; a < count; ++a) root[a] = sets.find(a);
  return root;
}

// A sheet thinner than the samples may pass from a cell to its diagonal neighbour without leaving a trace in the two cells
// between them: such parts share the two nodes of their common edge.
void Contacts::hinge(const std::vector<std::int32_t>& root, const std::vector<char>& loose,
                     std::vector<std::pair<std::int32_t, std::int32_t>>& ties) const {
  for (std::int32_t a = 0; a < static_cast<std::int32_t>(root.size()); ++a) {
    if (loose[root[a]] == 0 || parts_.list[a].shell < 0) continue;
    for (int edge = 0; edge < 12; ++edge) {
      Index cell = parts_.list[a].index;
      cell[(edge + 1) % 3] += (edge / 3) % 2 == 0 ? -1 : 1;
      cell[(edge + 2) % 3] += edge / 6 == 0 ? -1 : 1;
      const auto [first, last] = parts_.of(cell);
      for (std::int32_t b = first; b < last; ++b) {
        if (root[a] != root[b] && parts_.list[b].shell == parts_.list[a].shell)
          ties.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }
}

std::vector<char> Contacts::mend() {
  bridge();
  const std::vector<std::int32_t> root = fragments();
  std::vector<std::int32_t> cells(root.size(), 0);
  for (const std::int32_t r : root) ++cells[r];
  std::map<std::int32_t, std::int32_t> bulk;                  // shell -> its largest fragment
  std::vector<std::pair<std::int32_t, std::int32_t>> bounds;  // (fragment, shell)
  for (std::size_t p = 0; p < root.size(); ++p) {
    const std::int32_t shell = parts_.list[p].shell;
    if (shell < 0) continue;
    bounds.emplace_back(root[p], shell);
    const auto [at, added] = bulk.try_emplace(shell, root[p]);
    if (!added && (cells[root[p]] > cells[at->second] || (cells[root[p]] == cells[at->second] && root[p] < at->second))) {
      at->second = root[p];
    }
  }
  std::sort(bounds.begin(), bounds.end());
  bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
  // A fragment is loose if it bounds some shell but is the bulk of none.
  std::vector<char> loose(root.size(), 0);
  for (const auto& [fragment, shell] : bounds) loose[fragment] = 1;
  for (const auto& [shell, fragment] : bulk) loose[fragment] = 0;
  const auto of_shell = [&](std::int32_t fragment, std::int32_t shell) {
    return std::binary_search(bounds.begin(), bounds.end(), std::pair{fragment, shell});
  };
  std::vector<char> drop(root.size(), 0), tied(root.size(), 0);
  std::vector<std::pair<std::int32_t, std::int32_t>> near, beside;
  for (std::size_t p = 0; p < root.size(); ++p) {
    const auto a = static_cast<std::int32_t>(p);
    for (int axis = 0; axis < 3; ++axis) {
      const auto [first, last] = parts_.of(up(parts_.list[a].index, axis));
      for (std::int32_t b = first; b < last; ++b) {
        if (root[a] == root[b] || (loose[root[a]] == 0 && loose[root[b]] == 0)) continue;
        const std::int32_t shell = loose[root[a]] != 0 ? parts_.list[a].shell : parts_.list[b].shell;
        if (shell >= 0 && !(of_shell(root[a], shell) && of_shell(root[b], shell))) continue;
        const bool close = (dilate(parts_.list[a].open[2 * axis + 1]) & dilate(parts_.list[b].open[2 * axis])) != 0;
        (close ? near : beside).emplace_back(a, b);
      }
    }
  }
  for (const auto& [a, b] : near) tied[root[a]] = tied[root[b]] = 1;
  for (const auto& [a, b] : beside) {
    const std::int32_t fragment = loose[root[a]] != 0 ? root[a] : root[b];
    if (tied[fragment] == 0 && cells[fragment] <= kSmallFragment) near.emplace_back(a, b);
  }
  hinge(root, loose, near);
  for (const auto& [a, b] : near) tied[root[a]] = tied[root[b]] = 1;
  ties_.insert(ties_.end(), near.begin(), near.end());
  std::sort(ties_.begin(), ties_.end());
  for (std::size_t p = 0; p < root.size(); ++p) {
    drop[p] = static_cast<char>(loose[root[p]] != 0 && tied[root[p]] == 0 && cells[root[p]] <= kSmallFragment);
  }
  return drop;
}

void number_nodes(const Parts& parts, const Contacts& contacts, Lattice& lattice) {
  lattice.cells.resize(parts.list.size());
  for (std::size_t p = 0; p < parts.list.size(); ++p) {
    lattice.cells[p].index = parts.list[p].index;
    lattice.cells[p].fill = parts.list[p].fill;
    lattice.cells[p].samples = parts.list[p].mask;
  }
  lattice.nodes.clear();
  struct Around {
    std::int32_t part;
    int cell;   // bit a set: the cell on the upper side of the point along axis a
    int group;  // position of the lowest member in the list
  };
  std::vector<Around> around;
  std::vector<std::int32_t> node;
  for (std::int32_t k = 0; k <= lattice.size[2]; ++k) {
    for (std::int32_t j = 0; j <= lattice.size[1]; ++j) {
      for (std::int32_t i = 0; i <= lattice.size[0]; ++i) {
        around.clear();
        for (int c = 0; c < 8; ++c) {
          const auto [first, last] = parts.of({i - 1 + (c & 1), j - 1 + ((c >> 1) & 1), k - 1 + (c >> 2)});
          for (std::int32_t p = first; p < last; ++p) around.push_back({p, c, static_cast<int>(around.size())});
        }
        if (around.empty()) continue;
        for (std::size_t x = 0; x < around.size(); ++x) {
          for (std::size_t y = x + 1; y < around.size(); ++y) {
            const int difference = around[x].cell ^ around[y].cell;
            const int axis = difference == 1 ? 0 : difference == 2 ? 1 : difference == 4 ? 2 : -1;
            if (around[x].group == around[y].group) continue;
            if (axis >= 0 ? !contacts.touch(around[x].part, around[y].part, axis)
                          : difference == 7 || !contacts.tied(around[x].part, around[y].part)) {
              continue;
            }
            const int keep = std::min(around[x].group, around[y].group), lose = std::max(around[x].group, around[y].group);
            for (Around& other : around) other.group = other.group == lose ? keep : other.group;
          }
        }
        node.assign(around.size(), -1);
        std::int32_t copy = 0;
        for (std::size_t x = 0; x < around.size(); ++x) {
          std::int32_t& id = node[around[x].group];
          if (id < 0) {
            id = static_cast<std::int32_t>(lattice.nodes.size());
            lattice.nodes.push_back({{i, j, k}, copy++});
          }
          lattice.cells[around[x].part].nodes[7 - around[x].cell] = id;
        }
      }
    }
  }
}

}  // namespace pliant
