// Removal ("destruction" in Mendoza et al.): elements that a blade touches go, and their mass with them.
#include <fmt/format.h>

#include <algorithm>

#include "cutting/topology/cut_cell.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "tearing/method.h"
#include "tearing/plain_surface.h"
#include "tearing/remade_body.h"
#include "tearing/sweep_probe.h"

namespace pliant {
namespace {

/// `Corners` of an element.
template <std::size_t Corners>
class ThinnedBody : public RemadeBody {
 public:
  using Element = std::array<std::int32_t, Corners>;
  using Shape = ElementShape<Corners>;

  explicit ThinnedBody(std::shared_ptr<const BodyMesh> whole)
      : RemadeBody(std::move(whole)),
        around_(all(), whole_->nodes.size()),
        sources_(*whole_),
        broken_(all().size(), 0),
        gone_(all().size(), 0) {
    find_groups();
  }

  CutEdges crossed(std::span<const Vec3d> x, std::span<const SweepTriangle> triangles) override {
    CutEdges out;
    vec::Box box, reach;
    for (const Vec3d& p : x) box.extend(p);
    for (const SweepTriangle& t : triangles) {
      for (const Vec3d& p : t) reach.extend(p);
    }
    if (triangles.empty()) return out;
    SweepProbe probe(box, edge(), triangles);
    for (std::size_t e = 0; e < now().size(); ++e) {
      vec::Box own;
      for (const std::int32_t n : now()[e]) own.extend(x[static_cast<std::size_t>(n)]);
      const std::int32_t number = solid_.parts.of[e];
      if (reach.overlaps(own) && touched(probe, x, now()[e])) out[{number, number}] = 0;
    }
    return out;
  }

  [[nodiscard]] bool follows_at_rest() const override { return false; }
  BladeSweep sweep(std::span<const Vec3d> /*x*/) override {
    throw Error(ErrorCode::internal, "a blade that removes elements is not followed at rest");
  }

  void keep_new(CutEdges& crossed) const override {
    std::erase_if(crossed, [&](const auto& entry) { return gone_[static_cast<std::size_t>(entry.first[0])] != 0; });
  }

  NodeOrigins remake(const CutEdges& crossed) override {
    for (const auto& entry : crossed) {
      const auto [e, same] = entry.first;
      if (e != same || e < 0 || static_cast<std::size_t>(e) >= gone_.size() || gone_[static_cast<std::size_t>(e)] != 0)
        throw Error(ErrorCode::bad_input, fmt::format("got element {} to be removed, which the body does not have", e));
      gone_[static_cast<std::size_t>(e)] = 1;
    }
    const std::vector<Element> had = now();
    const std::vector<std::int32_t> had_numbers = solid_.parts.of;
    NodeOrigins origins{open()};
    trace_nodes(had, had_numbers, origins.from);
    make_surface();
    elements_changed();
    return origins;
  }

 private:
  [[nodiscard]] const std::vector<Element>& all() const { return elements(*whole_); }
  [[nodiscard]] const std::vector<Element>& now() const { return elements(solid_); }
  template <class Body>
  static auto& elements(Body& body) {
    if constexpr (Corners == 4)
      return body.tets;
    else
      return body.hexes;
  }

  static bool touched(SweepProbe& probe, std::span<const Vec3d> x, const Element& element) {
    const auto meets = [&](const std::array<std::int32_t, 4>& tet) {
      std::array<ExactPoint, 4> p;
      std::array<Vec3d, 4> at;
      for (std::size_t a = 0; a < 4; ++a) {
        at[a] = x[static_cast<std::size_t>(tet[a])];
        if (!vec::finite(at[a])) return false;
        p[a] = probe.point(at[a], tet[a]);
      }
      return probe.touches(p, at);
    };
    if constexpr (Corners == 4) {
      return meets(element);
    } else {
      return std::any_of(kKuhnTets.begin(), kKuhnTets.end(), [&](const auto& t) {
        return meets({element[t[0]], element[t[1]], element[t[2]], element[t[3]]});
      });
    }
  }

  /// Gives the elements that are left the nodes that these leave them: elements that touch at a point or an edge only get
  /// separate ones. Returns the node of the whole body of each node.
  std::vector<std::int32_t> open() {
    std::vector<Element> left;
    std::vector<std::uint8_t> cut;
    std::vector<std::int32_t> touched, number, place(gone_.size(), -1);
    for (std::size_t e = 0; e < gone_.size(); ++e) {
      if (gone_[e] != 0) {
        touched.insert(touched.end(), all()[e].begin(), all()[e].end());
        continue;
      }
      place[e] = static_cast<std::int32_t>(left.size());
      number.push_back(static_cast<std::int32_t>(e));
      left.push_back(all()[e]);
      cut.push_back(broken_[e]);
    }
    std::vector<std::int32_t> origin = part_at_faces(left, whole_->nodes.size(), cut, touched);
    std::vector<std::int32_t>& before = solid_.parts.before;
    std::vector<std::int32_t> was(gone_.size(), -1);
    for (std::size_t e = 0; e < solid_.parts.of.size(); ++e)
      was[static_cast<std::size_t>(solid_.parts.of[e])] = static_cast<std::int32_t>(e);
    before.clear();
    solid_.fill.clear();
    for (std::size_t e = 0; e < number.size(); ++e) {
      broken_[static_cast<std::size_t>(number[e])] = cut[e];
      before.push_back(was[static_cast<std::size_t>(number[e])]);
      solid_.fill.push_back(whole_->fill[static_cast<std::size_t>(number[e])]);
    }
    elements(solid_) = std::move(left);
    solid_.parts.of = std::move(number);
    solid_.nodes.clear();
    for (const std::int32_t n : origin) solid_.nodes.push_back(whole_->nodes[static_cast<std::size_t>(n)]);
    return origin;
  }

