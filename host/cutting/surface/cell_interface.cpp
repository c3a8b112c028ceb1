#include "cutting/surface/cell_interface.h"

#include <algorithm>

#include "cutting/topology/cut_cell.h"

namespace pliant::overlay {
namespace {

struct KuhnTable {
  std::array<std::array<int, 8>, 8> edge{};
  KuhnTable() {
    for (auto& row : edge) row.fill(-1);
    for (std::size_t e = 0; e < kKuhnEdges.size(); ++e) {
      const auto [a, b] = kKuhnEdges[e];
      edge[a][b] = edge[b][a] = static_cast<int>(e);
    }
  }
};

class Builder {
 public:
  Builder(const CutGrid& grid, const CutGridCell& cell) : grid_(grid), cell_(cell) {
    for (int c = 0; c < 8; ++c) corner_[c] = grid.position(corner_index(cell.index, c));
  }

  CellInterface build() {
    for (int t = 0; t < 6; ++t) {
      tet_ = t;
      const auto& v = kPaths[t];
      std::array<int, 4> side{};  // corners by label: how many labels, and who has which
      int others = 0;
      bool mixed = false, plain = true;
      for (int i = 1; i < 4; ++i) {
        const auto label = cell_.label[v[i]];
        if (label == cell_.label[v[0]]) continue;
        if (mixed && label != cell_.label[v[others]]) plain = false;
        if (!mixed) others = i;
        mixed = true;
        side[i] = 1;
      }
      if (!mixed) continue;
      for (int f = 0; f < 4; ++f) plain = plain && cuts(v[(f + 1) & 3], v[(f + 2) & 3], v[(f + 3) & 3]) < 3;
      if (plain) {
        two_parts(v, side);
      } else {
        many_parts(v);
      }
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool cut(int a, int b) const { return cell_.crossing[kuhn_edge(a, b)] >= 0; }
  [[nodiscard]] int cuts(int a, int b, int c) const { return int{cut(a, b)} + int{cut(b, c)} + int{cut(c, a)}; }
  [[nodiscard]] bool apart(int a, int b) const { return cell_.label[a] != cell_.label[b]; }

  std::int8_t add(std::int64_t id, const Vec3d& x) {
    for (std::size_t i = 0; i < out_.points.size(); ++i) {
      if (out_.points[i].id == id) return static_cast<std::int8_t>(i);
    }
    out_.points.push_back({id, x});
    return static_cast<std::int8_t>(out_.points.size() - 1);
  }
  [[nodiscard]] std::int64_t id(int corner, int kind) const {
    return 64 * grid_.number(corner_index(cell_.index, corner)) + kind;
  }

  [[nodiscard]] Vec3d edge_point(int a, int b) const {
    if (a > b) std::swap(a, b);
    return vec::add(corner_[a], vec::mul(vec::sub(corner_[b], corner_[a]), cell_.crossing[kuhn_edge(a, b)]));
  }
  std::int8_t edge(int a, int b) {
    if (a > b) std::swap(a, b);
    return add(id(a, a ^ b), edge_point(a, b));
  }
  /// The point of a face whose three edges are cut: the middle of those that were cut first, two or all.
  std::int8_t face(std::array<int, 3> v) {
    std::sort(v.begin(), v.end());
    const std::array<std::array<int, 2>, 3> edges{{{v[0], v[1]}, {v[0], v[2]}, {v[1], v[2]}}};
    std::array<std::int32_t, 3> when{};
    for (std::size_t i = 0; i < 3; ++i) when[i] = cell_.when[kuhn_edge(edges[i][0], edges[i][1])];
    const std::array<bool, 3> at = at_face_point(when);
    Vec3d sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (at[i]) sum = vec::add(sum, edge_point(edges[i][0], edges[i][1]));
    }
    const auto count = static_cast<double>(std::count(at.begin(), at.end(), true));
    return add(id(v[0], 8 * (v[0] ^ v[1]) + (v[0] ^ v[2])), vec::mul(sum, 1.0 / count));
  }

  /// `a` and `b` are corners whose edge the triangle separates.
  void emit(std::int8_t p, std::int8_t q, std::int8_t r, int a, int b) {
    const Vec3d &x = out_.points[p].x, &y = out_.points[q].x, &z = out_.points[r].x;
    const Vec3d normal = vec::cross(vec::sub(y, x), vec::sub(z, x));
    if (vec::dot(normal, vec::sub(corner_[b], corner_[a])) < 0) std::swap(q, r);
    out_.faces.push_back({{p, q, r}, cell_.label[a], cell_.label[b], static_cast<std::int8_t>(tet_)});
  }

  /// Between three cut points. The later ones are numbered first: numbers decide the order of the surface and so bits, and the
  /// order in which a compiler evaluates arguments must not.
  void emit_edges(const std::array<std::array<int, 2>, 3>& cut, int a, int b) {
    std::array<std::int8_t, 3> p{};
    for (const std::size_t i : {2, 1, 0}) p[i] = edge(cut[i][0], cut[i][1]);
    emit(p[0], p[1], p[2], a, b);
  }

  void two_parts(const std::array<int, 4>& v, const std::array<int, 4>& side) {
    std::array<std::array<int, 4>, 2> part{};
    std::array<int, 2> count{};
    for (int i = 0; i < 4; ++i) part[side[i]][count[side[i]]++] = v[i];
    const auto &a = part[0], &b = part[1];
    if (count[0] == 2) {
      const std::int8_t p = edge(a[0], b[0]), q = edge(a[0], b[1]), r = edge(a[1], b[1]), s = edge(a[1], b[0]);
      emit(p, q, r, a[0], b[1]);
      emit(p, r, s, a[1], b[0]);
    } else if (count[0] == 1) {
      emit_edges({{{a[0], b[0]}, {a[0], b[1]}, {a[0], b[2]}}}, a[0], b[0]);
    } else {
      emit_edges({{{a[0], b[0]}, {a[1], b[0]}, {a[2], b[0]}}}, a[0], b[0]);
    }
  }

  void many_parts(const std::array<int, 4>& v) {
    Vec3d sum{};
    int count = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        const std::uint32_t chosen = cell_.centre[tet_];
        if (chosen == 0 ? !apart(v[i], v[j]) : (chosen >> kuhn_edge(v[i], v[j]) & 1) == 0) continue;
        sum = vec::add(sum, edge_point(v[i], v[j]));
        ++count;
      }
    }
    const std::int8_t centre = add(id(0, 9 * (tet_ + 1)), vec::mul(sum, 1.0 / count));
    for (int f = 0; f < 4; ++f) {
      const std::array<int, 3> w{v[(f + 1) & 3], v[(f + 2) & 3], v[(f + 3) & 3]};
      if (cuts(w[0], w[1], w[2]) == 3) {
        for (int i = 0; i < 3; ++i) {
          const int a = w[i], b = w[(i + 1) % 3];
          if (!apart(a, b)) continue;
          const std::int8_t middle = face(w);
          emit(edge(a, b), middle, centre, a, b);
        }
      } else {
        for (int i = 0; i < 3; ++i) {  // one corner against two
          const int a = w[i], b = w[(i + 1) % 3], c = w[(i + 2) % 3];
          if (!apart(a, b) || !apart(a, c) || apart(b, c)) continue;
          const std::int8_t further = edge(a, c);
          emit(edge(a, b), further, centre, a, b);
        }
      }
    }
  }

