#include "statics/pressure.h"

#include <algorithm>

namespace pliant::statics {
namespace {

/// A shape function that is smaller than this all over a face is one of a node that does not lie on it.
constexpr double kNothing = 1e-12;

/// [a] x b = a x b
Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

Vector3d corner_place(Element element, int corner) {
  if (element == Element::hex8full) return {corner & 1 ? 1.0 : 0.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 1.0 : 0.0};
  return corner == 0 ? Vector3d::Zero().eval() : Vector3d::Unit(corner - 1).eval();
}

/// A flat triangle between embedded points, or of a linear tetrahedron: the loads are exact with one point.
PressurePatch flat_patch(const Problem& problem, const Pressure& pressure) {
  PressurePatch patch;
  patch.pressure = pressure.pressure;
  for (const std::int32_t v : pressure.points) {
    const SurfacePoint& point = problem.surface[v];
    for (std::size_t a = 0; a < point.nodes.size(); ++a) {
      if (point.weights[a] != 0) patch.nodes.push_back(point.nodes[a]);
    }
  }
  std::sort(patch.nodes.begin(), patch.nodes.end());
  patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
  const auto count = static_cast<Eigen::Index>(patch.nodes.size());
  Eigen::Matrix3Xd weights = Eigen::Matrix3Xd::Zero(3, count);  // row v: point v by the nodes
  Matrix3d x;
  for (int v = 0; v < 3; ++v) {
    const SurfacePoint& point = problem.surface[pressure.points[v]];
    x.col(v) = eigen(point.rest);
    for (std::size_t a = 0; a < point.nodes.size(); ++a) {
      const auto at = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), point.nodes[a]) - patch.nodes.begin();
      if (point.weights[a] != 0) weights(v, at) += point.weights[a];
    }
  }
  PressurePoint p{weights.colwise().mean().transpose(), Eigen::Matrix2Xd(2, count), x.col(1) - x.col(0), x.col(2) - x.col(0),
                  0.5};
  p.gradient << weights.row(1) - weights.row(0), weights.row(2) - weights.row(0);
  patch.points.push_back(p);
  return patch;
}

/// A face of an element, or half of one: its shape functions, with a rule under which the loads are exact.
PressurePatch face_patch(const Mesh& mesh, const FacePressure& face) {
  const Vector3d origin = corner_place(mesh.element, face.corners[0]);
  const Vector3d r = corner_place(mesh.element, face.corners[1]) - origin;
  const Vector3d s = corner_place(mesh.element, face.corners[2]) - origin;
  const Gradients x = corners_at(mesh, face.element);
  PressurePatch patch;
  patch.pressure = face.pressure;
  Eigen::VectorXd most = Eigen::VectorXd::Zero(x.cols());
  for (const FacePoint& at : triangle_rule(mesh.element)) {
    const Vector3d local = origin + at.r * r + at.s * s;
    const Gradients gradients = shape_gradients(mesh.element, local);
    PressurePoint p{shape_values(mesh.element, local), Eigen::Matrix2Xd(2, x.cols()), {}, {}, at.weight};
    p.gradient << r.transpose() * gradients, s.transpose() * gradients;
    p.along_r = x * p.gradient.row(0).transpose();
    p.along_s = x * p.gradient.row(1).transpose();
    most = most.cwiseMax(p.n.cwiseAbs()).cwiseMax(p.gradient.cwiseAbs().colwise().maxCoeff().transpose());
    patch.points.push_back(p);
  }
  std::vector<int> on_face;
  for (int a = 0; a < x.cols(); ++a) {
    if (most[a] > kNothing) on_face.push_back(a);
  }
  for (const int a : on_face) patch.nodes.push_back(mesh.nodes_of(face.element)[a]);
  for (PressurePoint& p : patch.points) {
    p.n = p.n(on_face).eval();
    p.gradient = p.gradient(Eigen::all, on_face).eval();
  }
  return patch;
}

}  // namespace

std::vector<PressurePatch> pressure_patches(const Problem& problem) {
  std::vector<PressurePatch> patches;
  for (const Pressure& pressure : problem.pressures) patches.push_back(flat_patch(problem, pressure));
  for (const FacePressure& face : problem.face_pressures) patches.push_back(face_patch(problem.mesh, face));
  return patches;
}

Eigen::Matrix3Xd PressurePatch::of(const Eigen::VectorXd& all) const {
  Eigen::Matrix3Xd out(3, nodes.size());
  for (std::size_t a = 0; a < nodes.size(); ++a) out.col(static_cast<Eigen::Index>(a)) = all.segment<3>(3 * nodes[a]);
  return out;
}

Eigen::Matrix3Xd PressurePatch::forces(const Eigen::Matrix3Xd& u) const {
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, u.cols());
  for (const PressurePoint& p : points) out -= pressure * p.weight * p.r(u).cross(p.s(u)) * p.n.transpose();
  return out;
}

// With C_b d = x_r cross d n_b,s - x_s cross d n_b,r the change of x_r cross x_s by u_b, the stiffness is p n_a C_b; C_b is
// skew, so that its symmetric part is p/2 (n_a C_b - n_b C_a).
Eigen::MatrixXd PressurePatch::stiffness(const Eigen::Matrix3Xd& u) const {
  const auto count = u.cols();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  std::vector<Matrix3d> c(static_cast<std::size_t>(count));
  for (const PressurePoint& p : points) {
    const Matrix3d r = cross_matrix(p.r(u)), s = cross_matrix(p.s(u));
    for (Eigen::Index b = 0; b < count; ++b) c[b] = r * p.gradient(1, b) - s * p.gradient(0, b);
    const double half = 0.5 * pressure * p.weight;
    for (Eigen::Index a = 0; a < count; ++a) {
      for (Eigen::Index b = 0; b < count; ++b) out.block<3, 3>(3 * a, 3 * b) += half * (p.n[a] * c[b] - p.n[b] * c[a]);
    }
  }
  return out;
}

// p/2 (n_a C_b + n_b C_a) d_b, summed over b.
Eigen::Matrix3Xd PressurePatch::skew_product(const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& d) const {
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, u.cols());
  for (const PressurePoint& p : points) {
    const Vector3d r = p.r(u), s = p.s(u), moved = d * p.n;
    const Vector3d turned =
        r.cross(Vector3d(d * p.gradient.row(1).transpose())) - s.cross(Vector3d(d * p.gradient.row(0).transpose()));
    const double half = 0.5 * pressure * p.weight;
    out += half * (turned * p.n.transpose() + r.cross(moved) * p.gradient.row(1) - s.cross(moved) * p.gradient.row(0));
  }
  return out;
}

}  // namespace pliant::statics
