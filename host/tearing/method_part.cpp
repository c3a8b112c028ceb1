// Opens a mesh of tetrahedra or hexahedra at faces: splits nodes, and separates parts that are connected only by a point or an
// edge.
#include <algorithm>
#include <map>
#include <set>

#include "cutting/topology/cut_cell.h"
#include "geometry/disjoint_sets.h"
#include "tearing/method.h"

namespace pliant {
namespace {

/// `Cell`: the corners of an element.
template <class Cell>
class Parting {
 public:
  using Cells = std::vector<Cell>;
  using Shape = ElementShape<std::tuple_size_v<Cell>>;
  using Adjacency = ElementAdjacency<std::tuple_size_v<Cell>>;

  Parting(Cells& tets, const Adjacency& around, std::vector<std::uint8_t>& cut, std::span<const std::int32_t> touched)
      : tets_(tets),
        original_(tets),
        nodes_(around.offset.size() - 1),
        cut_(cut),
        extra_(touched),
        around_(around),
        neighbors_(around.neighbors) {
    for (std::size_t t = 0; t < tets.size(); ++t) {  // both sides of a face say the same
      for (int f = 0; f < kFaces; ++f) {
        if (cut_[t] >> f & 1) open({static_cast<std::int32_t>(t), static_cast<std::int8_t>(f)});
      }
    }
  }

  /// `wait` (may be null): cut faces that may stay closed; those that do are left in it.
  std::vector<std::int32_t> run(std::vector<TetFace>* wait) {
    if (wait != nullptr) may_wait_ = std::move(*wait);
    const std::size_t rounds = 50 + may_wait_.size();  // each opens or closes some of finitely many; two or three are usual
    std::vector<std::int32_t> from = split();
    for (std::size_t round = 0; round < rounds && part_edges(); ++round) from = split();
    if (wait != nullptr) *wait = std::move(closed_);
    return from;
  }

 private:
  static constexpr int kFaces = static_cast<int>(Shape::faces.size());

  static bool has(const Cell& corners, int face, std::int32_t node) {
    const auto& f = Shape::faces[static_cast<std::size_t>(face)];
    return std::any_of(f.begin(), f.end(), [&](int k) { return corners[static_cast<std::size_t>(k)] == node; });
  }

  void open(TetFace face) {
    cut_[face.tet] |= static_cast<std::uint8_t>(1 << face.face);
    const TetFace other = neighbors_[face.tet][face.face];
    if (other.tet >= 0) cut_[other.tet] |= static_cast<std::uint8_t>(1 << other.face);
  }

  void close(TetFace face) {
    cut_[face.tet] &= static_cast<std::uint8_t>(~(1 << face.face));
    const TetFace other = neighbors_[face.tet][face.face];
    if (other.tet >= 0) cut_[other.tet] &= static_cast<std::uint8_t>(~(1 << other.face));
  }

  using Edge = std::array<std::int32_t, 2>;

  /// Whether a face has an edge. `around`: the elements of the edge.
  [[nodiscard]] bool is_at(const TetFace& face, const Edge& edge, const std::vector<std::int32_t>& around) const {
    return std::find(around.begin(), around.end(), face.tet) != around.end() && has(tets_[face.tet], face.face, edge[0]) &&
           has(tets_[face.tet], face.face, edge[1]);
  }

  /// Closes the faces at an edge that may wait. Returns false if there is none.
  bool close_at(const Edge& edge, const std::vector<std::int32_t>& around) {
    const auto first = std::stable_partition(may_wait_.begin(), may_wait_.end(),
                                             [&](const TetFace& face) { return !is_at(face, edge, around); });
    if (first == may_wait_.end()) return false;
    std::for_each(first, may_wait_.end(), [&](const TetFace& face) { close(face); });
    closed_.insert(closed_.end(), first, may_wait_.end());
    may_wait_.erase(first, may_wait_.end());
    return true;
  }

  [[nodiscard]] std::set<std::int32_t> touched_nodes() const {
    std::set<std::int32_t> touched(extra_.begin(), extra_.end());
    for (std::size_t t = 0; t < cut_.size(); ++t) {
      for (int f = 0; f < kFaces && cut_[t] != 0; ++f) {
        if (!(cut_[t] >> f & 1)) continue;
        for (const int k : Shape::faces[f]) touched.insert(original_[t][k]);
      }
    }
    return touched;
  }

