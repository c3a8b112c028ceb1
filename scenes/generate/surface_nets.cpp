#include "scenes/generate/surface_nets.h"

#include <array>
#include <cmath>

namespace pliant {
namespace {

constexpr int kProjections = 4;

Vec3d gradient(const Implicit& body, const Vec3d& p, double h) {
  Vec3d g{};
  for (int a = 0; a < 3; ++a) {
    Vec3d low = p, high = p;
    low[a] -= h;
    high[a] += h;
    g[a] = (body(high) - body(low)) / (2 * h);
  }
  return g;
}

class Nets {
 public:
  Nets(const Implicit& body, const vec::Box& box, double step) : body_(body), low_(box.lower), step_(step) {
    for (int a = 0; a < 3; ++a) size_[a] = static_cast<int>(std::ceil((box.upper[a] - box.lower[a]) / step)) + 1;
    values_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
    vertex_.assign(values_.size(), -1);
    for (int k = 0; k < size_[2]; ++k) {
      for (int j = 0; j < size_[1]; ++j) {
        for (int i = 0; i < size_[0]; ++i) values_[at(i, j, k)] = body_(point(i, j, k));
      }
    }
  }

  TriangleMesh mesh() {
    for (int k = 0; k + 1 < size_[2]; ++k) {
      for (int j = 0; j + 1 < size_[1]; ++j) {
        for (int i = 0; i + 1 < size_[0]; ++i) add_vertex(i, j, k);
      }
    }
    for (int k = 1; k + 1 < size_[2]; ++k) {
      for (int j = 1; j + 1 < size_[1]; ++j) {
        for (int i = 1; i + 1 < size_[0]; ++i) {
          for (int axis = 0; axis < 3; ++axis) add_quad({i, j, k}, axis);
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::size_t at(int i, int j, int k) const {
    return i + static_cast<std::size_t>(size_[0]) * (j + static_cast<std::size_t>(size_[1]) * k);
  }
  [[nodiscard]] Vec3d point(double i, double j, double k) const {
    return {low_[0] + step_ * i, low_[1] + step_ * j, low_[2] + step_ * k};
  }

  void add_vertex(int i, int j, int k) {
    Vec3d sum{};
    int crossings = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 4; ++side) {
        std::array<int, 3> a{i, j, k};
        a[(axis + 1) % 3] += side & 1;
        a[(axis + 2) % 3] += side >> 1;
        std::array<int, 3> b = a;
        ++b[axis];
        const double u = values_[at(a[0], a[1], a[2])], v = values_[at(b[0], b[1], b[2])];
        if ((u < 0) == (v < 0)) continue;
        Vec3d p{1.0 * a[0], 1.0 * a[1], 1.0 * a[2]};
        p[axis] += u / (u - v);
        sum = vec::add(sum, p);
        ++crossings;
      }
    }
    if (crossings == 0) return;
    Vec3d p = point(sum[0] / crossings, sum[1] / crossings, sum[2] / crossings);
    for (int n = 0; n < kProjections; ++n) {
      const Vec3d g = gradient(body_, p, 1e-3 * step_);
      const double g2 = vec::dot(g, g);
      if (!(g2 > 0)) break;
      Vec3d move = vec::mul(g, -body_(p) / g2);
      const double length = vec::norm(move);
      if (length > 0.5 * step_) move = vec::mul(move, 0.5 * step_ / length);
      p = vec::add(p, move);
    }
    vertex_[at(i, j, k)] = static_cast<std::int32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(p);
  }

  // The quad of the four cells around the grid edge from (i, j, k) along the axis.
  void add_quad(const std::array<int, 3>& from, int axis) {
    std::array<int, 3> to = from;
    ++to[axis];
    const bool inside = values_[at(from[0], from[1], from[2])] < 0;
    if (inside == (values_[at(to[0], to[1], to[2])] < 0)) return;
    std::array<std::int32_t, 4> v{};
    for (int c = 0; c < 4; ++c) {  // counter-clockwise seen from the upper end of the edge
      std::array<int, 3> cell = from;
      cell[(axis + 1) % 3] -= c == 0 || c == 3 ? 1 : 0;
      cell[(axis + 2) % 3] -= c < 2 ? 1 : 0;
      v[c] = vertex_[at(cell[0], cell[1], cell[2])];
    }
    if (!inside) std::swap(v[1], v[3]);
    const auto& x = mesh_.vertices;
    if (vec::norm(vec::sub(x[v[0]], x[v[2]])) <= vec::norm(vec::sub(x[v[1]], x[v[3]]))) {
      mesh_.triangles.push_back({v[0], v[1], v[2]});
      mesh_.triangles.push_back({v[0], v[2], v[3]});
    } else {
      mesh_.triangles.push_back({v[0], v[1], v[3]});
      mesh_.triangles.push_back({v[1], v[2], v[3]});
    }
  }

  const Implicit& body_;
  Vec3d low_;
  double step_;
  std::array<int, 3> size_{};
  std::vector<double> values_;
  std::vector<std::int32_t> vertex_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh surface_nets(const Implicit& body, const vec::Box& box, double step) { return Nets(body, box, step).mesh(); }

}  // namespace pliant
