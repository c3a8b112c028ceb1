// Edits: from new cut edges to changed cells, and from those to elements.
#include "cutting/topology/cut_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lattice/lattice_parts.h"
#include "pliant/error.h"

namespace pliant {

CutTopology::CutTopology(std::shared_ptr<const CutMesh> mesh) : mesh_(std::move(mesh)) {
  const auto nodes = static_cast<std::int32_t>(mesh_->rest.size());
  const int corners = mesh_->shape->corners;
  node_offset_.assign(mesh_->rest.size() + 1, 0);
  for (std::size_t c = 0; c < mesh_->cells.size(); ++c) {
    for (int a = 0; a < corners; ++a) {
      const std::int32_t n = mesh_->cells[c][a];
      if (n < 0 || n >= nodes) {
        throw Error(ErrorCode::internal, fmt::format("cell {} of a body to cut names node {} of {}", c, n, nodes));
      }
      ++node_offset_[n + 1];
    }
  }
  std::partial_sum(node_offset_.begin(), node_offset_.end(), node_offset_.begin());
  node_cells_.resize(mesh_->cells.size() * static_cast<std::size_t>(corners));
  std::vector<std::int32_t> next(node_offset_.begin(), node_offset_.end() - 1);
  for (std::size_t c = 0; c < mesh_->cells.size(); ++c) {
    for (int a = 0; a < corners; ++a) node_cells_[next[mesh_->cells[c][a]]++] = static_cast<std::int32_t>(c);
  }
  find_neighbors();
  reset({});
}

void CutTopology::find_neighbors() {
  const CellShape& shape = *mesh_->shape;
  face_offset_.assign(1, 0);
  face_offset_.reserve(mesh_->cells.size() * shape.faces.size() + 1);
  for (std::size_t c = 0; c < mesh_->cells.size(); ++c) {
    const auto& corners = mesh_->cells[c];
    for (const auto& face : shape.faces) {
      for (const std::int32_t other : cells_at_node(corners[face[0]])) {
        if (other == static_cast<std::int32_t>(c)) continue;
        const auto& there = mesh_->cells[other];
        const bool shared = std::all_of(face.begin() + 1, face.end(), [&](int a) {
          return std::find(there.begin(), there.begin() + shape.corners, corners[a]) != there.begin() + shape.corners;
        });
        if (shared) face_cells_.push_back(other);
      }
      face_offset_.push_back(static_cast<std::int32_t>(face_cells_.size()));
    }
  }
}

std::span<const std::int32_t> CutTopology::cells_at_node(std::int32_t node) const {
  return {node_cells_.data() + node_offset_[node], node_cells_.data() + node_offset_[node + 1]};
}

std::span<const std::int32_t> CutTopology::cells_at_face(std::int32_t cell, int face) const {
  const std::size_t at = static_cast<std::size_t>(cell) * mesh_->shape->faces.size() + static_cast<std::size_t>(face);
  return {face_cells_.data() + face_offset_[at], face_cells_.data() + face_offset_[at + 1]};
}

const CellCut* CutTopology::find_cell(std::int32_t cell) const { return cell_at_[cell]; }

namespace {

bool is_cut_in_part(const CellShape& shape, const CellCut& cell) {
  for (std::size_t e = 0; e < shape.edges.size(); ++e) {
    if ((cell.cut >> e & 1) != 0 && cell.label[shape.edges[e][0]] == cell.label[shape.edges[e][1]]) return true;
  }
  return false;
}

}  // namespace

std::int64_t CutTopology::cut_in_part() const {
  return std::count_if(cells_.begin(), cells_.end(),
                       [this](const auto& entry) { return is_cut_in_part(*mesh_->shape, entry.second); });
}

std::int64_t CutTopology::cut_in_part(std::span<const std::int32_t> cells) const {
  return std::count_if(cells.begin(), cells.end(), [this](std::int32_t c) {
    return cell_at_[c] != nullptr && is_cut_in_part(*mesh_->shape, *cell_at_[c]);
  });
}

std::int32_t CutTopology::element_of(std::int32_t cell, int label) const {
  const CellCut* cut = find_cell(cell);
  return cut == nullptr ? cell : cut->element[label];
}

void CutTopology::reset(const CutEdges& edges) {
  edges_.clear();
  cells_.clear();
  cell_at_.assign(mesh_->cells.size(), nullptr);
  classes_.clear();
  elements_.nodes = mesh_->cells;
  elements_.fill = mesh_->fill;
  elements_.cell.resize(mesh_->cells.size());
  std::iota(elements_.cell.begin(), elements_.cell.end(), 0);
  elements_.real.assign(mesh_->cells.size(), static_cast<std::uint8_t>((1 << mesh_->shape->corners) - 1));
  elements_.origin.resize(mesh_->rest.size());
  std::iota(elements_.origin.begin(), elements_.origin.end(), 0);
  if (!edges.empty()) cut(edges);
}

/// Number in the shape of the edge between two nodes of a cell, -1 if it has none.
int CutTopology::edge_of(std::int32_t cell, std::int32_t a, std::int32_t b) const {
  const auto& corners = mesh_->cells[cell];
  int from = -1, to = -1;
  for (int i = 0; i < mesh_->shape->corners; ++i) {
    if (corners[i] == a) from = i;
    if (corners[i] == b) to = i;
  }
  return from >= 0 && to >= 0 ? mesh_->shape->edge_of[from][to] : -1;
}

std::vector<std::int32_t> CutTopology::cells_at_edge(const NodePair& edge) const {
  std::vector<std::int32_t> cells;
  for (const std::int32_t c : cells_at_node(edge[0])) {
    if (edge_of(c, edge[0], edge[1]) >= 0) cells.push_back(c);
  }
  return cells;
}

CutEdit CutTopology::cut(const CutEdges& edges, const std::function<void(const std::vector<std::int32_t>&)>& divided) {
  CutEdit edit;
  const OldCuts old = mark(edges, edit);
  bool split = false;
  for (const std::int32_t c : edit.cells) {
    CellCut& cell = cells_.at(c);
    label(cell);
    share(c, cell);
    inherit(old.at(c), cell);
    split |= cell.components > 1;
  }
  if (!split) return edit;
  if (divided) divided(edit.cells);
  const auto copies = elements_.nodes.begin() + static_cast<std::ptrdiff_t>(mesh_->cells.size());
  const std::vector<std::array<std::int32_t, 8>> old_copies(copies, elements_.nodes.end());
  number_elements(old, edit);
  number_nodes(old, old_copies, edit);
  return edit;
}

/// Enter new cut edges; returns what the cells there were before.
CutTopology::OldCuts CutTopology::mark(const CutEdges& edges, CutEdit& edit) {
  const auto nodes = static_cast<std::int32_t>(mesh_->rest.size());
  for (const auto& [pair, t] : edges) {
    const auto [a, b] = pair;
    bool known = a >= 0 && a < b && b < nodes;
    if (known) {
      const auto around = cells_at_node(a);
      known = std::any_of(around.begin(), around.end(), [&, a = a, b = b](std::int32_t c) { return edge_of(c, a, b) >= 0; });
    }
    if (!known)
      throw Error(ErrorCode::bad_input,
                  fmt::format("a cut edge from node {} to node {}: no cell of the body has this edge", a, b));
    if (!(t > 0 && t < 1)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("a cut edge from node {} to node {} at {}: allowed are places between 0 and 1", a, b, t));
    }
  }
  OldCuts old;
  for (const auto& [pair, t] : edges) {
    if (!edges_.emplace(pair, std::clamp(t, kLeastCrossing, 1 - kLeastCrossing)).second) continue;
    for (const std::int32_t c : cells_at_node(pair[0])) {
      const int e = edge_of(c, pair[0], pair[1]);
      if (e < 0) continue;
      auto [at, added] = cells_.try_emplace(c);
      if (added) {
        cell_at_[c] = &at->second;
        at->second.element[0] = c;
        at->second.share[0] = 1;
      }
      old.emplace(c, at->second);
      at->second.cut |= 1U << e;
    }
  }
  for (const auto& [c, cut] : old) edit.cells.push_back(c);
  return old;
}