  /// Makes one node for each set of tetrahedra at a node that are connected by faces there.
  std::vector<std::int32_t> split() {
    tets_ = original_;
    std::vector<std::int32_t> from(nodes_);
    for (std::size_t n = 0; n < nodes_; ++n) from[n] = static_cast<std::int32_t>(n);
    touched_ = touched_nodes();
    for (const std::int32_t n : touched_) {
      const std::span<const std::int32_t> around = around_.at(n);
      const auto place = [&](std::int32_t t) {
        const auto at = std::lower_bound(around.begin(), around.end(), t);
        return static_cast<std::int32_t>(at - around.begin());
      };
      DisjointSets sets(around.size());
      for (const std::int32_t t : around) {
        for (int f = 0; f < kFaces; ++f) {
          const std::int32_t other = neighbors_[t][f].tet;
          if (!has(original_[t], f, n) || other < 0 || (cut_[t] >> f & 1)) continue;
          sets.join(place(t), place(other));
        }
      }
      std::map<std::int32_t, std::int32_t> node_of{{0, n}};
      for (std::size_t i = 0; i < around.size(); ++i) {
        const auto [at, added] =
            node_of.emplace(sets.find(static_cast<std::int32_t>(i)), static_cast<std::int32_t>(from.size()));
        if (added) from.push_back(n);
        std::replace(tets_[around[i]].begin(), tets_[around[i]].end(), n, at->second);
      }
    }
    return from;
  }

  /// Cuts faces so that no edge connects two fans of elements, or closes those that may wait; returns false if there is none.
  bool part_edges() {
    const std::map<Edge, std::vector<std::int32_t>> singular = singular_edges();
    bool any = false;
    for (const auto& [edge, around] : singular) any = free_fan(edge, around) || any;
    if (any) return true;
    for (const auto& [edge, around] : singular) any = close_at(edge, around) || any;
    return any;
  }

  /// Edges with more than two triangles of the boundary, and the elements around each.
  std::map<Edge, std::vector<std::int32_t>> singular_edges() const {
    // Edges of the boundary near the cut, by the nodes as they are parted now, and how many triangles use each.
    std::map<Edge, int> uses;
    std::set<std::int32_t> tets;
    for (const std::int32_t n : touched_) tets.insert(around_.at(n).begin(), around_.at(n).end());
    for (const std::int32_t t : tets) {
      for (int f = 0; f < kFaces; ++f) {
        if (neighbors_[t][f].tet >= 0 && !(cut_[t] >> f & 1)) continue;
        const auto& face = Shape::faces[f];
        for (std::size_t k = 0; k < face.size(); ++k) {
          const std::int32_t a = tets_[t][face[k]], b = tets_[t][face[(k + 1) % face.size()]];
          ++uses[{std::min(a, b), std::max(a, b)}];
        }
      }
    }
    std::map<Edge, std::vector<std::int32_t>> singular;
    for (const auto& [edge, count] : uses) {
      if (count > 2) singular[edge];
    }
    if (singular.empty()) return singular;
    for (const std::int32_t t : tets) {
      for (const auto& [i, j] : Shape::edges) {
        const std::int32_t a = tets_[t][i], b = tets_[t][j];
        const auto at = singular.find({std::min(a, b), std::max(a, b)});
        if (at != singular.end()) at->second.push_back(t);
      }
    }
    return singular;
  }