  const CutGrid& grid_;
  const CutGridCell& cell_;
  std::array<Vec3d, 8> corner_{};
  int tet_ = 0;
  CellInterface out_;
};

}  // namespace

int kuhn_edge(int a, int b) {
  static const KuhnTable table;
  return table.edge[a][b];
}

std::size_t path_of(std::array<int, 4> corners) {
  std::sort(corners.begin(), corners.end());
  return static_cast<std::size_t>(std::find(kPaths.begin(), kPaths.end(), corners) - kPaths.begin());
}

CellInterface interface_of(const CutGrid& grid, const CutGridCell& cell) { return Builder(grid, cell).build(); }

int component_at(const SurfaceSource& source, const CutGridCell& cell, const CellInterface& faces, const ExactPoint& p) {
  std::array<ExactPoint, 8> corner;
  for (int c = 0; c < 8; ++c) corner[c] = source.exact_corner(corner_index(cell.index, c));
  for (int t = 0; t < 6; ++t) {
    const auto& v = kPaths[t];
    const ExactPoint &a = corner[v[0]], &b = corner[v[1]], &c = corner[v[2]], &d = corner[v[3]];
    const int all = orient(a, b, c, d);
    if (orient(p, b, c, d) != all || orient(a, p, c, d) != all || orient(a, b, p, d) != all || orient(a, b, c, p) != all)
      continue;
    // A corner that is seen from the point belongs to the same component; with two components parity does.
    int sighted = -1, other = -1, parity = 0;
    bool two = true;
    for (int i = 0; i < 4; ++i) {
      const int label = cell.label[v[i]];
      if (label != cell.label[v[0]]) {
        two = two && (other < 0 || other == label);
        other = label;
      }
      int hits = 0;
      for (const InterfaceFace& f : faces.faces) {
        if (f.tet != t) continue;
        std::array<ExactPoint, 3> x;
        for (int k = 0; k < 3; ++k) x[k] = source.frame().snap(faces.points[f.point[k]].x, faces.points[f.point[k]].id);
        if (crosses(p, corner[v[i]], x[0], x[1], x[2]) != 0) ++hits;
      }
      if (i == 0) parity = hits % 2;
      if (hits == 0 && sighted < 0) sighted = label;
    }
    if (other < 0) return cell.label[v[0]];
    if (two) return parity == 0 ? cell.label[v[0]] : other;
    return sighted >= 0 ? sighted : cell.label[v[0]];
  }
  return -1;
}

}  // namespace pliant::overlay
