// Decomposition ("subdivision" in Mendoza et al.; Bielser, Maiwald and Gross 1999): crossed tetrahedra become smaller ones
// whose faces follow the cut.
//
// An edge of the whole body that a blade crosses gets a node there, and every tetrahedron that has the edge is divided in two
// at it. Of a tetrahedron with three crossed edges at one corner that leaves four, of one with four crossed edges six: those of
// the method. All tetrahedra of an edge are divided alike, so that faces always match; and the order of the edges only decides
// along which diagonals quadrilaterals are divided, so that a blade may come in any number of moves. Where the crossed edges
// of a tetrahedron of the whole body part its corners, the faces between its parts open.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "cutting/topology/cut_cell.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "tearing/method.h"
#include "tearing/plain_surface.h"
#include "tearing/remade_body.h"
#include "tearing/uncut_mesh.h"

namespace pliant {
namespace {

using Tet = std::array<std::int32_t, 4>;

/// A node on an edge stays this far from the ends of the edge, as a fraction of it: what is cut off is not thinner, and the
/// stable step falls to about this fraction of what it was, not to nothing.
constexpr double kLeastShare = 0.1;

class DividedBody : public RemadeBody {
 public:
  explicit DividedBody(std::shared_ptr<const BodyMesh> whole)
      : RemadeBody(std::move(whole)),
        around_(whole_->tets, whole_->nodes.size()),
        sources_(*whole_),
        joined_(whole_->tets),
        broken_(joined_.size(), 0),
        waiting_(joined_.size(), 0) {
    for (std::size_t n = 0; n < whole_->nodes.size(); ++n) origin_.push_back(static_cast<std::int32_t>(n));
    rest_ = whole_->nodes;
    mesh_ = uncut_mesh(*whole_);
    rest_edges_ = std::make_unique<RestEdges>(*mesh_, edge());
  }

  /// An edge that is not crossed is one of the tetrahedra now, too: between copies of nodes of the whole body.
  CutEdges crossed(std::span<const Vec3d> x, std::span<const SweepTriangle> triangles) override {
    CutEdges out;
    if (triangles.empty()) return out;
    for (const auto& [pair, share] : crossed_edges(topology(), x, triangles)) {
      const std::int32_t a = origin_[static_cast<std::size_t>(pair[0])], b = origin_[static_cast<std::size_t>(pair[1])];
      if (is_new(a) || is_new(b)) continue;
      out.try_emplace(node_pair(a, b), a < b ? share : 1 - share);
    }
    return out;
  }

  [[nodiscard]] bool follows_at_rest() const override { return true; }
  BladeSweep sweep(std::span<const Vec3d> x) override {
    const std::size_t nodes = whole_->nodes.size();
    measure_gaps(x);
    return {topology(), x, SweptPairs{*rest_edges_, whole_->nodes, x.first(nodes), nodes, gap_, true}, edge()};
  }

  void keep_new(CutEdges& crossed) const override {
    std::erase_if(crossed, [&](const auto& entry) { return middle_.contains(entry.first); });
  }

  [[nodiscard]] std::int64_t cut_in_part() const override {
    return std::count_if(children_.begin(), children_.end(), [&](const auto& entry) { return holds(entry.first); });
  }

  [[nodiscard]] std::int64_t cut_in_part(const CutEdges& crossed) const override {
    std::set<std::int32_t> parents;
    for (const auto& entry : crossed) {
      for (const std::int32_t parent : tets_at(entry.first)) parents.insert(parent);
    }
    return std::count_if(parents.begin(), parents.end(), [&](std::int32_t parent) { return holds(parent); });
  }

  NodeOrigins remake(const CutEdges& crossed) override {
    const std::vector<Tet> had = solid_.tets;
    const std::vector<std::int32_t> had_origin = origin_;
    const auto had_nodes = static_cast<std::int32_t>(rest_.size());
    std::vector<std::int32_t>& before = solid_.parts.before;
    before.resize(had.size());
    for (std::size_t e = 0; e < had.size(); ++e) before[e] = static_cast<std::int32_t>(e);
    std::set<std::int32_t> changed;
    for (const auto& [pair, share] : crossed) cut_edge(pair, share, changed);
    for (const std::int32_t parent : changed) mark_open(parent);
    part();
    solid_.nodes.clear();
    solid_.edge_nodes.clear();
    for (const std::int32_t n : origin_) {
      if (is_new(n)) solid_.edge_nodes.push_back({static_cast<std::int32_t>(solid_.nodes.size()), edge_of(n).first});
      solid_.nodes.push_back(rest_[static_cast<std::size_t>(n)]);
    }
    solid_.fill.clear();
    for (const std::int32_t e : solid_.parts.of) solid_.fill.push_back(whole_->fill[static_cast<std::size_t>(e)]);
    make_surface();
    elements_changed();
    return trace_nodes(had, had_origin, had_nodes);
  }

