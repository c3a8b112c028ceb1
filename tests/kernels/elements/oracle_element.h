// One element of known shape in the double twin, and what mechanics says about it.
#pragma once
#include <functional>
#include <vector>

#include "kernels/elements/element_case.h"
#include "kernels/laws/law_oracle.h"
#include "material/material.h"

namespace pliant::kernel_test {

/// What the oracles are asked about: moduli at rest of 1052 Pa and 52249 Pa (bulk).
inline Material oracle_material(Law law) {
  Material m = make_material(law, Moduli::from_bulk(1052, 52249));
  m.low = low_volume;
  return m;
}

/// A point of quadrature: gradients of the shape functions [corners][3] and its weight.
struct Point {
  std::vector<Vector3d> gradient;
  double weight = 0;
};

/// Displacements of the corners.
using Shift = std::vector<Vector3d>;

inline Matrix3d deformation_gradient(const Point& point, const Shift& u) {
  Matrix3d f = Matrix3d::Identity();
  for (std::size_t a = 0; a < u.size(); ++a) f += u[a] * point.gradient[a].transpose();
  return f;
}

/// Linear tetrahedron with random corners.
inline Point random_tetrahedron(Random& random) {
  Vector3d x[4] = {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}, {0, 0, edge}};
  for (auto& corner : x) corner += 0.2 * edge * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  Matrix3d edges;
  edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
  const Matrix3d inverse = edges.inverse();
  Point point;
  point.gradient = {-(inverse.row(0) + inverse.row(1) + inverse.row(2)).transpose(), inverse.row(0).transpose(),
                    inverse.row(1).transpose(), inverse.row(2).transpose()};
  point.weight = edges.determinant() / 6;
  return point;
}

/// Distorted hexahedron, corner a at (a & 1, a >> 1 & 1, a >> 2 & 1).
inline std::vector<Vector3d> random_hexahedron(Random& random) {
  std::vector<Vector3d> x;
  for (int a = 0; a < 8; ++a) {
    x.push_back(edge * (Vector3d(a & 1, (a >> 1) & 1, (a >> 2) & 1) +
                        0.15 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))));
  }
  return x;
}

/// Trilinear shape functions at local (r, s, t) in [-1, 1]^3, with unit Gauss weight times the Jacobian.
inline Point hexahedron_point(const std::vector<Vector3d>& x, const Vector3d& at, double gauss_weight) {
  std::vector<Vector3d> local;
  Matrix3d jacobian = Matrix3d::Zero();
  for (int a = 0; a < 8; ++a) {
    const Vector3d sign((a & 1) != 0 ? 1 : -1, (a & 2) != 0 ? 1 : -1, (a & 4) != 0 ? 1 : -1);
    const Vector3d one = Vector3d::Ones() + sign.cwiseProduct(at);
    local.emplace_back(Vector3d(sign[0] * one[1] * one[2], sign[1] * one[0] * one[2], sign[2] * one[0] * one[1]) / 8);
    jacobian += x[static_cast<std::size_t>(a)] * local.back().transpose();
  }
  Point point;
  for (const Vector3d& g : local) point.gradient.emplace_back(jacobian.inverse().transpose() * g);
  point.weight = gauss_weight * jacobian.determinant();
  return point;
}

/// Random displacements, each component up to `size` of an edge.
inline Shift random_shift(Random& random, std::size_t corners, double size) {
  Shift u(corners);
  for (auto& v : u) v = size * edge * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return u;
}

/// Sixteen elements side by side in one tile, each with nodes of its own.
struct Tile {
  std::vector<Shift> u;         ///< per element
  std::vector<Reals> record;    ///< per element
  Reals fill = Reals(16, 1.0);  ///< per element
  Reals node_pressure;          ///< per node
};

inline Reals texels_of(const std::vector<Shift>& u) {
  Reals texels;
  for (const Shift& element : u) {
    for (const Vector3d& v : element) texels.insert(texels.end(), {v[0], v[1], v[2], 0});
  }
  return texels;
}

