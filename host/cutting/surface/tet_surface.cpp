#include "cutting/surface/tet_surface.h"

#include <algorithm>
#include <limits>
#include <map>

#include "geometry/vec.h"

namespace pliant {
namespace {

/// Where vertices of the division lie: on an edge, on a face, in the middle of a cell, or half way between an edge's and a
/// face's. `side`: the node or component on whose side of the cut it is.
struct Key {
  enum Kind { edge, face, centre, middle } kind;
  std::array<std::int32_t, 5> what{-1, -1, -1, -1, -1};
  std::int32_t side = -1;
  friend auto operator<=>(const Key&, const Key&) = default;
};

class TetSurface {
 public:
  TetSurface(const CutTopology& cut, const BodyMesh& uncut, BodySurface& solid) : cut_(cut), uncut_(uncut), solid_(solid) {}

  void run() {
    solid_.surface.resize(uncut_.surface.size());
    solid_.changes.reset();
    solid_.surface_nodes = uncut_.surface_nodes;
    solid_.surface_weights = uncut_.surface_weights;
    solid_.triangles = uncut_.triangles;
    solid_.triangle_cut.assign(uncut_.triangles.size(), 0);
    original_.resize(uncut_.triangles.size());
    for (std::size_t t = 0; t < original_.size(); ++t) original_[t] = static_cast<std::int32_t>(t);
    find_edges();
    for (std::size_t t = 0; t < uncut_.triangles.size(); ++t) divide_triangle(t);
    for (const auto& [cell, how] : cut_.cells()) {
      if (how.components > 1) add_caps(cell, how);
    }
    set_middles();
  }

 private:
  /// An edge with a cut face around it.
  struct CutEdge {
    bool merged = false;      ///< both sides are one somewhere around it: the front of a cut
    std::int32_t whole = -1;  ///< the cell in which they are
    std::int32_t cell = -1;   ///< a cell in which they are not
  };

  [[nodiscard]] int label(std::int32_t cell, int corner) const {
    const auto found = cut_.cells().find(cell);
    return found == cut_.cells().end() ? 0 : found->second.label[corner];
  }
  [[nodiscard]] int corner_of(std::int32_t cell, std::int32_t node) const {
    const auto& nodes = cut_.mesh().cells[cell];
    const auto found = std::find(nodes.begin(), nodes.begin() + 4, node);
    return found == nodes.begin() + 4 ? -1 : static_cast<int>(found - nodes.begin());
  }
  [[nodiscard]] int label_of(std::int32_t cell, std::int32_t node) const { return label(cell, corner_of(cell, node)); }

  void find_edges() {
    for (const auto& [cell, how] : cut_.cells()) {
      if (how.components < 2) continue;
      for (const auto& [i, j] : kTetEdges) {
        if (how.label[i] == how.label[j]) continue;
        const NodePair pair = node_pair(cut_.mesh().cells[cell][i], cut_.mesh().cells[cell][j]);
        const auto [at, added] = edges_.try_emplace(pair);
        if (!added) continue;
        at->second.cell = cell;
        for (const std::int32_t c : cut_.cells_at_edge(pair)) {
          if (label_of(c, pair[0]) != label_of(c, pair[1])) continue;
          at->second.merged = true;
          at->second.whole = c;
          break;
        }
      }
    }
  }

  /// The vertex of this key; the first time it is embedded in the cell's copy of a component.
  std::int32_t vertex(const Key& key, const Vec3d& rest, std::int32_t cell, int component,
                      const std::array<double, 4>& weight) {
    const auto [at, added] = vertex_of_.try_emplace(key, static_cast<std::int32_t>(solid_.surface.size()));
    if (!added) return at->second;
    const std::int32_t element = cut_.element_of(cell, component);
    const auto& nodes = cut_.elements().nodes[element >= 0 ? element : cell];
    std::array<std::int32_t, 8> eight{};
    eight.fill(nodes[0]);
    std::array<double, 8> weights{};
    for (std::size_t a = 0; a < 4; ++a) {
      eight[a] = nodes[a];
      weights[a] = weight[a];
    }
    solid_.surface.push_back(rest);
    solid_.surface_nodes.push_back(eight);
    solid_.surface_weights.push_back(weights);
    return at->second;
  }

