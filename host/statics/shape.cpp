#include "statics/shape.h"

#include <cmath>

namespace pliant::statics {
namespace {

/// Corners of the edges whose middles are nodes 4..9.
constexpr int kEdgeCorners[6][2]{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

Eigen::Vector4d barycentric(const Vector3d& l) { return {1 - l.sum(), l[0], l[1], l[2]}; }

/// Column a: gradient of barycentric coordinate a.
Eigen::Matrix<double, 3, 4> barycentric_gradients() {
  Eigen::Matrix<double, 3, 4> g;
  g.col(0).setConstant(-1);
  g.rightCols<3>().setIdentity();
  return g;
}

/// All permutations of a tetrahedron's point with weights (1 - 3 a, a, a, a).
void add_corner_points(std::vector<LocalPoint>& rule, double a, double weight) {
  rule.push_back({Vector3d::Constant(a), weight / 6});
  for (int c = 0; c < 3; ++c) {
    Vector3d at = Vector3d::Constant(a);
    at[c] = 1 - 3 * a;
    rule.push_back({at, weight / 6});
  }
}

/// All permutations of (1/2 - a, 1/2 - a, a, a).
void add_edge_points(std::vector<LocalPoint>& rule, double a, double weight) {
  for (const auto& edge : kEdgeCorners) {
    Eigen::Vector4d l = Eigen::Vector4d::Constant(a);
    l[edge[0]] = l[edge[1]] = 0.5 - a;
    rule.push_back({l.tail<3>(), weight / 6});
  }
}

std::vector<LocalPoint> tet_rule(int degree) {
  std::vector<LocalPoint> rule;
  if (degree == 1) return {{Vector3d::Constant(0.25), 1.0 / 6}};
  if (degree == 2) {
    add_corner_points(rule, (5 - std::sqrt(5.0)) / 20, 0.25);
    return rule;
  }
  // Fourteen points of degree 5 (Walkington 2000); a test integrates all monomials.
  add_corner_points(rule, 0.31088591926330060980, 0.11268792571801585080);
  add_corner_points(rule, 0.092735250310891226402, 0.073493043116361949544);
  add_edge_points(rule, 0.045503704125649649492, 0.042546020777081466438);
  return rule;
}

/// Product of Gauss's rule with 2 or 3 points per direction.
std::vector<LocalPoint> hex_rule(int points) {
  const std::vector<double> at = points == 2 ? std::vector<double>{-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)}
                                             : std::vector<double>{-std::sqrt(0.6), 0, std::sqrt(0.6)};
  const std::vector<double> weight =
      points == 2 ? std::vector<double>{0.5, 0.5} : std::vector<double>{5.0 / 18, 8.0 / 18, 5.0 / 18};
  std::vector<LocalPoint> rule;
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < points; ++j) {
      for (int i = 0; i < points; ++i) {
        rule.push_back({Vector3d(1 + at[i], 1 + at[j], 1 + at[k]) / 2, weight[i] * weight[j] * weight[k]});
      }
    }
  }
  return rule;
}

}  // namespace

int corners_of(Element element) { return element == Element::tet4 ? 4 : element == Element::tet10 ? 10 : 8; }

const char* to_string(Element element) {
  return element == Element::tet4 ? "tet4" : element == Element::tet10 ? "tet10" : "hex8full";
}

ShapeValues shape_values(Element element, const Vector3d& local) {
  ShapeValues n(corners_of(element));
  if (element == Element::hex8full) {
    for (int a = 0; a < 8; ++a) {
      n[a] = 1;
      for (int c = 0; c < 3; ++c) n[a] *= (a >> c & 1) != 0 ? local[c] : 1 - local[c];
    }
    return n;
  }
  const Eigen::Vector4d l = barycentric(local);
  if (element == Element::tet4) {
    n = l;
    return n;
  }
  for (int a = 0; a < 4; ++a) n[a] = l[a] * (2 * l[a] - 1);
  for (int e = 0; e < 6; ++e) n[4 + e] = 4 * l[kEdgeCorners[e][0]] * l[kEdgeCorners[e][1]];
  return n;
}

Gradients shape_gradients(Element element, const Vector3d& local) {
  Gradients g(3, corners_of(element));
  if (element == Element::hex8full) {
    for (int a = 0; a < 8; ++a) {
      for (int d = 0; d < 3; ++d) {
        double value = (a >> d & 1) != 0 ? 1 : -1;
        for (int c = 0; c < 3; ++c) {
          if (c != d) value *= (a >> c & 1) != 0 ? local[c] : 1 - local[c];
        }
        g(d, a) = value;
      }
    }
    return g;
  }
  const Eigen::Matrix<double, 3, 4> b = barycentric_gradients();
  if (element == Element::tet4) {
    g = b;
    return g;
  }
  const Eigen::Vector4d l = barycentric(local);
  for (int a = 0; a < 4; ++a) g.col(a) = (4 * l[a] - 1) * b.col(a);
  for (int e = 0; e < 6; ++e) {
    const int i = kEdgeCorners[e][0], j = kEdgeCorners[e][1];
    g.col(4 + e) = 4 * (l[i] * b.col(j) + l[j] * b.col(i));
  }
  return g;
}

const std::vector<LocalPoint>& quadrature(Element element) {
  static const std::vector<LocalPoint> tet4 = tet_rule(1), tet10 = tet_rule(2), hex = hex_rule(2);
  return element == Element::tet4 ? tet4 : element == Element::tet10 ? tet10 : hex;
}

const std::vector<LocalPoint>& accurate_quadrature(Element element) {
  static const std::vector<LocalPoint> tet = tet_rule(5), hex = hex_rule(3);
  return element == Element::hex8full ? hex : tet;
}

const std::vector<FacePoint>& triangle_rule(Element element) {
  static const std::vector<FacePoint> one{{1.0 / 3, 1.0 / 3, 0.5}}, six = [] {
    // Six points of degree 4 (Strang and Fix 1973); a test integrates all monomials.
    std::vector<FacePoint> rule;
    for (const auto& [a, weight] : {std::pair{0.44594849091596488632, 0.22338158967801146570},
                                    std::pair{0.09157621350977074346, 0.10995174365532186764}}) {
      for (const auto& [r, s] : {std::pair{a, a}, std::pair{1 - 2 * a, a}, std::pair{a, 1 - 2 * a}})
        rule.push_back({r, s, weight / 2});
    }
    return rule;
  }();
  return element == Element::tet4 ? one : six;
}

Gradients corners_at(const Mesh& mesh, std::int64_t element) {
  const int count = corners_of(mesh.element);
  Gradients x(3, count);
  for (int a = 0; a < count; ++a) x.col(a) = eigen(mesh.nodes[mesh.nodes_of(element)[a]]);
  return x;
}

const std::vector<std::vector<int>>& faces_of(Element element) {
  static const std::vector<std::vector<int>> tet4{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  static const std::vector<std::vector<int>> tet10{
      {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}};
  static const std::vector<std::vector<int>> hex{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  return element == Element::tet4 ? tet4 : element == Element::tet10 ? tet10 : hex;
}

}  // namespace pliant::statics
