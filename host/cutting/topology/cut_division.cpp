#include "cutting/topology/cut_division.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "geometry/barycentric.h"
#include "geometry/vec.h"
#include "lattice/lattice_cell.h"

namespace pliant {
namespace {

/// A component in which no sample of the cell lies, but some surface, has this share of what its volume would have in a full
/// cell.
constexpr double kUnseen = 1e-3;

struct SamplePlace {
  int tet;
  std::array<double, 4> weight;
};

/// The tetrahedron of a lattice cell that holds a point in cell units, and its barycentric coordinates.
SamplePlace place_in_cell(const Vec3d& x) {
  std::array<int, 3> axis{0, 1, 2};
  std::stable_sort(axis.begin(), axis.end(), [&](int i, int j) { return x[i] > x[j]; });
  std::array<double, 8> weight{};
  const int first = 1 << axis[0], second = first | 1 << axis[1];
  weight[0] = 1 - x[axis[0]];
  weight[first] = x[axis[0]] - x[axis[1]];
  weight[second] = x[axis[1]] - x[axis[2]];
  weight[7] = x[axis[2]];
  const auto tets = lattice_cell_shape().tets;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    if (std::find(tets[t].begin(), tets[t].end(), first) == tets[t].end()) continue;
    if (std::find(tets[t].begin(), tets[t].end(), second) == tets[t].end()) continue;
    return {static_cast<int>(t), {weight[tets[t][0]], weight[tets[t][1]], weight[tets[t][2]], weight[tets[t][3]]}};
  }
  return {};  // not reached: the six tetrahedra are the six orders of the axes
}

const std::array<SamplePlace, 64>& sample_places() {
  static const std::array<SamplePlace, 64> places = [] {
    std::array<SamplePlace, 64> all{};
    for (int s = 0; s < 64; ++s) all[s] = place_in_cell(sample_point(s));
    return all;
  }();
  return places;
}

/// No copy is lighter than the lightest part of a lattice cell may be: nodes with next to no mass are beyond what float
/// resolves when the stable step is estimated. The shares' sum stays 1.
void raise_to_floor(std::array<double, 8>& share) {
  double sum = 0;
  for (double& s : share) {
    if (s > 0) s = std::max(s, kFillFloor);
    sum += s;
  }
  for (double& s : share) s /= sum;
}

/// A tetrahedron of a lattice cell with two corners in each of two components: the surface between them is two triangles
/// (cell_interface.h), and the centre lies on their common edge. The edges whose points it joins; 0: any other tetrahedron.
std::uint8_t between_pairs(const std::array<int, 4>& corner, const std::array<std::int8_t, 8>& label) {
  std::array<int, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return corner[i] < corner[j]; });
  std::array<int, 4> with{}, without{};
  std::size_t own = 0, other = 0;
  for (const int i : order) {
    const bool same = label[corner[i]] == label[corner[order[0]]];
    (same ? with[own++] : without[other++]) = i;
  }
  if (own != 2 || label[corner[without[0]]] != label[corner[without[1]]]) return 0;
  return static_cast<std::uint8_t>(1 << kTetEdgeOf[with[0]][without[0]] | 1 << kTetEdgeOf[with[1]][without[1]]);
}

/// Of a copy, what each of those that it is divided into takes at least.
constexpr double kLeastPart = 1e-3;

}  // namespace

void label_components(const CellShape& shape, CellCut& cell) {
  std::array<int, 8> root{};
  std::iota(root.begin(), root.end(), 0);
  for (std::size_t e = 0; e < shape.edges.size(); ++e) {
    if (cell.cut >> e & 1) continue;
    const int a = root[shape.edges[e][0]], b = root[shape.edges[e][1]];
    if (a == b) continue;
    for (int& r : root) r = r == std::max(a, b) ? std::min(a, b) : r;
  }
  cell.components = 0;
  for (int a = 0; a < shape.corners; ++a) {
    cell.label[a] = root[a] == a ? static_cast<std::int8_t>(cell.components++) : cell.label[root[a]];
  }
}

