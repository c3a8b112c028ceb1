// Meshes and loads of static problems: boxes, quadratic tetrahedra, sets of nodes, tractions.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "pliant/error.h"
#include "statics/shape.h"

namespace pliant::statics {
namespace {

constexpr int kEdges[6][2]{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

using Edge = std::pair<std::int32_t, std::int32_t>;

Edge edge_of(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

Mesh to_quadratic(const Mesh& mesh, std::map<Edge, std::int32_t>& middles) {
  if (mesh.element != Element::tet4)
    throw Error(ErrorCode::bad_input, fmt::format("to_quadratic: got a mesh of {}, expected tet4", to_string(mesh.element)));
  Mesh out{Element::tet10, mesh.nodes, {}, mesh.material, mesh.fill};
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    const std::int32_t* const nodes = mesh.nodes_of(e);
    out.corners.insert(out.corners.end(), nodes, nodes + 4);
    for (const auto& [i, j] : kEdges) {
      const auto [at, added] = middles.emplace(edge_of(nodes[i], nodes[j]), static_cast<std::int32_t>(out.nodes.size()));
      if (added) out.nodes.push_back(plain(0.5 * (eigen(mesh.nodes[nodes[i]]) + eigen(mesh.nodes[nodes[j]]))));
      out.corners.push_back(at->second);
    }
  }
  return out;
}

/// Faces that belong to one element: element and number of the face.
std::vector<std::pair<std::int64_t, int>> boundary_faces(const Mesh& mesh) {
  const auto& faces = faces_of(mesh.element);
  const std::size_t corners = mesh.element == Element::hex8full ? 4 : 3;
  struct Key {
    std::array<std::int32_t, 4> nodes;
    std::int64_t element;
    int face;
  };
  std::vector<Key> keys;
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      Key key{{-1, -1, -1, -1}, e, static_cast<int>(f)};
      for (std::size_t a = 0; a < corners; ++a) key.nodes[a] = mesh.nodes_of(e)[faces[f][a]];
      std::sort(key.nodes.begin(), key.nodes.end());
      keys.push_back(key);
    }
  }
  std::sort(keys.begin(), keys.end(),
            [](const Key& a, const Key& b) { return a.nodes != b.nodes ? a.nodes < b.nodes : a.element < b.element; });
  std::vector<std::pair<std::int64_t, int>> out;
  for (std::size_t i = 0; i < keys.size();) {
    std::size_t j = i + 1;
    while (j < keys.size() && keys[j].nodes == keys[i].nodes) ++j;
    if (j == i + 1) out.emplace_back(keys[i].element, keys[i].face);
    i = j;
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Shape functions of a face with 3, 4 or 6 nodes and their two local derivatives.
struct TractionPoint {
  Eigen::VectorXd n;
  Eigen::Matrix2Xd gradient;
  double weight = 0;
};

TractionPoint triangle_point(std::size_t nodes, double r, double s, double weight) {
  TractionPoint p{Eigen::VectorXd(nodes), Eigen::Matrix2Xd(2, nodes), weight};
  const Vector3d l(1 - r - s, r, s);
  Eigen::Matrix<double, 2, 3> b;
  b << -1, 1, 0, -1, 0, 1;
  for (int a = 0; a < 3; ++a) {
    p.n[a] = nodes == 3 ? l[a] : l[a] * (2 * l[a] - 1);
    p.gradient.col(a) = nodes == 3 ? Eigen::Vector2d(b.col(a)) : Eigen::Vector2d((4 * l[a] - 1) * b.col(a));
  }
  for (int e = 0; nodes == 6 && e < 3; ++e) {
    const int j = (e + 1) % 3;
    p.n[3 + e] = 4 * l[e] * l[j];
    p.gradient.col(3 + e) = 4 * (l[e] * b.col(j) + l[j] * b.col(e));
  }
  return p;
}

TractionPoint square_point(double r, double s, double weight) {
  TractionPoint p{Eigen::VectorXd(4), Eigen::Matrix2Xd(2, 4), weight};
  p.n << (1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s;
  p.gradient << -(1 - s), 1 - s, s, -s, -(1 - r), -r, r, 1 - r;
  return p;
}

std::vector<TractionPoint> face_rule(std::size_t nodes) {
  std::vector<TractionPoint> rule;
  if (nodes == 4) {
    const double g = 0.5 * (1 - std::sqrt(1.0 / 3));
    for (const double s : {g, 1 - g}) {
      for (const double r : {g, 1 - g}) rule.push_back(square_point(r, s, 0.25));
    }
    return rule;
  }
  constexpr double third = 1.0 / 6;  // three points of degree 2
  for (const auto& [r, s] : {std::pair{third, third}, {4 * third, third}, {third, 4 * third}})
    rule.push_back(triangle_point(nodes, r, s, third));
  return rule;
}

}  // namespace

Mesh to_quadratic(const Mesh& tet4) {
  std::map<Edge, std::int32_t> middles;
  return to_quadratic(tet4, middles);
}

Problem to_quadratic(const Problem& tet4) {
  Problem out = tet4;
  std::map<Edge, std::int32_t> middles;
  out.mesh = to_quadratic(tet4.mesh, middles);
  std::map<std::pair<std::int32_t, int>, const Prescribed*> prescribed;
  for (const Prescribed& p : tet4.prescribed) prescribed[{p.node, p.axis}] = &p;
  for (const auto& [edge, middle] : middles) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = prescribed.find({edge.first, axis}), b = prescribed.find({edge.second, axis});
      if (a == prescribed.end() || b == prescribed.end()) continue;
      const Prescribed &p = *a->second, &q = *b->second;
      out.prescribed.push_back({middle, axis, (p.displacement + q.displacement) / 2, std::max(p.set, q.set)});
    }
  }
  return out;
}

Mesh box_mesh(Element element, const std::array<int, 3>& cells, const Vec3d& size, const Vec3d& origin) {
  for (int c = 0; c < 3; ++c) {
    if (cells[c] < 1 || !(size[c] > 0))
      throw Error(
          ErrorCode::bad_input,
          fmt::format("box_mesh: {} cells over {} m, expected at least one cell and a positive size", cells[c], size[c]));
  }
  Mesh mesh;
  mesh.element = element == Element::hex8full ? element : Element::tet4;
  for (int k = 0; k <= cells[2]; ++k) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int i = 0; i <= cells[0]; ++i) {
        mesh.nodes.push_back(
            {origin[0] + size[0] * i / cells[0], origin[1] + size[1] * j / cells[1], origin[2] + size[2] * k / cells[2]});
      }
    }
  }
  static constexpr int paths[6][2]{{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        std::array<std::int32_t, 8> c{};
        for (int a = 0; a < 8; ++a)
          c[a] = (i + (a & 1)) + (cells[0] + 1) * ((j + (a >> 1 & 1)) + (cells[1] + 1) * (k + (a >> 2 & 1)));
        if (mesh.element == Element::hex8full) {
          mesh.corners.insert(mesh.corners.end(), c.begin(), c.end());
          continue;
        }
        for (const auto& p : paths) mesh.corners.insert(mesh.corners.end(), {c[0], c[p[0]], c[p[1]], c[7]});
      }
    }
  }
  return element == Element::tet10 ? to_quadratic(mesh) : mesh;
}

