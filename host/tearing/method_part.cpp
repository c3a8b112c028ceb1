// Opens a mesh of tetrahedra at faces: splits nodes, and separates parts that are connected only by a point or an edge.
#include <algorithm>
#include <map>
#include <set>

#include "cutting/topology/cut_cell.h"
#include "geometry/disjoint_sets.h"
#include "tearing/method.h"

namespace pliant {
namespace {

using Tets = std::vector<std::array<std::int32_t, 4>>;

class Parting {
 public:
  Parting(Tets& tets, std::size_t nodes, std::vector<std::uint8_t>& cut, std::span<const std::int32_t> touched)
      : tets_(tets), original_(tets), nodes_(nodes), cut_(cut), extra_(touched), neighbors_(tet_neighbors(tets)) {
    offset_.assign(nodes + 1, 0);
    for (const auto& tet : tets) {
      for (const std::int32_t n : tet) ++offset_[n + 1];
    }
    for (std::size_t n = 0; n < nodes; ++n) offset_[n + 1] += offset_[n];
    at_node_.resize(4 * tets.size());
    std::vector<std::int32_t> next(offset_.begin(), offset_.end() - 1);
    for (std::size_t t = 0; t < tets.size(); ++t) {
      for (const std::int32_t n : tets[t]) at_node_[next[n]++] = static_cast<std::int32_t>(t);
    }
    for (std::size_t t = 0; t < tets.size(); ++t) {  // both sides of a face say the same
      for (int f = 0; f < 4; ++f) {
        if (cut_[t] >> f & 1) open({static_cast<std::int32_t>(t), static_cast<std::int8_t>(f)});
      }
    }
  }

  std::vector<std::int32_t> run() {
    constexpr int kRounds = 50;  // each opens further faces, of which there are finitely many; two or three are usual
    std::vector<std::int32_t> from = split();
    for (int round = 0; round < kRounds && part_edges(); ++round) from = split();
    return from;
  }

 private:
  void open(TetFace face) {
    cut_[face.tet] |= static_cast<std::uint8_t>(1 << face.face);
    const TetFace other = neighbors_[face.tet][face.face];
    if (other.tet >= 0) cut_[other.tet] |= static_cast<std::uint8_t>(1 << other.face);
  }

  [[nodiscard]] std::set<std::int32_t> touched_nodes() const {
    std::set<std::int32_t> touched(extra_.begin(), extra_.end());
    for (std::size_t t = 0; t < cut_.size(); ++t) {
      for (int f = 0; f < 4 && cut_[t] != 0; ++f) {
        if (!(cut_[t] >> f & 1)) continue;
        for (const int k : kTetFaces[f]) touched.insert(original_[t][k]);
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
      const std::span<const std::int32_t> around(at_node_.data() + offset_[n], at_node_.data() + offset_[n + 1]);
      const auto place = [&](std::int32_t t) {
        const auto at = std::lower_bound(around.begin(), around.end(), t);
        return static_cast<std::int32_t>(at - around.begin());
      };
      DisjointSets sets(around.size());
      for (const std::int32_t t : around) {
        for (int f = 0; f < 4; ++f) {
          const std::int32_t other = neighbors_[t][f].tet;
          if (original_[t][f] == n || other < 0 || (cut_[t] >> f & 1)) continue;
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

  /// Cuts faces so that no edge connects two fans of tetrahedra; returns false if there is none.
  bool part_edges() {
    // Edges of the boundary near the cut, by the nodes as they are parted now, and how many triangles use each.
    std::map<std::array<std::int32_t, 2>, int> uses;
    std::set<std::int32_t> tets;
    for (const std::int32_t n : touched_) tets.insert(at_node_.begin() + offset_[n], at_node_.begin() + offset_[n + 1]);
    for (const std::int32_t t : tets) {
      for (int f = 0; f < 4; ++f) {
        if (neighbors_[t][f].tet >= 0 && !(cut_[t] >> f & 1)) continue;
        for (int k = 0; k < 3; ++k) {
          const std::int32_t a = tets_[t][kTetFaces[f][k]], b = tets_[t][kTetFaces[f][(k + 1) % 3]];
          ++uses[{std::min(a, b), std::max(a, b)}];
        }
      }
    }
    bool any = false;
    std::map<std::array<std::int32_t, 2>, std::vector<std::int32_t>> singular;
    for (const auto& [edge, count] : uses) {
      if (count > 2) singular[edge];
    }
    if (singular.empty()) return false;
    for (const std::int32_t t : tets) {
      for (const auto& [i, j] : kTetEdges) {
        const std::int32_t a = tets_[t][i], b = tets_[t][j];
        const auto at = singular.find({std::min(a, b), std::max(a, b)});
        if (at != singular.end()) at->second.push_back(t);
      }
    }
    for (const auto& [edge, around] : singular) any = free_fan(edge, around) || any;
    return any;
  }

  /// Give the smallest fan around an edge a node of its own at that end of the edge where fewer faces have to be cut.
  bool free_fan(const std::array<std::int32_t, 2>& edge, const std::vector<std::int32_t>& around) {
    DisjointSets sets(around.size());
    for (std::size_t i = 0; i < around.size(); ++i) {
      for (int f = 0; f < 4; ++f) {
        const std::int32_t t = around[i];
        if (tets_[t][f] == edge[0] || tets_[t][f] == edge[1] || (cut_[t] >> f & 1)) continue;
        const auto other = std::find(around.begin(), around.end(), neighbors_[t][f].tet);
        if (other != around.end()) sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(other - around.begin()));
      }
    }
    std::map<std::int32_t, std::vector<std::int32_t>> fans;
    for (std::size_t i = 0; i < around.size(); ++i) fans[sets.find(static_cast<std::int32_t>(i))].push_back(around[i]);
    if (fans.size() < 2) return false;
    const auto& fan = std::min_element(fans.begin(), fans.end(), [](const auto& a, const auto& b) {
                        return a.second.size() < b.second.size();
                      })->second;
    std::array<std::vector<TetFace>, 2> faces;
    for (std::size_t end = 0; end < 2; ++end) {
      for (const std::int32_t t : fan) {
        for (int f = 0; f < 4; ++f) {
          const std::int32_t other = neighbors_[t][f].tet;
          if (tets_[t][f] == edge[end] || other < 0 || (cut_[t] >> f & 1)) continue;
          if (std::find(fan.begin(), fan.end(), other) == fan.end()) faces[end].push_back({t, static_cast<std::int8_t>(f)});
        }
      }
    }
    const auto& fewer = faces[0].size() <= faces[1].size() ? faces[0] : faces[1];
    for (const TetFace& face : fewer) open(face);
    return !fewer.empty();
  }

  Tets& tets_;
  const Tets original_;
  std::size_t nodes_;
  std::vector<std::uint8_t>& cut_;
  std::span<const std::int32_t> extra_;
  std::vector<std::array<TetFace, 4>> neighbors_;
  std::vector<std::int32_t> offset_, at_node_;
  std::set<std::int32_t> touched_;
};

}  // namespace

std::vector<std::int32_t> part_at_faces(Tets& tets, std::size_t nodes, std::vector<std::uint8_t>& cut,
                                        std::span<const std::int32_t> touched) {
  return Parting(tets, nodes, cut, touched).run();
}

}  // namespace pliant
