#include "cutting/topology/cut_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/disjoint_sets.h"
#include "pliant/error.h"

namespace pliant {

CutTopology::CutTopology(std::shared_ptr<const CutMesh> mesh)
    : mesh_(std::move(mesh)), neighbors_(*mesh_), division_(*mesh_, edges_), nodes_(*mesh_, neighbors_, cell_at_) {
  reset({});
}

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
  const CellCut* cut = cell_at_[cell];
  return cut == nullptr ? cell : cut->element[label];
}

void CutTopology::reset(const CutEdges& edges) {
  edges_.clear();
  edit_ = 0;
  cells_.clear();
  cell_at_.assign(mesh_->cells.size(), nullptr);
  nodes_.clear();
  elements_.nodes = mesh_->cells;
  elements_.fill = mesh_->fill;
  elements_.cell.resize(mesh_->cells.size());
  std::iota(elements_.cell.begin(), elements_.cell.end(), 0);
  elements_.real.assign(mesh_->cells.size(), static_cast<std::uint8_t>((1 << mesh_->shape->corners) - 1));
  elements_.origin.resize(mesh_->rest.size());
  std::iota(elements_.origin.begin(), elements_.origin.end(), 0);
  if (!edges.empty()) cut(edges);
}

CutEdit CutTopology::cut(const CutEdges& edges, const std::function<void(const std::vector<std::int32_t>&)>& divided) {
  CutEdit edit;
  const OldCuts old = mark(edges, edit);
  bool split = false;
  for (const std::int32_t c : edit.cells) {
    CellCut& cell = cells_.at(c);
    label_components(*mesh_->shape, cell);
    division_.place_centres(cell);
    division_.share(c, cell);
    division_.inherit(old.at(c), cell);
    split |= cell.components > 1;
  }
  if (!split) return edit;
  if (divided) divided(edit.cells);
  const auto copies = elements_.nodes.begin() + static_cast<std::ptrdiff_t>(mesh_->cells.size());
  const std::vector<std::array<std::int32_t, 8>> old_copies(copies, elements_.nodes.end());
  number_elements(old, edit);
  nodes_.number(old_copies, elements_, edit);
  return edit;
}

void CutTopology::check(const CutEdges& edges) const {
  const auto nodes = static_cast<std::int32_t>(mesh_->rest.size());
  for (const auto& [pair, t] : edges) {
    const auto [a, b] = pair;
    bool known = a >= 0 && a < b && b < nodes;
    if (known) {
      const auto around = neighbors_.at_node(a);
      known = std::any_of(around.begin(), around.end(),
                          [&, a = a, b = b](std::int32_t c) { return neighbors_.edge_of(c, a, b) >= 0; });
    }
    if (!known)
      throw Error(ErrorCode::bad_input,
                  fmt::format("a cut edge from node {} to node {}: no cell of the body has this edge", a, b));
    if (!(t > 0 && t < 1)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("a cut edge from node {} to node {} at {}: allowed are places between 0 and 1", a, b, t));
    }
  }
}

/// Enter new cut edges; returns what the cells there were before.
CutTopology::OldCuts CutTopology::mark(const CutEdges& edges, CutEdit& edit) {
  check(edges);
  OldCuts old;
  ++edit_;
  for (const auto& [pair, t] : edges) {
    if (!edges_.emplace(pair, std::clamp(t, kLeastCrossing, 1 - kLeastCrossing)).second) continue;
    for (const std::int32_t c : neighbors_.at_node(pair[0])) {
      const int e = neighbors_.edge_of(c, pair[0], pair[1]);
      if (e < 0) continue;
      auto [at, added] = cells_.try_emplace(c);
      if (added) {
        cell_at_[c] = &at->second;
        at->second.element[0] = c;
        at->second.share[0] = 1;
      }
      old.emplace(c, at->second);
      at->second.cut |= 1U << e;
      at->second.when[e] = edit_;
    }
  }
  for (const auto& [c, cut] : old) edit.cells.push_back(c);
  return old;
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

std::int32_t CutTopology::pieces(std::vector<std::int32_t>* piece_of) const {
  DisjointSets sets(elements_.origin.size());
  for (const auto& nodes : elements_.nodes) {
    for (int a = 1; a < mesh_->shape->corners; ++a) sets.join(nodes[0], nodes[a]);
  }
  std::vector<std::int32_t> number(elements_.origin.size(), -1);
  std::int32_t count = 0;
  if (piece_of != nullptr) piece_of->clear();
  for (const auto& nodes : elements_.nodes) {
    std::int32_t& n = number[sets.find(nodes[0])];
    if (n < 0) n = count++;
    if (piece_of != nullptr) piece_of->push_back(n);
  }
  return count;
}

}  // namespace pliant
