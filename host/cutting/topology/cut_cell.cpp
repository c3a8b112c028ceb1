#include "cutting/topology/cut_cell.h"

#include <algorithm>
#include <bit>

#include "lattice/lattice.h"

namespace pliant {
namespace {

/// All pairs of corners of which one has all bits of the other: what the Kuhn tetrahedra have as edges. By length, axis edges
/// first.
constexpr std::array<std::array<int, 2>, 19> kLatticeEdges{{{0, 1},
                                                            {0, 2},
                                                            {0, 4},
                                                            {1, 3},
                                                            {1, 5},
                                                            {2, 3},
                                                            {2, 6},
                                                            {3, 7},
                                                            {4, 5},
                                                            {4, 6},
                                                            {5, 7},
                                                            {6, 7},
                                                            {0, 3},
                                                            {0, 5},
                                                            {0, 6},
                                                            {1, 7},
                                                            {2, 7},
                                                            {4, 7},
                                                            {0, 7}}};
constexpr std::array<std::array<int, 4>, 6> kLatticeFaces{
    {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};
constexpr std::array<std::array<int, 4>, 1> kOneTet{{{0, 1, 2, 3}}};
constexpr std::array<std::array<int, 4>, 4> kPaddedFaces{{{1, 2, 3, 3}, {0, 3, 2, 2}, {0, 1, 3, 3}, {0, 2, 1, 1}}};

/// The corner that a ray from `from` through `point` leaves last, among those with weight in `from`.
int opposite(const std::array<double, 4>& point, const std::array<double, 4>& from, int without) {
  int best = -1;
  for (int i = 0; i < 4; ++i) {
    if (i == without) continue;
    if (best < 0 || point[i] * from[best] < point[best] * from[i]) best = i;
  }
  return best;
}

CellShape with_edge_numbers(CellShape shape) {
  for (auto& row : shape.edge_of) row.fill(-1);
  for (std::size_t e = 0; e < shape.edges.size(); ++e) {
    const auto [a, b] = shape.edges[e];
    shape.edge_of[a][b] = shape.edge_of[b][a] = static_cast<std::int8_t>(e);
  }
  return shape;
}

}  // namespace

const CellShape& lattice_cell_shape() {
  static const CellShape shape = with_edge_numbers({8, kKuhnTets, kLatticeEdges, kLatticeFaces, {}});
  return shape;
}

const CellShape& tetrahedron_shape() {
  static const CellShape shape = with_edge_numbers({4, kOneTet, kTetEdges, kPaddedFaces, {}});
  return shape;
}

TetDivision divide(const DivisionPoints& points, const std::array<char, 6>& cut, const std::array<double, 6>& crossing) {
  TetDivision d;
  for (int e = 0; e < 6; ++e) d.edge[e] = cut[e] != 0 ? crossing[e] : 0.5;
  const auto add = [&](std::array<double, 4>& sum, int e) {
    sum[kTetEdges[e][0]] += 1 - d.edge[e];
    sum[kTetEdges[e][1]] += d.edge[e];
  };
  for (int f = 0; f < 4; ++f) {
    const auto& [a, b, c] = kTetFaces[f];
    const std::array<int, 3> edges{kTetEdgeOf[a][b], kTetEdgeOf[b][c], kTetEdgeOf[c][a]};
    const int count = std::popcount(points.face[f]);
    if (count == 0) {
      d.face[f][a] = d.face[f][b] = d.face[f][c] = 1.0 / 3;
      continue;
    }
    for (const int e : edges) {
      if ((points.face[f] >> e & 1) != 0) add(d.face[f], e);
    }
    for (double& w : d.face[f]) w /= count;
  }
  const int count = std::popcount(points.centre);
  for (int e = 0; e < 6; ++e) {
    if ((points.centre >> e & 1) != 0) add(d.centre, e);
  }
  for (double& w : d.centre) w = count == 0 ? 0.25 : w / count;
  return d;
}

std::array<double, 4> corner_shares(const TetDivision& d) {
  std::array<double, 4> share{};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (j == i) continue;
      int a = 0;
      while (a == i || a == j) ++a;
      const int b = 6 - i - j - a, e = kTetEdgeOf[a][b];
      const double part = d.centre[i] * d.face[i][j];
      share[a] += part * d.edge[e];
      share[b] += part * (1 - d.edge[e]);
    }
  }
  return share;
}

int corner_at(const TetDivision& d, const std::array<double, 4>& point) {
  const int i = opposite(point, d.centre, -1);
  std::array<double, 4> on_face = point;
  for (int k = 0; k < 4; ++k) on_face[k] = point[k] * d.centre[i] - d.centre[k] * point[i];
  const int j = opposite(on_face, d.face[i], i);
  int a = 0;
  while (a == i || a == j) ++a;
  const int b = 6 - i - j - a;
  const double wa = on_face[a] * d.face[i][j] - d.face[i][a] * on_face[j];
  const double wb = on_face[b] * d.face[i][j] - d.face[i][b] * on_face[j];
  return wb < d.edge[kTetEdgeOf[a][b]] * (wa + wb) ? a : b;
}

}  // namespace pliant