void CutDivision::place_centres(CellCut& cut) const {
  for (std::size_t t = 0; t < mesh_.shape->tets.size(); ++t) {
    if (cut.centre[t] != 0) continue;
    const auto& corner = mesh_.shape->tets[t];
    cut.centre[t] = mesh_.shape->corners == 8 ? between_pairs(corner, cut.label) : 0;
    if (cut.centre[t] != 0) continue;
    for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
      if (cut.label[corner[kTetEdges[e][0]]] == cut.label[corner[kTetEdges[e][1]]]) continue;
      cut.centre[t] |= static_cast<std::uint8_t>(1 << e);
    }
  }
}

DivisionPoints CutDivision::points(const CellCut& cut, int tet) const {
  DivisionPoints out;
  out.centre = cut.centre[tet];
  const auto& corner = mesh_.shape->tets[tet];
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& [a, b, c] = kTetFaces[f];
    const std::array<int, 3> edges{kTetEdgeOf[a][b], kTetEdgeOf[b][c], kTetEdgeOf[c][a]};
    std::array<std::int32_t, 3> when{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [from, to] = kTetEdges[edges[i]];
      const int e = mesh_.shape->edge_of[corner[from]][corner[to]];
      when[i] = (cut.cut >> e & 1) != 0 ? cut.when[e] : -1;
    }
    const std::array<bool, 3> at = at_face_point(when);
    for (std::size_t i = 0; i < 3; ++i) out.face[f] |= static_cast<std::uint8_t>(at[i] ? 1 << edges[i] : 0);
  }
  return out;
}

TetDivision CutDivision::of(std::int32_t cell, const CellCut& cut, int tet) const {
  const auto& corner = mesh_.shape->tets[tet];
  std::array<char, 6> is_cut{};
  std::array<double, 6> crossing{};
  for (int e = 0; e < 6; ++e) {
    const int from = corner[kTetEdges[e][0]], to = corner[kTetEdges[e][1]];
    if ((cut.cut >> mesh_.shape->edge_of[from][to] & 1) == 0) continue;
    const std::int32_t a = mesh_.cells[cell][from], b = mesh_.cells[cell][to];
    const double t = edges_.at(node_pair(a, b));
    is_cut[e] = 1;
    crossing[e] = a < b ? t : 1 - t;
  }
  return divide(points(cut, tet), is_cut, crossing);
}

void CutDivision::inherit(const CellCut& before, CellCut& cut) const {
  if (before.components < 2) return;
  std::array<int, 8> parent{};
  for (int a = mesh_.shape->corners - 1; a >= 0; --a) parent[cut.label[a]] = before.label[a];
  std::array<double, 8> whole{}, sum{};
  for (int k = 0; k < cut.components; ++k) whole[parent[k]] += cut.share[k];
  for (int k = 0; k < cut.components; ++k) {
    if (cut.share[k] > 0) cut.share[k] = std::max(cut.share[k] / whole[parent[k]], kLeastPart);
    sum[parent[k]] += cut.share[k];
  }
  for (int k = 0; k < cut.components; ++k) {
    if (cut.share[k] > 0) cut.share[k] *= before.share[parent[k]] / sum[parent[k]];
  }
}

void CutDivision::share(std::int32_t cell, CellCut& cut) const {
  cut.share.fill(0);
  if (cut.components == 1) {
    cut.share[0] = 1;
    return;
  }
  const CellShape& shape = *mesh_.shape;
  std::array<TetDivision, 6> tets;
  std::array<double, 8> volume{};
  const auto count = static_cast<int>(shape.tets.size());  // of a lattice cell all have the same volume
  for (int t = 0; t < count; ++t) {
    tets[t] = of(cell, cut, t);
    const std::array<double, 4> part = corner_shares(tets[t]);
    for (int a = 0; a < 4; ++a) volume[cut.label[shape.tets[t][a]]] += part[a] / count;
  }
  if (mesh_.material.empty() || mesh_.material[cell] == kAllSamples) {
    cut.share = volume;
    raise_to_floor(cut.share);
    return;
  }
  std::array<double, 8> samples{};
  for (std::uint64_t rest = mesh_.material[cell]; rest != 0; rest &= rest - 1) {
    const SamplePlace& place = sample_places()[std::countr_zero(rest)];
    samples[cut.label[shape.tets[place.tet][corner_at(tets[place.tet], place.weight)]]] += 1.0 / 64;
  }
  double sum = 0;
  for (int k = 0; k < cut.components; ++k) {
    cut.share[k] = samples[k] + kUnseen * volume[k];
    sum += cut.share[k];
  }
  if (sum == 0) cut.share[std::max_element(volume.begin(), volume.end()) - volume.begin()] = sum = 1;
  for (double& s : cut.share) s /= sum;
  raise_to_floor(cut.share);
}