 private:
  [[nodiscard]] bool is_new(std::int32_t node) const { return node >= static_cast<std::int32_t>(whole_->nodes.size()); }

  /// The edge of a new node, and its share of the way.
  [[nodiscard]] const std::pair<NodePair, double>& edge_of(std::int32_t node) const {
    return on_edge_[static_cast<std::size_t>(node) - whole_->nodes.size()];
  }

  /// Tetrahedra of the whole body that have both nodes.
  [[nodiscard]] std::vector<std::int32_t> tets_at(const NodePair& pair) const {
    std::vector<std::int32_t> both;
    const auto nodes = static_cast<std::int32_t>(whole_->nodes.size());
    if (pair[0] < 0 || pair[0] >= pair[1] || pair[1] >= nodes) return both;
    const std::span<const std::int32_t> a = around_.at(pair[0]), b = around_.at(pair[1]);
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
  }

  /// How far the copies of each node are apart (SweptPairs::gap).
  void measure_gaps(std::span<const Vec3d> x) {
    gap_.assign(origin_.size(), 0);
    std::map<std::int32_t, std::vector<std::size_t>> copies;
    for (std::size_t n = rest_.size(); n < origin_.size(); ++n) copies[origin_[n]].push_back(n);
    for (auto& [origin, nodes] : copies) {
      nodes.push_back(static_cast<std::size_t>(origin));
      for (const std::size_t m : nodes) {
        for (const std::size_t n : nodes) gap_[m] = std::max(gap_[m], vec::norm(vec::sub(x[m], x[n])));
      }
    }
  }

  void cut_edge(const NodePair& pair, double share, std::set<std::int32_t>& changed) {
    const std::vector<std::int32_t> parents = tets_at(pair);
    if (parents.empty() || middle_.contains(pair) || !(share > 0 && share < 1)) {
      throw Error(ErrorCode::bad_input, fmt::format("got a cut of the edge between nodes {} and {} at {} of its length, which "
                                                    "the body does not have, or which is cut already",
                                                    pair[0], pair[1], share));
    }
    share = std::clamp(share, kLeastShare, 1 - kLeastShare);
    const auto middle = static_cast<std::int32_t>(rest_.size());
    const Vec3d &a = whole_->nodes[static_cast<std::size_t>(pair[0])], &b = whole_->nodes[static_cast<std::size_t>(pair[1])];
    rest_.push_back(vec::add(a, vec::mul(vec::sub(b, a), share)));
    middle_[pair] = middle;
    on_edge_.push_back({pair, share});
    for (const std::int32_t parent : parents) {
      changed.insert(parent);
      for (const std::int32_t e : std::vector<std::int32_t>(children(parent))) bisect(e, pair, middle);
    }
  }

  /// The tetrahedra that one of the whole body has become.
  std::vector<std::int32_t>& children(std::int32_t parent) {
    return children_.try_emplace(parent, std::vector<std::int32_t>{parent}).first->second;
  }

  /// Divides a tetrahedron in two, if it has the edge. The first part keeps its number.
  void bisect(std::int32_t e, const NodePair& pair, std::int32_t middle) {
    const auto own = static_cast<std::size_t>(e);
    const auto find = [&](std::int32_t n) {
      return std::find(joined_[own].begin(), joined_[own].end(), n) - joined_[own].begin();
    };
    const auto a = static_cast<std::size_t>(find(pair[0])), b = static_cast<std::size_t>(find(pair[1]));
    if (a == 4 || b == 4) return;
    const std::int32_t parent = solid_.parts.of[own];
    children(parent).push_back(static_cast<std::int32_t>(joined_.size()));
    joined_.push_back(joined_[own]);
    joined_[own][b] = middle;
    joined_.back()[a] = middle;
    // Face k lies opposite corner k. The face between the parts is closed; of the others each part has what it had.
    for (std::vector<std::uint8_t>* bits : {&broken_, &waiting_}) {
      const std::uint8_t was = (*bits)[own];
      bits->push_back(static_cast<std::uint8_t>(was & ~(1U << b)));
      (*bits)[own] = static_cast<std::uint8_t>(was & ~(1U << a));
    }
    solid_.parts.of.push_back(parent);
    solid_.parts.before.push_back(solid_.parts.before[own]);
  }

