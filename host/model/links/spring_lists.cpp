// Springs between the nodes that a scene lists.
#include <fmt/format.h>

#include <map>
#include <optional>

#include "geometry/disjoint_sets.h"
#include "geometry/vec.h"
#include "model/links/build_links.h"
#include "model/links/element_finder.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using Pair = std::array<std::int32_t, 2>;

/// Share of a line between two nodes from which the elements at its ends are found.
constexpr double kInside = 1e-3;

/// Finds out which copies of its two nodes a spring still joins. It follows its line at rest through the elements and breaks
/// at a face that has opened. Where its line leaves the body, or the whole mesh has slits, it breaks with its pieces.
class HeldEnds {
 public:
  explicit HeldEnds(const BodyElements& solid) : solid_(solid), pieces_(solid.nodes.size()) {
    if (solid.whole_nodes == 0) return;
    std::map<Vec3d, std::int32_t> places;
    for (std::size_t n = 0; n < solid.whole_nodes; ++n) slit_ = slit_ || !places.try_emplace(solid.nodes[n], 0).second;
    finder_.emplace(solid);
    for (std::size_t e = 0; e < solid.size(); ++e) {
      for (const std::int32_t n : solid.corners(e)) pieces_.join(solid.corners(e)[0], n);
    }
  }

  /// Nothing: it is broken.
  [[nodiscard]] std::optional<Pair> find(const Pair& nodes) {
    if (!finder_) return nodes;
    const Vec3d &a = solid_.nodes[nodes[0]], &b = solid_.nodes[nodes[1]], d = vec::sub(b, a);
    const Vec3d first = vec::add(a, vec::mul(d, kInside)), last = vec::sub(b, vec::mul(d, kInside));
    const Held at_a = finder_->find(first), at_b = finder_->find(last);
    const Pair ends{corner_at(at_a.element, a), corner_at(at_b.element, b)};
    if (ends[0] >= 0 && ends[1] >= 0) {
      const Line line = follow(first, at_a, last, at_b, 0);
      if (line == Line::whole || (line == Line::parted && !slit_))
        return line == Line::whole ? std::optional<Pair>(ends) : std::nullopt;
    }
    if (pieces_.find(nodes[0]) != pieces_.find(nodes[1])) return {};
    return nodes;
  }

 private:
  enum class Line { whole, parted, outside };

  /// The corner of an element at a place; -1: none.
  [[nodiscard]] std::int32_t corner_at(std::int32_t element, const Vec3d& x) const {
    if (element < 0) return -1;
    for (const std::int32_t n : solid_.corners(static_cast<std::size_t>(element))) {
      if (solid_.nodes[n] == x) return n;
    }
    return -1;
  }

  Line follow(const Vec3d& a, const Held& at_a, const Vec3d& b, const Held& at_b, int depth) {
    const std::int32_t e = at_a.element, f = at_b.element;
    const bool inside = e >= 0 && f >= 0, last = depth >= ElementFinder::kHalvings;
    // A line through an edge or a corner passes no face, however closely it is looked at.
    const int face = last ? 1 : solid_.tets.empty() ? 4 : 3;
    if (inside && e == f) return Line::whole;
    // Two copies of an element, near the end of a cut with nodes in common.
    if (inside && finder_->common_places(e, f) == static_cast<int>(solid_.corners(0).size())) return Line::parted;
    if (inside && finder_->common_places(e, f) >= face) return finder_->common_nodes(e, f) >= face ? Line::whole : Line::parted;
    if (last) return Line::outside;
    const Vec3d middle = vec::mul(vec::add(a, b), 0.5);
    const Held at = finder_->find(middle);
    const Line before = follow(a, at_a, middle, at, depth + 1);
    return before != Line::whole ? before : follow(middle, at, b, at_b, depth + 1);
  }

  const BodyElements& solid_;
  DisjointSets pieces_;
  bool slit_ = false;  ///< nodes of the whole mesh are at one place, so that an open face may have been one from the start
  std::optional<ElementFinder> finder_;
};

void check_nodes(const SpringList& list, const Body& body, const std::vector<Vec3d>& nodes) {
  for (std::size_t s = 0; s < list.nodes.size(); ++s) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (static_cast<std::size_t>(list.nodes[s][k]) < nodes.size()) continue;
      throw Error(ErrorCode::bad_input, fmt::format("{}: got node {}, expected the index of a node of {}, from 0 to {}",
                                                    list.place(s), list.nodes[s][k], body.name, nodes.size() - 1));
    }
    if (nodes[list.nodes[s][0]] != nodes[list.nodes[s][1]]) continue;
    throw Error(ErrorCode::bad_input, fmt::format("{}: got the nodes {} and {}, which are at one place, expected two places",
                                                  list.place(s), list.nodes[s][0], list.nodes[s][1]));
  }
}

/// Points of nodes, each once.
class NodePoints {
 public:
  NodePoints(const NodeNumbering& draft, Model& model) : draft_(draft), model_(model) {}
  std::int32_t point(std::int32_t node) {
    const auto [at, added] = number_.try_emplace(node, 0);
    if (added) at->second = model_.links.points.add_node(draft_.slot[node], draft_.solid().nodes[node]);
    return at->second;
  }

 private:
  const NodeNumbering& draft_;
  Model& model_;
  std::map<std::int32_t, std::int32_t> number_;
};

}  // namespace

void add_spring_lists(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model) {
  if (body.springs.empty() || draft.solid().size() == 0) return;
  const BodyElements& solid = draft.solid();
  HeldEnds held(solid);
  const auto has_mass = [&](std::int32_t node) { return model.mass[static_cast<std::size_t>(draft.slot[node])] > 0; };
  for (std::size_t l = 0; l < body.springs.size(); ++l) {
    const SpringList& list = body.springs[l];
    check_nodes(list, body, solid.nodes);
    SpringBatch batch;
    batch.law = list.spring;
    batch.body = b;
    batch.listed = true;
    batch.label = fmt::format("{}: springs {}", body.name, l);
    NodePoints points(draft, model);
    for (std::size_t s = 0; s < list.nodes.size(); ++s) {
      const std::optional<Pair> ends = held.find(list.nodes[s]);
      if (!ends || !has_mass((*ends)[0]) || !has_mass((*ends)[1])) continue;
      const double length = list.length_of(s, vec::norm(vec::sub(solid.nodes[(*ends)[1]], solid.nodes[(*ends)[0]])));
      batch.points.push_back({points.point((*ends)[0]), points.point((*ends)[1])});
      batch.length.push_back(length);
      batch.parameters.push_back(spring_parameters(list.spring, length, list.factor_of(s), list.spring.stiffness));
      batch.damper.push_back(list.factor_of(s) * list.spring.damping);
    }
    if (batch.size() > 0) model.links.springs.push_back(std::move(batch));
  }
}

}  // namespace pliant