  /// Where an edge is cut, on the side of one of its nodes.
  std::int32_t edge_vertex(const NodePair& pair, std::int32_t side) {
    const CutEdge& edge = edges_.at(pair);
    const std::int32_t cell = edge.merged ? edge.whole : edge.cell;
    const double t = cut_.edges().at(pair);
    std::array<double, 4> weight{};
    weight[static_cast<std::size_t>(corner_of(cell, pair[0]))] = 1 - t;
    weight[static_cast<std::size_t>(corner_of(cell, pair[1]))] = t;
    const Vec3d &a = cut_.mesh().rest[pair[0]], &b = cut_.mesh().rest[pair[1]];
    return vertex({Key::edge, {pair[0], pair[1]}, edge.merged ? -1 : side}, vec::add(a, vec::mul(vec::sub(b, a), t)), cell,
                  label_of(cell, side), weight);
  }

  /// The lowest node of a face whose material is that of `node` at the face's point.
  [[nodiscard]] std::int32_t class_at(std::int32_t cell, int face, std::int32_t node) const {
    std::array<std::int32_t, 3> nodes{}, root{};
    for (std::size_t i = 0; i < 3; ++i) nodes[i] = root[i] = cut_.mesh().cells[cell][kTetFaces[face][i]];
    const auto join_in = [&](std::int32_t c) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          if (label_of(c, nodes[i]) != label_of(c, nodes[j])) continue;
          const std::int32_t low = std::min(root[i], root[j]), high = std::max(root[i], root[j]);
          std::replace(root.begin(), root.end(), high, low);
        }
      }
    };
    join_in(cell);
    for (const std::int32_t other : cut_.cells_at_face(cell, face)) join_in(other);
    return root[static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin())];
  }

  std::int32_t face_vertex(std::int32_t cell, int face, std::int32_t node) {
    std::array<std::int32_t, 3> nodes{};
    for (std::size_t i = 0; i < 3; ++i) nodes[i] = cut_.mesh().cells[cell][kTetFaces[face][i]];
    std::sort(nodes.begin(), nodes.end());
    const Key key{Key::face, {nodes[0], nodes[1], nodes[2]}, class_at(cell, face, node)};
    return vertex(key, cut_.tet(cell, 0).face[face], cell, label_of(cell, node), division(cell).face[face]);
  }

  [[nodiscard]] TetDivision division(std::int32_t cell) const { return cut_.division(cell, 0); }

  /// The cell behind a triangle of the boundary, and which of its faces that is.
  [[nodiscard]] std::array<std::int32_t, 2> behind(const std::array<std::int32_t, 3>& nodes) const {
    for (const std::int32_t c : cut_.cells_at_edge(node_pair(nodes[0], nodes[1]))) {
      if (corner_of(c, nodes[2]) < 0) continue;
      for (int f = 0; f < 4; ++f) {
        const std::int32_t opposite = cut_.mesh().cells[c][f];
        if (std::find(nodes.begin(), nodes.end(), opposite) == nodes.end()) return {c, f};
      }
    }
    return {-1, -1};
  }

  void divide_triangle(std::size_t t) {
    const auto corners = uncut_.triangles[t];
    std::array<std::int32_t, 3> node{};
    std::array<bool, 3> split{};
    for (std::size_t i = 0; i < 3; ++i) node[i] = uncut_.surface_nodes[corners[i]][0];
    for (std::size_t i = 0; i < 3; ++i) split[i] = edges_.contains(node_pair(node[i], node[(i + 1) % 3]));
    if (!split[0] && !split[1] && !split[2]) return;
    const auto [cell, face] = behind(node);
    if (cell < 0) return;
    std::vector<std::array<std::int32_t, 3>> parts;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const std::int32_t near = face_vertex(cell, face, node[i]);
      if (!split[i]) {
        parts.push_back({corners[i], corners[j], near});
        continue;
      }
      const NodePair pair = node_pair(node[i], node[j]);
      parts.push_back({corners[i], edge_vertex(pair, node[i]), near});
      parts.push_back({edge_vertex(pair, node[j]), corners[j], face_vertex(cell, face, node[j])});
    }
    solid_.triangles[t] = parts.front();
    for (std::size_t p = 1; p < parts.size(); ++p) add(parts[p], static_cast<std::int32_t>(t));
  }

  void add(const std::array<std::int32_t, 3>& triangle, std::int32_t original) {
    solid_.triangles.push_back(triangle);
    solid_.triangle_cut.push_back(static_cast<char>(original < 0));
    original_.push_back(original);
  }

  /// Both sides of the cut inside a cell.
  void add_caps(std::int32_t cell, const CellCut& how) {
    const auto& nodes = cut_.mesh().cells[cell];
    const CutTet tet = cut_.tet(cell, 0);
    const TetDivision parts = division(cell);
    for (const auto& [i, j] : kTetEdges) {
      if (how.label[i] == how.label[j]) continue;
      const NodePair pair = node_pair(nodes[i], nodes[j]);
      for (int f = 0; f < 4; ++f) {
        if (f == i || f == j) continue;  // face f lies opposite corner f
        for (const bool first : {true, false}) {
          const int own = first ? i : j, other = first ? j : i;
          const std::int32_t c = vertex({Key::centre, {cell}, how.label[own]}, tet.centre, cell, how.label[own], parts.centre);
          add_cap(cell, f, pair, own, other, c);
        }
      }
    }
  }

  void add_cap(std::int32_t cell, int face, const NodePair& pair, int own, int other, std::int32_t centre) {
    const auto& nodes = cut_.mesh().cells[cell];
    const std::int32_t on_edge = edge_vertex(pair, nodes[own]), on_face = face_vertex(cell, face, nodes[own]);
    const Vec3d &e = solid_.surface[on_edge], &f = solid_.surface[on_face];
    // Outward is from the own corner to the other one: the third corner of the face says which way round that is.
    const int third = 6 - face - own - other;
    const auto& x = cut_.mesh().rest;
    const Vec3d a = x[nodes[own]], u = vec::sub(x[nodes[other]], a), v = vec::sub(x[nodes[third]], a);
    const bool turn = vec::dot(vec::cross(u, v), vec::sub(x[nodes[face]], a)) < 0;
    const auto put = [&](std::int32_t p, std::int32_t q) {
      if (turn) std::swap(p, q);
      add({p, q, centre}, -1);
    };
    if (!pinched(cell, face, pair)) return put(on_edge, on_face);
    std::array<std::int32_t, 3> key{nodes[own], nodes[other], nodes[third]};
    std::sort(key.begin(), key.end());
    const TetDivision parts = division(cell);
    std::array<double, 4> weight{};
    const double t = cut_.edges().at(pair);
    weight[corner_of(cell, pair[0])] = 0.5 * (1 - t);
    weight[corner_of(cell, pair[1])] = 0.5 * t;
    for (std::size_t k = 0; k < 4; ++k) weight[k] += 0.5 * parts.face[face][k];
    const std::int32_t middle = vertex({Key::middle, {key[0], key[1], key[2], pair[0], pair[1]}, nodes[own]},
                                       vec::mul(vec::add(e, f), 0.5), cell, label_of(cell, nodes[own]), weight);
    put(on_edge, middle);
    put(middle, on_face);
  }

  /// Whether two sides of the cut meet at both ends of the line from an edge's point to a face's point and not between them.
  [[nodiscard]] bool pinched(std::int32_t cell, int face, const NodePair& pair) const {
    if (!edges_.at(pair).merged || class_at(cell, face, pair[0]) != class_at(cell, face, pair[1])) return false;
    const auto across = cut_.cells_at_face(cell, face);
    return std::none_of(across.begin(), across.end(),
                        [&](std::int32_t c) { return label_of(c, pair[0]) == label_of(c, pair[1]); });
  }

  void set_middles() {
    const double none = std::numeric_limits<double>::quiet_NaN();
    solid_.triangle_middle.assign(solid_.triangles.size(), {none, none, none});
    for (std::size_t t = 0; t < solid_.triangles.size(); ++t) {
      if (original_[t] < 0) continue;
      const auto& [a, b, c] = uncut_.triangles[original_[t]];
      solid_.triangle_middle[t] =
          vec::mul(vec::add(vec::add(uncut_.surface[a], uncut_.surface[b]), uncut_.surface[c]), 1.0 / 3);
    }
  }

  const CutTopology& cut_;
  const BodyMesh& uncut_;
  BodySurface& solid_;
  std::map<NodePair, CutEdge> edges_;
  std::map<Key, std::int32_t> vertex_of_;
  std::vector<std::int32_t> original_;
};

}  // namespace

void cut_tet_surface(const CutTopology& cut, const BodyMesh& uncut, BodySurface& solid) { TetSurface(cut, uncut, solid).run(); }

}  // namespace pliant