/// Element e's corner a is node e * corners + a.
inline Ints own_nodes(std::size_t corners) {
  Ints nodes(16 * corners);
  for (std::size_t e = 0; e < 16; ++e) {
    for (std::size_t a = 0; a < corners; ++a) nodes[a * 16 + e] = static_cast<std::int32_t>(e * corners + a);
  }
  return nodes;
}

inline Reals planes_of(const std::vector<Reals>& records) {
  Reals planes(16 * records[0].size());
  for (std::size_t e = 0; e < 16; ++e) {
    for (std::size_t k = 0; k < records[e].size(); ++k) planes[k * 16 + e] = records[e][k];
  }
  return planes;
}

/// A viscosity [Pa s], and what the corners did in the last step.
struct Viscous {
  double eta = 0, zeta = 0;
  std::vector<Shift> w;
  static constexpr double h = 2e-3;
};

/// The arguments of viscous.cl; null: nothing is viscous.
inline void add_viscous(KernelCase& test, const Viscous* viscous) {
  test.exact("viscosity", viscous == nullptr ? Reals(2) : Reals{2 * viscous->eta, viscous->zeta - 2 * viscous->eta / 3});
  test.exact("node_w", viscous == nullptr ? Reals(4) : texels_of(viscous->w)).exact("step_params", Reals(8, Viscous::h));
}

/// Corner forces of the double twin, [element][corner].
inline std::vector<Shift> element_forces(const std::string& stem, Law law, Defines others, const Tile& tile,
                                         const Viscous* viscous = nullptr) {
  others.emplace_back("VISCOUS", viscous == nullptr ? 0 : 1);
  const std::size_t corners = tile.u[0].size();
  const bool tet = corners == 4;
  KernelCase test(stem, with_law(law, others), Shape::lanes, 16);
  test.exact("node_u", texels_of(tile.u)).ints("nodes", own_nodes(corners)).exact("data", planes_of(tile.record));
  test.exact("pressure_or_fill", tet ? tile.node_pressure : tile.fill);
  test.exact("corner_force", Reals(16 * 3 * corners)).ints("fault", Ints(16));
  test.exact("law_parameters", law_constants(oracle_material(law)));
  add_viscous(test, viscous);
  test.integer(0).integer(0).step();
  const Reals out = run_in_double(test, "corner_force");
  std::vector<Shift> forces(16, Shift(corners));
  for (std::size_t e = 0; e < 16; ++e) {
    for (std::size_t a = 0; a < corners; ++a)
      forces[e][a] = Vector3d(out[48 * a + e], out[48 * a + 16 + e], out[48 * a + 32 + e]);
  }
  return forces;
}

inline double largest(const Shift& v) {
  double most = 0;
  for (const Vector3d& x : v) most = std::max(most, x.cwiseAbs().maxCoeff());
  return most;
}

/// Expects forces[a] = expected[a] relative to the largest component.
inline void expect_forces(const Shift& forces, const Shift& expected, double tolerance) {
  const double scale = largest(expected);
  ASSERT_GT(scale, 0);
  for (std::size_t a = 0; a < forces.size(); ++a) {
    EXPECT_LE((forces[a] - expected[a]).cwiseAbs().maxCoeff(), tolerance * scale)
        << "corner " << a << ": " << forces[a].transpose() << " instead of " << expected[a].transpose();
  }
}

/// Expects the forces to be the derivative of `energy` by central differences.
inline void expect_derivative(const Shift& forces, const Shift& u, const std::function<double(const Shift&)>& energy,
                              double tolerance) {
  const double delta = 1e-4 * edge;
  Shift derivative(u.size());
  for (std::size_t a = 0; a < u.size(); ++a) {
    for (int c = 0; c < 3; ++c) {
      const auto at = [&](double shift) {
        Shift moved = u;
        moved[a][c] += shift;
        return energy(moved);
      };
      // Five-point formula: its error is far below the tolerance.
      derivative[a][c] = (8 * (at(delta) - at(-delta)) - (at(2 * delta) - at(-2 * delta))) / (12 * delta);
    }
  }
  expect_forces(forces, derivative, tolerance);
}

}  // namespace pliant::kernel_test