void CutTopology::label(CellCut& cell) const {
  const CellShape& shape = *mesh_->shape;
  std::array<int, 8> root{};
  std::iota(root.begin(), root.end(), 0);
  for (std::size_t e = 0; e < shape.edges.size(); ++e) {
    if (cell.cut >> e & 1) continue;
    const int a = root[shape.edges[e][0]], b = root[shape.edges[e][1]];
    if (a == b) continue;
    for (int& r : root) r = r == std::max(a, b) ? std::min(a, b) : r;
  }
  cell.components = 0;
  for (int a = 0; a < shape.corners; ++a) {
    cell.label[a] = root[a] == a ? static_cast<std::int8_t>(cell.components++) : cell.label[root[a]];
  }
}

/// Number the copies, ascending by cell and component, and give each its fill.
void CutTopology::number_elements(const OldCuts& old, CutEdit& edit) {
  const std::size_t cells = mesh_->cells.size();
  elements_.nodes.resize(cells);
  elements_.cell.resize(cells);
  elements_.real.resize(cells);
  elements_.fill.resize(cells);
  edit.element_from.resize(cells);
  std::iota(edit.element_from.begin(), edit.element_from.end(), 0);
  for (auto& [c, cut] : cells_) {
    if (cut.components < 2) continue;
    const auto changed = old.find(c);
    const CellCut before = changed == old.end() ? cut : changed->second;
    bool first = true;
    cut.element.fill(-1);
    for (int k = 0; k < cut.components; ++k) {
      if (cut.share[k] <= 0) continue;
      std::int32_t e = c;
      if (!first) {
        e = static_cast<std::int32_t>(elements_.nodes.size());
        elements_.nodes.push_back(mesh_->cells[c]);
        elements_.cell.push_back(c);
        elements_.real.push_back(0);
        elements_.fill.push_back(0);
        edit.element_from.push_back(-1);
      }
      first = false;
      cut.element[k] = e;
      elements_.fill[e] = mesh_->fill[c] * cut.share[k];
      int parent = -1;
      elements_.real[e] = 0;
      for (int a = 0; a < mesh_->shape->corners; ++a) {
        if (cut.label[a] != k) continue;
        elements_.real[e] |= static_cast<std::uint8_t>(1 << a);
        if (parent < 0) parent = before.label[a];
      }
      // A component that had no material before takes over from any copy of its cell: all start from the same place.
      const std::int32_t from = before.element[parent];
      edit.element_from[e] = from >= 0 ? from : c;
    }
  }
}

}  // namespace pliant