  /// Of the corners of a tetrahedron of the whole body: those that uncrossed edges join have the same label.
  [[nodiscard]] std::array<int, 4> labels_of(std::int32_t parent) const {
    const Tet& corner = whole_->tets[static_cast<std::size_t>(parent)];
    std::array<int, 4> label{0, 1, 2, 3};
    for (const auto& [i, j] : kTetEdges) {
      if (middle_.contains(node_pair(corner[i], corner[j]))) continue;
      const int low = std::min(label[i], label[j]), high = std::max(label[i], label[j]);
      std::replace(label.begin(), label.end(), high, low);
    }
    return label;
  }

  /// Whether the corners of a tetrahedron of the whole body hold together.
  [[nodiscard]] bool holds(std::int32_t parent) const {
    const std::array<int, 4> label = labels_of(parent);
    return std::all_of(label.begin(), label.end(), [](int l) { return l == 0; });
  }

  /// The label of a part: that of its corners. A part without one has a triangle in the middle of a face at most, and goes
  /// with the lowest node of that face, as on the other side; -1: it has none.
  [[nodiscard]] int label_of(const Tet& part, const Tet& corner, const std::array<int, 4>& label) const {
    for (std::size_t k = 0; k < 4; ++k) {
      if (std::find(part.begin(), part.end(), corner[k]) != part.end()) return label[k];
    }
    for (const auto& face : kTetFaces) {
      int found = 0, lowest = face[0];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = corner[face[k]], b = corner[face[(k + 1) % 3]];
        const auto at = middle_.find(node_pair(a, b));
        found += at != middle_.end() && std::find(part.begin(), part.end(), at->second) != part.end();
        if (corner[face[k]] < corner[lowest]) lowest = face[k];
      }
      if (found == 3) return label[lowest];
    }
    return -1;
  }

  /// Marks the faces between parts of a tetrahedron of the whole body with different labels.
  void mark_open(std::int32_t parent) {
    if (holds(parent)) return;
    const std::array<int, 4> label = labels_of(parent);
    const std::vector<std::int32_t>& parts = children(parent);
    std::vector<int> of;
    std::map<std::array<std::int32_t, 3>, std::vector<std::pair<std::size_t, int>>> sides;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Tet& tet = joined_[static_cast<std::size_t>(parts[i])];
      of.push_back(label_of(tet, whole_->tets[static_cast<std::size_t>(parent)], label));
      for (int f = 0; f < 4; ++f)
        sides[face_key({tet[kTetFaces[f][0]], tet[kTetFaces[f][1]], tet[kTetFaces[f][2]]})].push_back({i, f});
    }
    for (bool any = true; any;) {  // a part amid others goes with one of them
      any = false;
      for (const auto& [key, two] : sides) {
        if (two.size() < 2 || (of[two[0].first] < 0) == (of[two[1].first] < 0)) continue;
        of[two[0].first] = of[two[1].first] = std::max(of[two[0].first], of[two[1].first]);
        any = true;
      }
    }
    for (const auto& [key, two] : sides) {
      if (two.size() < 2 || of[two[0].first] == of[two[1].first]) continue;
      for (const auto& [i, f] : two) waiting_[static_cast<std::size_t>(parts[i])] |= static_cast<std::uint8_t>(1 << f);
    }
  }

  /// Opens the faces that are marked. Those at the end of a cut that cannot come apart yet wait, as with separation.
  void part() {
    std::vector<TetFace> wait;
    for (std::size_t e = 0; e < waiting_.size(); ++e) {
      for (int f = 0; f < 4; ++f) {
        if ((waiting_[e] >> f & 1) != 0 && (broken_[e] >> f & 1) == 0)
          wait.push_back({static_cast<std::int32_t>(e), static_cast<std::int8_t>(f)});
      }
      broken_[e] |= waiting_[e];
    }
    const ElementAdjacency<4> around(joined_, rest_.size());
    solid_.tets = joined_;
    origin_ = part_at_faces(solid_.tets, around, broken_, {}, &wait);
    std::fill(waiting_.begin(), waiting_.end(), std::uint8_t{0});
    for (const TetFace& face : wait) {
      waiting_[static_cast<std::size_t>(face.tet)] |= static_cast<std::uint8_t>(1 << face.face);
      const TetFace other = around.neighbors[static_cast<std::size_t>(face.tet)][static_cast<std::size_t>(face.face)];
      if (other.tet >= 0) waiting_[static_cast<std::size_t>(other.tet)] |= static_cast<std::uint8_t>(1 << other.face);
    }
    neighbors_ = around.neighbors;
  }

