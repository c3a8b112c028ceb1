// Springs along the edges of the tetrahedra of a body.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "geometry/vec.h"
#include "model/links/build_links.h"
#include "scene/keys.h"

namespace pliant {
namespace {

using Pair = std::array<std::int32_t, 2>;

constexpr std::array<std::array<int, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// What one tetrahedron gives to one of its edges.
struct EdgeShare {
  Pair ends;         ///< ascending
  double filled;     ///< its volume times its fill [m^3]
  double stiffness;  ///< E V fill / l^2 [N/m]
  double damping;    ///< times Material::stiffness_damping [N s/m]
};

/// Whether there may be copies of nodes.
bool may_have_copies(const Body& body, const BodyElements& solid) {
  bool tears = body.material.toughness > 0;
  for (const Inclusion& i : body.inclusions) tears = tears || i.material.toughness > 0;
  return tears || solid.whole_nodes > 0;
}

/// For each node the first one at its place: copies of a node made by a cut or a tear rest where it does.
std::vector<std::int32_t> first_at_place(const BodyElements& solid, bool copies) {
  std::vector<std::int32_t> first(solid.nodes.size());
  std::iota(first.begin(), first.end(), 0);
  if (!copies) return first;
  std::map<Vec3d, std::int32_t> places;
  for (std::size_t n = 0; n < first.size(); ++n) first[n] = places.try_emplace(solid.nodes[n], first[n]).first->second;
  return first;
}

/// The tetrahedra of a body, or of the one that it was before elements of it were removed.
struct Tetrahedra {
  const BodyElements& solid;
  const ElementMaterials& materials;
  const std::vector<double>& volume;  ///< [tetrahedra] full [m^3]
};

/// Entries of all tetrahedra, ordered by ends; `name` is the number of a node in `ends`, `fill` that of an element.
std::vector<EdgeShare> edge_shares(const Body& body, const Tetrahedra& of, const std::vector<std::int32_t>& name,
                                   const std::vector<double>& fill) {
  const BodyElements& solid = of.solid;
  std::vector<EdgeShare> all, out;
  std::vector<std::size_t> next(static_cast<std::size_t>(*std::max_element(name.begin(), name.end())) + 2, 0);
  all.reserve(6 * solid.tets.size());
  for (std::size_t e = 0; e < solid.tets.size(); ++e) {
    const Material& material = material_of(body, of.materials.index[e]);
    const double young = of.materials.modulus_of(e) * material.moduli.young();
    const double filled = of.volume[e] * fill[e];
    for (const auto& [i, j] : kTetEdges) {
      const std::int32_t a = solid.tets[e][i], b = solid.tets[e][j];
      const Vec3d d = vec::sub(solid.nodes[b], solid.nodes[a]);
      const double stiffness = young * filled / vec::dot(d, d);
      all.push_back({{std::min(name[a], name[b]), std::max(name[a], name[b])},
                     filled,
                     stiffness,
                     stiffness * material.stiffness_damping});
      ++next[static_cast<std::size_t>(all.back().ends[0]) + 1];
    }
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  const std::vector<std::size_t> begin = next;
  out.resize(all.size());
  for (const EdgeShare& share : all) out[next[static_cast<std::size_t>(share.ends[0])]++] = share;
  for (std::size_t n = 0; n + 1 < begin.size(); ++n) {
    std::stable_sort(out.begin() + static_cast<std::ptrdiff_t>(begin[n]), out.begin() + static_cast<std::ptrdiff_t>(next[n]),
                     [](const EdgeShare& x, const EdgeShare& y) { return x.ends[1] < y.ends[1]; });
  }
  return out;
}

/// One per pair of ends: the sums.
std::vector<EdgeShare> summed(const std::vector<EdgeShare>& shares) {
  std::vector<EdgeShare> out;
  for (const EdgeShare& s : shares) {
    if (out.empty() || out.back().ends != s.ends) {
      out.push_back(s);
    } else {
      out.back().filled += s.filled;
      out.back().stiffness += s.stiffness;
      out.back().damping += s.damping;
    }
  }
  return out;
}

/// Points of the nodes of a body, ordered by slot.
std::vector<std::int32_t> add_points(const std::vector<EdgeShare>& edges, Model& model) {
  std::vector<std::int32_t> point(static_cast<std::size_t>(model.slots), -1);
  for (const EdgeShare& e : edges) point[e.ends[0]] = point[e.ends[1]] = 0;
  for (std::size_t s = 0; s < point.size(); ++s) {
    if (point[s] == 0) point[s] = model.links.points.add_node(static_cast<std::int32_t>(s), model.rest[s]);
  }
  return point;
}

/// At least the largest eigenvalue of the Laplacian of a tetrahedron with these stiffnesses at its edges (Wolkowicz and Styan
/// 1980: three numbers by their mean and their variance; the fourth eigenvalue is 0).
double largest_of_symmetric(const std::array<double, 6>& stiffness) {
  std::array<double, 4> degree{};
  double squares = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    for (const int end : kTetEdges[k]) degree[static_cast<std::size_t>(end)] += stiffness[k];
    squares += 2 * stiffness[k] * stiffness[k];
  }
  double trace = 0;
  for (const double d : degree) {
    trace += d;
    squares += d * d;
  }
  const double mean = trace / 3;
  return mean + std::sqrt(2 * std::max(0.0, squares / 3 - mean * mean));
}

/// At least the squared frequency of a network, however its springs turn: the largest one of a tetrahedron alone, whose edges
/// have their shares of its springs and whose corners a quarter of its mass each. Cuts leave shares of both, and the bound.
double edges_omega2(const Body& body, const NodeNumbering& draft, const std::vector<std::int32_t>& place,
                    const std::vector<EdgeShare>& uncut) {
  const BodyElements& solid = draft.solid();
  std::vector<std::size_t> first(solid.nodes.size() + 1, uncut.size());
  std::vector<double> per_volume(uncut.size());
  for (std::size_t i = uncut.size(); i-- > 0;) {
    const EdgeShare& e = uncut[i];
    first[static_cast<std::size_t>(e.ends[0])] = i;
    const double length = vec::norm(vec::sub(solid.nodes[e.ends[1]], solid.nodes[e.ends[0]]));
    const double stiffness = body.model.spring.stiffness > 0 ? body.model.spring.stiffness : e.stiffness;
    per_volume[i] = rest_stiffness(body.model.spring, spring_parameters(body.model.spring, length, 1, stiffness)) / e.filled;
  }
  const bool own = body.model.spring.law == SpringLaw::linear && body.model.spring.stiffness == 0;  // each from its own modulus
  double most = 0;
  for (std::size_t t = 0; t < solid.tets.size(); ++t) {
    std::array<double, 6> stiffness{};
    const Material& material = material_of(body, draft.materials.index[t]);
    const double young = draft.materials.modulus_of(t) * material.moduli.young();
    for (std::size_t k = 0; k < 6; ++k) {
      if (own) {
        const Vec3d d = vec::sub(solid.nodes[solid.tets[t][kTetEdges[k][1]]], solid.nodes[solid.tets[t][kTetEdges[k][0]]]);
        stiffness[k] = young * draft.volume[t] / vec::dot(d, d);
        continue;
      }
      Pair ends{place[solid.tets[t][kTetEdges[k][0]]], place[solid.tets[t][kTetEdges[k][1]]]};
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      std::size_t i = first[static_cast<std::size_t>(ends[0])];
      while (uncut[i].ends[1] != ends[1]) ++i;
      stiffness[k] = per_volume[i] * draft.volume[t];
    }
    const double corner = material.density * draft.volume[t] / 4;
    most = std::max(most, largest_of_symmetric(stiffness) / corner);
  }
  return most;
}

/// The edges of the body before cuts and removals, with the sums of all its tetrahedra.
std::vector<EdgeShare> uncut_edges(const Body& body, const NodeNumbering& draft, const std::vector<std::int32_t>& place) {
  const BodyElements& solid = draft.solid();
  if (solid.parts.whole == nullptr) return summed(edge_shares(body, {solid, draft.materials, draft.volume}, place, solid.fill));
  const BodyElements& whole = *solid.parts.whole;
  std::vector<double> volume;
  for (const auto& tet : whole.tets) {
    const auto side = [&](std::size_t k) { return vec::sub(whole.nodes[tet[k]], whole.nodes[tet[0]]); };
    volume.push_back(vec::dot(side(1), vec::cross(side(2), side(3))) / 6);
  }
  return summed(edge_shares(body, {whole, element_materials(body, whole), volume}, place, whole.fill));
}

}  // namespace

void add_mass_springs(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model) {
  const BodyElements& solid = draft.solid();
  SpringBatch batch;
  batch.law = body.model.spring;
  batch.body = b;
  batch.label = body.name + ": springs";
  const std::vector<std::int32_t> place = first_at_place(solid, may_have_copies(body, solid));
  std::vector<std::int32_t> place_of(static_cast<std::size_t>(model.slots), -1);
  for (std::size_t n = 0; n < place.size(); ++n) place_of[draft.slot[n]] = place[n];
  const std::vector<EdgeShare> uncut = uncut_edges(body, draft, place);
  const std::vector<EdgeShare> edges =
      summed(edge_shares(body, {solid, draft.materials, draft.volume}, draft.slot, draft.stiff));
  const std::vector<std::int32_t> point = add_points(edges, model);
  for (const EdgeShare& e : edges) {
    Pair at{place_of[e.ends[0]], place_of[e.ends[1]]};
    if (at[0] > at[1]) std::swap(at[0], at[1]);
    const auto whole =
        std::lower_bound(uncut.begin(), uncut.end(), at, [](const EdgeShare& x, const Pair& y) { return x.ends < y; });
    const double share = e.filled / whole->filled, length = vec::norm(vec::sub(model.rest[e.ends[1]], model.rest[e.ends[0]]));
    if (!(share > 0)) continue;
    const double stiffness = batch.law.stiffness > 0 ? batch.law.stiffness : e.stiffness / share;
    batch.points.push_back({point[e.ends[0]], point[e.ends[1]]});
    batch.length.push_back(length);
    batch.parameters.push_back(spring_parameters(batch.law, length, share, stiffness));
    batch.damper.push_back(share * batch.law.damping + rest_stiffness(batch, batch.size() - 1) * e.damping / e.stiffness);
    batch.stiffness_damping = batch.stiffness_damping || e.damping > 0;
  }
  batch.omega2 = edges_omega2(body, draft, place, uncut);
  if (batch.size() > 0) model.links.springs.push_back(std::move(batch));
}

}  // namespace pliant