  /// From the nodes of the whole body to those before the edit: all corners that share a node now shared one before.
  void trace_nodes(const std::vector<Element>& had, const std::vector<std::int32_t>& had_numbers,
                   std::vector<std::int32_t>& from) const {
    std::vector<std::int32_t> place(gone_.size(), -1);
    for (std::size_t e = 0; e < had_numbers.size(); ++e)
      place[static_cast<std::size_t>(had_numbers[e])] = static_cast<std::int32_t>(e);
    for (std::size_t e = 0; e < now().size(); ++e) {
      const Element& then = had[static_cast<std::size_t>(place[static_cast<std::size_t>(solid_.parts.of[e])])];
      for (std::size_t a = 0; a < Corners; ++a) from[static_cast<std::size_t>(now()[e][a])] = then[a];
    }
  }

  /// Numbers faces that have the same nodes. Two elements share one, as a rule; in a lattice of which one cell is two, three
  /// may.
  void find_groups() {
    std::map<std::array<std::int32_t, Shape::faces[0].size()>, std::int32_t> known;
    group_.resize(all().size());
    for (std::size_t e = 0; e < all().size(); ++e) {
      for (std::size_t f = 0; f < Shape::faces.size(); ++f) {
        std::array<std::int32_t, Shape::faces[0].size()> key{};
        for (std::size_t k = 0; k < key.size(); ++k) key[k] = all()[e][static_cast<std::size_t>(Shape::faces[f][k])];
        std::sort(key.begin(), key.end());
        group_[e][f] = known.try_emplace(key, static_cast<std::int32_t>(known.size())).first->second;
      }
    }
    groups_ = known.size();
  }

  /// The triangles of a face by corners of the element, a quadrilateral along the diagonal of boundary_triangles().
  [[nodiscard]] std::vector<std::array<int, 3>> triangles_of(std::size_t e, std::size_t f) const {
    const auto& c = Shape::faces[f];
    if constexpr (Corners == 4) {
      return {{c[0], c[1], c[2]}};
    } else {
      constexpr std::array<int, 6> kFirst{1, 0, 0, 1, 0, 0};  // of the corners of the face one that the diagonal has
      int first = kFirst[f];
      // Both sides of an open face may share its four nodes: along different diagonals no edge has more than two triangles.
      if (const std::int32_t other = around_.neighbors[e][f].tet; other >= 0 && other < static_cast<std::int32_t>(e)) {
        const bool both = gone_[static_cast<std::size_t>(other)] == 0;
        const auto there = static_cast<std::size_t>(around_.neighbors[e][f].face);
        const auto& d = Shape::faces[there];
        const std::int32_t n = all()[static_cast<std::size_t>(other)][d[static_cast<std::size_t>(kFirst[there])]];
        const bool same =
            n == all()[e][c[static_cast<std::size_t>(first)]] || n == all()[e][c[static_cast<std::size_t>(first + 2)]];
        if (both && same) ++first;
      }
      const auto at = [&](int k) { return c[static_cast<std::size_t>((first + k) % 4)]; };
      return {{at(0), at(1), at(2)}, {at(0), at(2), at(3)}};
    }
  }

  /// The outside of the elements that are left: first what the whole body has of it.
  void make_surface() {
    std::vector<OuterFace> outer, cut;
    std::vector<std::int8_t> users(groups_, 0);  // a face is outside where one element alone has it, as in the whole body
    for (const std::int32_t e : solid_.parts.of) {
      for (const std::int32_t group : group_[static_cast<std::size_t>(e)]) ++users[static_cast<std::size_t>(group)];
    }
    for (std::size_t e = 0; e < now().size(); ++e) {
      const auto whole = static_cast<std::size_t>(solid_.parts.of[e]);
      for (std::size_t f = 0; f < Shape::faces.size(); ++f) {
        const bool alone = users[static_cast<std::size_t>(group_[whole][f])] == 1;
        if (!alone && (broken_[whole] >> f & 1) == 0) continue;
        for (const auto& t : triangles_of(whole, f)) {
          OuterFace face{};
          std::array<std::int32_t, 3> key{};
          for (std::size_t k = 0; k < 3; ++k) {
            face.nodes[k] = now()[e][static_cast<std::size_t>(t[k])];
            key[k] = all()[whole][static_cast<std::size_t>(t[k])];
          }
          face.source = sources_.at(key);
          (face.source >= 0 ? outer : cut).push_back(face);
        }
      }
    }
    std::stable_sort(outer.begin(), outer.end(), [](const OuterFace& a, const OuterFace& b) { return a.source < b.source; });
    outer.insert(outer.end(), cut.begin(), cut.end());
    surface_of_faces(*whole_, outer, solid_);
  }

  ElementAdjacency<Corners> around_;  ///< of the whole body
  SurfaceSources sources_;
  std::vector<std::uint8_t> broken_;  ///< [elements of the whole body] faces opened because an edge alone connected them, bit f
  std::vector<char> gone_;            ///< [elements of the whole body]
  std::vector<std::array<std::int32_t, Shape::faces.size()>> group_;  ///< the same of faces with the same nodes
  std::size_t groups_ = 0;
};

}  // namespace

std::unique_ptr<RemadeBody> make_thinned_body(std::shared_ptr<const BodyMesh> whole) {
  if (whole->tets.empty()) return std::make_unique<ThinnedBody<8>>(std::move(whole));
  return std::make_unique<ThinnedBody<4>>(std::move(whole));
}

}  // namespace pliant