  /// Any tetrahedron at a node says where it comes from: an edit splits nodes and never joins them, and each part of a
  /// tetrahedron knows the one that it was before.
  [[nodiscard]] NodeOrigins trace_nodes(const std::vector<Tet>& had, const std::vector<std::int32_t>& had_origin,
                                        std::int32_t had_nodes) const {
    NodeOrigins out;
    out.from.assign(origin_.size(), -1);
    for (std::size_t e = 0; e < solid_.tets.size(); ++e) {
      const Tet& then = had[static_cast<std::size_t>(solid_.parts.before[e])];
      const auto corner = [&](std::int32_t joined) {
        const auto at = std::find_if(then.begin(), then.end(),
                                     [&](std::int32_t n) { return had_origin[static_cast<std::size_t>(n)] == joined; });
        return *at;
      };
      for (const std::int32_t n : solid_.tets[e]) {
        std::int32_t& from = out.from[static_cast<std::size_t>(n)];
        const std::int32_t joined = origin_[static_cast<std::size_t>(n)];
        if (from >= 0) continue;
        if (joined < had_nodes) {
          from = corner(joined);
          continue;
        }
        const auto& [pair, share] = edge_of(joined);
        from = corner(pair[0]);
        out.mixed.push_back({n, corner(pair[1]), share});
      }
    }
    for (std::size_t n = 0; n < out.from.size(); ++n) {  // nodes without elements, which only the whole body has
      if (out.from[n] < 0) out.from[n] = static_cast<std::int32_t>(n);
    }
    std::sort(out.mixed.begin(), out.mixed.end(), [](const MixedNode& a, const MixedNode& b) { return a.node < b.node; });
    return out;
  }

  /// The triangle of the whole surface that a face on the outside is part of: its nodes lie on the edges of that triangle.
  [[nodiscard]] std::int32_t source_of(const Tet& tet, const std::array<int, 3>& face) const {
    std::set<std::int32_t> nodes;
    for (const int k : face) {
      const std::int32_t n = tet[static_cast<std::size_t>(k)];
      if (!is_new(n)) {
        nodes.insert(n);
        continue;
      }
      const NodePair& pair = edge_of(n).first;
      nodes.insert(pair.begin(), pair.end());
    }
    if (nodes.size() != 3) return -1;
    std::array<std::int32_t, 3> key{};
    std::copy(nodes.begin(), nodes.end(), key.begin());
    return sources_.at(key);
  }

  void make_surface() {
    std::vector<OuterFace> outer, cut;
    for (std::size_t e = 0; e < joined_.size(); ++e) {
      for (std::size_t f = 0; f < 4; ++f) {
        const bool outside = neighbors_[e][f].tet < 0;
        if (!outside && (broken_[e] >> f & 1) == 0) continue;
        OuterFace face{};
        for (std::size_t k = 0; k < 3; ++k) face.nodes[k] = solid_.tets[e][static_cast<std::size_t>(kTetFaces[f][k])];
        if (outside) face.source = source_of(joined_[e], kTetFaces[f]);
        if (outside && face.source < 0) continue;
        (outside ? outer : cut).push_back(face);
      }
    }
    std::stable_sort(outer.begin(), outer.end(), [](const OuterFace& a, const OuterFace& b) { return a.source < b.source; });
    outer.insert(outer.end(), cut.begin(), cut.end());
    surface_of_faces(*whole_, outer, solid_);
  }

  ElementAdjacency<4> around_;  ///< of the whole body
  std::shared_ptr<const CutMesh> mesh_;
  std::unique_ptr<RestEdges> rest_edges_;
  SurfaceSources sources_;
  // The body with its faces closed: nodes of the whole body, then those on edges. Its tetrahedra have the numbers of solid().
  std::vector<Vec3d> rest_;
  std::vector<Tet> joined_;
  std::vector<std::array<TetFace, 4>> neighbors_;
  std::vector<std::uint8_t> broken_, waiting_;        ///< [tetrahedra] faces that are open, or wait for that, bit f
  std::map<NodePair, std::int32_t> middle_;           ///< the node on a crossed edge
  std::vector<std::pair<NodePair, double>> on_edge_;  ///< of each node on an edge
  std::map<std::int32_t, std::vector<std::int32_t>> children_;
  std::vector<double> gap_;           ///< of each node of solid(), for the last sweep [m]
  std::vector<std::int32_t> origin_;  ///< of each node of solid() that with closed faces
};

}  // namespace

std::unique_ptr<RemadeBody> make_divided_body(std::shared_ptr<const BodyMesh> whole) {
  if (whole->tets.empty()) throw Error(ErrorCode::bad_input, "decomposition divides tetrahedra, and this body is of hexahedra");
  return std::make_unique<DividedBody>(std::move(whole));
}

}  // namespace pliant