CutTet CutDivision::tet(std::int32_t cell, const CellCut* cut, int tet) const {
  CutTet out;
  const auto& corner = mesh_.shape->tets[tet];
  for (int a = 0; a < 4; ++a) {
    out.node[a] = mesh_.cells[cell][corner[a]];
    out.label[a] = cut == nullptr ? 0 : cut->label[corner[a]];
    out.corner[a] = mesh_.rest[out.node[a]];
  }
  const DivisionPoints points = cut == nullptr ? DivisionPoints{} : this->points(*cut, tet);
  std::array<NodePair, 6> pair{};
  for (int e = 0; e < 6; ++e) {
    pair[e] = node_pair(out.node[kTetEdges[e][0]], out.node[kTetEdges[e][1]]);
    const auto found = edges_.find(pair[e]);
    out.cut[e] = found != edges_.end();
    const Vec3d &a = mesh_.rest[pair[e][0]], &b = mesh_.rest[pair[e][1]];
    out.edge[e] = vec::add(a, vec::mul(vec::sub(b, a), out.cut[e] ? found->second : 0.5));
  }
  for (int f = 0; f < 4; ++f) {
    // Edges ascending by their nodes: the cell on the other side sums in the same order.
    const auto& [a, b, c] = kTetFaces[f];
    std::array<int, 3> edges{kTetEdgeOf[a][b], kTetEdgeOf[b][c], kTetEdgeOf[c][a]};
    std::sort(edges.begin(), edges.end(), [&](int i, int j) { return pair[i] < pair[j]; });
    const int count = std::popcount(points.face[f]);
    for (const int e : edges) {
      // The centroid of a face is the mean of the middles of its edges.
      const Vec3d middle = vec::mul(vec::add(mesh_.rest[pair[e][0]], mesh_.rest[pair[e][1]]), 0.5);
      if (count == 0) out.face[f] = vec::add(out.face[f], vec::mul(middle, 1.0 / 3));
      if ((points.face[f] >> e & 1) != 0) out.face[f] = vec::add(out.face[f], vec::mul(out.edge[e], 1.0 / count));
    }
  }
  const int count = std::popcount(points.centre);
  Vec3d between{}, corners{};
  for (int e = 0; e < 6; ++e) {
    if ((points.centre >> e & 1) != 0) between = vec::add(between, out.edge[e]);
  }
  for (const Vec3d& x : out.corner) corners = vec::add(corners, x);
  out.centre = count > 0 ? vec::mul(between, 1.0 / count) : vec::mul(corners, 0.25);
  return out;
}

int CutDivision::label_at(std::int32_t cell, const CellCut* cut, const Vec3d& x) const {
  if (cut == nullptr || cut->components == 1) return 0;
  // The tetrahedron in which the least coordinate is largest: the one around the point, or the nearest.
  int best = 0;
  double depth = -HUGE_VAL;
  std::array<double, 4> weight{};
  for (std::size_t t = 0; t < mesh_.shape->tets.size(); ++t) {
    std::array<Vec3d, 4> corner;
    for (int a = 0; a < 4; ++a) corner[a] = mesh_.rest[mesh_.cells[cell][mesh_.shape->tets[t][a]]];
    const std::array<double, 4> w = barycentric_weights(corner, x);
    const double least = *std::min_element(w.begin(), w.end());
    if (least <= depth) continue;
    depth = least;
    weight = w;
    best = static_cast<int>(t);
  }
  return label_in(cell, cut, best, weight);
}

int CutDivision::label_in(std::int32_t cell, const CellCut* cut, int tet, const std::array<double, 4>& weight) const {
  if (cut == nullptr || cut->components == 1) return 0;
  return cut->label[mesh_.shape->tets[tet][corner_at(of(cell, *cut, tet), weight)]];
}

}  // namespace pliant
