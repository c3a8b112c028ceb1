// The nodes of the copies: which corners are one node, and what each node was before an edit.
#include <algorithm>

#include "cutting/topology/cut_topology.h"
#include "geometry/disjoint_sets.h"
#include "lattice/lattice_parts.h"

namespace pliant {
namespace {

int corner_of(const CutMesh& mesh, std::int32_t cell, std::int32_t node) {
  const auto& corners = mesh.cells[cell];
  return static_cast<int>(std::find(corners.begin(), corners.begin() + mesh.shape->corners, node) - corners.begin());
}

}  // namespace

/// The copies around one node of the uncut body, grouped into nodes: the real one first, then by their lowest copy.
std::vector<CutTopology::NodeClass> CutTopology::classes_at(std::int32_t node) const {
  const CellShape& shape = *mesh_->shape;
  const std::span<const std::int32_t> around = cells_at_node(node);  // ascending
  std::vector<Member> members;
  std::vector<std::array<std::int32_t, 8>> number(around.size());  // of a cell's component among the members
  std::vector<int> corner_at(around.size());
  static constexpr CellCut kWhole{};
  const auto cut_of = [&](std::int32_t cell) {
    const CellCut* cut = find_cell(cell);
    return cut == nullptr ? &kWhole : cut;
  };
  for (std::size_t i = 0; i < around.size(); ++i) {
    const std::int32_t c = around[i];
    corner_at[i] = corner_of(*mesh_, c, node);
    for (int k = 0; k < cut_of(c)->components; ++k) {
      number[i][k] = element_of(c, k) < 0 ? -1 : static_cast<std::int32_t>(members.size());
      if (number[i][k] >= 0) members.push_back({c, static_cast<std::int8_t>(k), static_cast<std::int8_t>(corner_at[i])});
    }
  }
  DisjointSets sets(members.size());
  const auto join = [&](std::int32_t a, std::int32_t b) {
    if (a >= 0 && b >= 0) sets.join(a, b);
  };
  std::int32_t real = -1;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const std::int32_t c = around[i];
    const CellCut* cut = cut_of(c);
    const std::int32_t here = number[i][cut->label[corner_at[i]]];
    if (real < 0) real = here;
    join(real, here);
    for (std::size_t f = 0; f < shape.faces.size(); ++f) {
      const auto& face = shape.faces[f];
      if (std::find(face.begin(), face.end(), corner_at[i]) == face.end()) continue;
      for (const std::int32_t other : cells_at_face(c, static_cast<int>(f))) {
        if (other < c) continue;
        const CellCut* across = cut_of(other);
        const auto& there = number[static_cast<std::size_t>(std::find(around.begin(), around.end(), other) - around.begin())];
        for (const int a : face) {
          join(number[i][cut->label[a]], there[across->label[corner_of(*mesh_, other, mesh_->cells[c][a])]]);
        }
      }
    }
  }
  std::vector<NodeClass> classes;
  std::vector<std::int32_t> place(members.size(), -1);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const std::int32_t root = sets.find(static_cast<std::int32_t>(m));
    if (place[root] < 0) {
      place[root] = static_cast<std::int32_t>(classes.size());
      classes.push_back({});
      classes.back().real = real >= 0 && root == sets.find(real);
    }
    classes[place[root]].members.push_back(members[m]);
  }
  std::stable_partition(classes.begin(), classes.end(), [](const NodeClass& c) { return c.real; });
  return classes;
}

/// Groups the corners of the copies again at the nodes of changed cells, then numbers all nodes.
void CutTopology::number_nodes(const OldCuts& old, const std::vector<std::array<std::int32_t, 8>>& old_copies, CutEdit& edit) {
  const auto cells = static_cast<std::int32_t>(mesh_->cells.size()), nodes = static_cast<std::int32_t>(mesh_->rest.size());
  std::vector<std::int32_t> touched;
  for (const auto& [c, before] : old) {
    if (cells_.at(c).components < 2) continue;
    touched.insert(touched.end(), mesh_->cells[c].begin(), mesh_->cells[c].begin() + mesh_->shape->corners);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  const auto node_before = [&](const Member& m) {
    const std::int32_t e = edit.element_from[element_of(m.cell, m.component)];
    return (e < cells ? elements_.nodes[e] : old_copies[e - cells])[m.corner];
  };
  for (const std::int32_t n : touched) {
    std::vector<NodeClass> classes = classes_at(n);
    for (NodeClass& c : classes) c.node = node_before(c.members.front());
    classes_[n] = std::move(classes);
  }
  edit.node_from.resize(nodes);
  for (std::int32_t n = 0; n < nodes; ++n) edit.node_from[n] = n;
  elements_.origin.resize(nodes);
  for (auto& [n, classes] : classes_) {
    for (std::size_t k = 0; k < classes.size(); ++k) {
      const std::int32_t before = classes[k].node;
      classes[k].node = k == 0 ? n : static_cast<std::int32_t>(elements_.origin.size());
      if (k == 0) {
        edit.node_from[n] = before;
      } else {
        elements_.origin.push_back(n);
        edit.node_from.push_back(before);
      }
    }
  }
  for (const auto& [n, classes] : classes_) {
    for (const NodeClass& c : classes) {
      for (const Member& m : c.members) elements_.nodes[element_of(m.cell, m.component)][m.corner] = c.node;
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