  /// Give the smallest fan around an edge a node of its own at that end of the edge where fewer faces have to be cut.
  bool free_fan(const Edge& edge, const std::vector<std::int32_t>& around) {
    DisjointSets sets(around.size());
    for (std::size_t i = 0; i < around.size(); ++i) {
      for (int f = 0; f < kFaces; ++f) {
        const std::int32_t t = around[i];
        if (!has(tets_[t], f, edge[0]) || !has(tets_[t], f, edge[1]) || (cut_[t] >> f & 1)) continue;
        const auto other = std::find(around.begin(), around.end(), neighbors_[t][f].tet);
        if (other != around.end()) sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(other - around.begin()));
      }
    }
    std::map<std::int32_t, std::vector<std::int32_t>> fans;
    for (std::size_t i = 0; i < around.size(); ++i) fans[sets.find(static_cast<std::int32_t>(i))].push_back(around[i]);
    if (fans.size() < 2) return false;
    // At the end of a cut both sides of it share the nodes of the edge, and no gap can open yet.
    const auto waits = [&](const TetFace& face) { return is_at(face, edge, around); };
    if (fans.size() == 2 && std::any_of(may_wait_.begin(), may_wait_.end(), waits)) return false;
    const auto& fan = std::min_element(fans.begin(), fans.end(), [](const auto& a, const auto& b) {
                        return a.second.size() < b.second.size();
                      })->second;
    std::array<std::vector<TetFace>, 2> faces;
    for (std::size_t end = 0; end < 2; ++end) {
      for (const std::int32_t t : fan) {
        for (int f = 0; f < kFaces; ++f) {
          const std::int32_t other = neighbors_[t][f].tet;
          if (!has(tets_[t], f, edge[end]) || other < 0 || (cut_[t] >> f & 1)) continue;
          if (std::find(fan.begin(), fan.end(), other) == fan.end()) faces[end].push_back({t, static_cast<std::int8_t>(f)});
        }
      }
    }
    const auto& fewer = faces[0].size() <= faces[1].size() ? faces[0] : faces[1];
    for (const TetFace& face : fewer) open(face);
    return !fewer.empty();
  }

  Cells& tets_;
  const Cells original_;
  std::size_t nodes_;
  std::vector<std::uint8_t>& cut_;
  std::span<const std::int32_t> extra_;
  const Adjacency& around_;
  const std::vector<std::array<TetFace, Shape::faces.size()>>& neighbors_;
  std::set<std::int32_t> touched_;
  std::vector<TetFace> may_wait_, closed_;
};

}  // namespace

template <std::size_t Corners>
ElementAdjacency<Corners>::ElementAdjacency(const std::vector<std::array<std::int32_t, Corners>>& elements, std::size_t nodes)
    : neighbors(element_neighbors(elements)), offset(nodes + 1, 0), at_node(Corners * elements.size()) {
  for (const auto& element : elements) {
    for (const std::int32_t n : element) ++offset[n + 1];
  }
  for (std::size_t n = 0; n < nodes; ++n) offset[n + 1] += offset[n];
  std::vector<std::int32_t> next(offset.begin(), offset.end() - 1);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (const std::int32_t n : elements[e]) at_node[next[n]++] = static_cast<std::int32_t>(e);
  }
}

template struct ElementAdjacency<4>;
template struct ElementAdjacency<8>;

template <std::size_t Corners>
std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, Corners>>& elements,
                                        const ElementAdjacency<Corners>& at_first, std::vector<std::uint8_t>& cut,
                                        std::span<const std::int32_t> touched, std::vector<TetFace>* wait) {
  return Parting(elements, at_first, cut, touched).run(wait);
}

std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, 4>>& tets, std::size_t nodes,
                                        std::vector<std::uint8_t>& cut, std::span<const std::int32_t> touched,
                                        std::vector<TetFace>* wait) {
  return part_at_faces(tets, ElementAdjacency<4>(tets, nodes), cut, touched, wait);
}

std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, 8>>& hexes, std::size_t nodes,
                                        std::vector<std::uint8_t>& cut, std::span<const std::int32_t> touched,
                                        std::vector<TetFace>* wait) {
  return part_at_faces(hexes, ElementAdjacency<8>(hexes, nodes), cut, touched, wait);
}

template std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, 4>>&, const ElementAdjacency<4>&,
                                                 std::vector<std::uint8_t>&, std::span<const std::int32_t>,
                                                 std::vector<TetFace>*);
template std::vector<std::int32_t> part_at_faces(std::vector<std::array<std::int32_t, 8>>&, const ElementAdjacency<8>&,
                                                 std::vector<std::uint8_t>&, std::span<const std::int32_t>,
                                                 std::vector<TetFace>*);

}  // namespace pliant
