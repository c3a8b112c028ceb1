#include "cutting/topology/cut_nodes.h"

#include <algorithm>
#include <span>

#include "geometry/disjoint_sets.h"

namespace pliant {
namespace {

int corner_of(const CutMesh& mesh, std::int32_t cell, std::int32_t node) {
  const auto& corners = mesh.cells[cell];
  return static_cast<int>(std::find(corners.begin(), corners.begin() + mesh.shape->corners, node) - corners.begin());
}

}  // namespace

const CellCut& CutNodes::cut_of(std::int32_t cell) const {
  static constexpr CellCut kWhole{};
  return cells_[cell] == nullptr ? kWhole : *cells_[cell];
}

/// Groups the copies around one node of the uncut body into nodes.
class CutNodes::Grouping {
 public:
  Grouping(const CutNodes& nodes, std::int32_t node)
      : nodes_(nodes), around_(nodes.neighbors_.at_node(node)), number_(around_.size()), corner_at_(around_.size()) {
    for (std::size_t i = 0; i < around_.size(); ++i) {
      const std::int32_t c = around_[i];
      corner_at_[i] = corner_of(nodes_.mesh_, c, node);
      for (int k = 0; k < nodes_.cut_of(c).components; ++k) {
        number_[i][k] = nodes_.element_of(c, k) < 0 ? -1 : static_cast<std::int32_t>(members_.size());
        if (number_[i][k] >= 0) members_.push_back({c, static_cast<std::int8_t>(k), static_cast<std::int8_t>(corner_at_[i])});
      }
    }
  }

  /// Returns the nodes: the real one first, then by their lowest copy.
  std::vector<NodeClass> classes() {
    DisjointSets sets(members_.size());
    const std::int32_t real = join_all(sets);
    std::vector<NodeClass> classes;
    std::vector<std::int32_t> place(members_.size(), -1);
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const std::int32_t root = sets.find(static_cast<std::int32_t>(m));
      if (place[root] < 0) {
        place[root] = static_cast<std::int32_t>(classes.size());
        classes.push_back({});
        classes.back().real = real >= 0 && root == sets.find(real);
      }
      classes[place[root]].members.push_back(members_[m]);
    }
    std::stable_partition(classes.begin(), classes.end(), [](const NodeClass& c) { return c.real; });
    return classes;
  }

 private:
  /// Joins the real corners, and the corners on both sides of each face. Returns a real one, -1: there is none.
  std::int32_t join_all(DisjointSets& sets) const {
    std::int32_t real = -1;
    for (std::size_t i = 0; i < around_.size(); ++i) {
      const std::int32_t here = number_[i][nodes_.cut_of(around_[i]).label[corner_at_[i]]];
      if (real < 0) real = here;
      join(sets, real, here);
      join_across_faces(sets, i);
    }
    return real;
  }
  void join_across_faces(DisjointSets& sets, std::size_t i) const {
    const CellShape& shape = *nodes_.mesh_.shape;
    const std::int32_t c = around_[i];
    for (std::size_t f = 0; f < shape.faces.size(); ++f) {
      const auto& face = shape.faces[f];
      if (std::find(face.begin(), face.end(), corner_at_[i]) == face.end()) continue;
      for (const std::int32_t other : nodes_.neighbors_.at_face(c, static_cast<int>(f))) {
        if (other < c) continue;
        const CellCut& across = nodes_.cut_of(other);
        const auto& there =
            number_[static_cast<std::size_t>(std::find(around_.begin(), around_.end(), other) - around_.begin())];
        for (const int a : face) {
          const int corner = corner_of(nodes_.mesh_, other, nodes_.mesh_.cells[c][a]);
          join(sets, number_[i][nodes_.cut_of(c).label[a]], there[across.label[corner]]);
        }
      }
    }
  }
  static void join(DisjointSets& sets, std::int32_t a, std::int32_t b) {
    if (a >= 0 && b >= 0) sets.join(a, b);
  }

  const CutNodes& nodes_;
  const std::span<const std::int32_t> around_;       ///< cells at the node, ascending
  std::vector<std::array<std::int32_t, 8>> number_;  ///< of a cell's component among the members
  std::vector<int> corner_at_;                       ///< which corner of each cell is the node
  std::vector<Member> members_;
};

void CutNodes::number(const std::vector<std::array<std::int32_t, 8>>& old_copies, CutElements& elements, CutEdit& edit) {
  const auto cells = static_cast<std::int32_t>(mesh_.cells.size());
  std::vector<std::int32_t> touched;
  for (const std::int32_t c : edit.cells) {
    if (cut_of(c).components < 2) continue;
    touched.insert(touched.end(), mesh_.cells[c].begin(), mesh_.cells[c].begin() + mesh_.shape->corners);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  const auto node_before = [&](const Member& m) {
    const std::int32_t e = edit.element_from[element_of(m.cell, m.component)];
    return (e < cells ? elements.nodes[e] : old_copies[e - cells])[m.corner];
  };
  for (const std::int32_t n : touched) {
    std::vector<NodeClass> classes = Grouping(*this, n).classes();
    for (NodeClass& c : classes) c.node = node_before(c.members.front());
    classes_[n] = std::move(classes);
  }
  number_classes(elements, edit);
}

void CutNodes::number_classes(CutElements& elements, CutEdit& edit) {
  const auto nodes = static_cast<std::int32_t>(mesh_.rest.size());
  edit.node_from.resize(nodes);
  for (std::int32_t n = 0; n < nodes; ++n) edit.node_from[n] = n;
  elements.origin.resize(nodes);
  for (auto& [n, classes] : classes_) {
    for (std::size_t k = 0; k < classes.size(); ++k) {
      const std::int32_t before = classes[k].node;
      classes[k].node = k == 0 ? n : static_cast<std::int32_t>(elements.origin.size());
      if (k == 0) {
        edit.node_from[n] = before;
      } else {
        elements.origin.push_back(n);
        edit.node_from.push_back(before);
      }
    }
  }
  for (const auto& [n, classes] : classes_) {
    for (const NodeClass& c : classes) {
      for (const Member& m : c.members) elements.nodes[element_of(m.cell, m.component)][m.corner] = c.node;
    }
  }
}

}  // namespace pliant