std::vector<std::int32_t> nodes_where(const Mesh& mesh, const std::function<bool(const Vec3d&)>& chosen) {
  std::vector<std::int32_t> out;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (chosen(mesh.nodes[n])) out.push_back(static_cast<std::int32_t>(n));
  }
  return out;
}

void prescribe(Problem& problem, const std::function<bool(const Vec3d&)>& chosen, int axes, const Vec3d& displacement) {
  for (const std::int32_t n : nodes_where(problem.mesh, chosen)) {
    for (int c = 0; c < 3; ++c) {
      if ((axes >> c & 1) != 0) problem.prescribed.push_back({n, c, displacement[c]});
    }
  }
}

double add_traction(Problem& problem, const std::function<bool(const Vec3d&)>& chosen, const Vec3d& traction) {
  const Mesh& mesh = problem.mesh;
  double area = 0;
  for (const auto& [element, number] : boundary_faces(mesh)) {
    const std::vector<int>& face = faces_of(mesh.element)[number];
    Eigen::Matrix3Xd x(3, face.size());
    for (std::size_t a = 0; a < face.size(); ++a) x.col(a) = eigen(mesh.nodes[mesh.nodes_of(element)[face[a]]]);
    const std::size_t corners = face.size() == 4 ? 4 : 3;
    if (!chosen(plain(x.leftCols(corners).rowwise().mean()))) continue;
    for (const TractionPoint& p : face_rule(face.size())) {
      const Vector3d a = x * p.gradient.row(0).transpose(), b = x * p.gradient.row(1).transpose();
      const double weight = p.weight * a.cross(b).norm();
      area += weight;
      for (std::size_t i = 0; i < face.size(); ++i)
        problem.forces.push_back({mesh.nodes_of(element)[face[i]], plain(weight * p.n[i] * eigen(traction))});
    }
  }
  return area;
}

void add_pressure(Problem& problem, const std::function<bool(const Vec3d&)>& chosen, double pressure) {
  const Mesh& mesh = problem.mesh;
  for (const auto& [element, number] : boundary_faces(mesh)) {
    const std::vector<int>& face = faces_of(mesh.element)[number];
    const int corners = mesh.element == Element::hex8full ? 4 : 3;
    Vector3d centre = Vector3d::Zero();
    for (int a = 0; a < corners; ++a) centre += eigen(mesh.nodes[mesh.nodes_of(element)[face[a]]]) / corners;
    if (!chosen(plain(centre))) continue;
    for (int a = 2; a < corners; ++a) problem.face_pressures.push_back({element, {face[0], face[a - 1], face[a]}, pressure});
  }
}

}  // namespace pliant::statics
