// Rest-state data of the elements: shape function derivatives, hourglass vectors, volumes and frequency bounds.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "model/hourglass.h"
#include "model/model.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Corners = Corners8;

Corners corners_of(const std::array<Vec3d, 8>& x) {
  Corners m;
  for (int a = 0; a < 8; ++a) m.row(a) << x[a][0], x[a][1], x[a][2];
  return m;
}

/// dN_a / d(xi, eta, zeta) of the trilinear element, corners in bit order.
Corners local_derivatives(double xi, double eta, double zeta) {
  Corners d;
  for (int a = 0; a < 8; ++a) {
    const double sx = (a & 1) ? 1 : -1, sy = (a & 2) ? 1 : -1, sz = (a & 4) ? 1 : -1;
    d.row(a) << sx * (1 + sy * eta) * (1 + sz * zeta) / 8, sy * (1 + sx * xi) * (1 + sz * zeta) / 8,
        sz * (1 + sx * xi) * (1 + sy * eta) / 8;
  }
  return d;
}

struct GaussPoint {
  Corners gradients;
  double weight;
};

std::array<GaussPoint, 8> gauss_points(const Corners& x, const std::string& what) {
  const double g = 1 / std::sqrt(3.0);
  std::array<GaussPoint, 8> points;
  for (int p = 0; p < 8; ++p) {
    const Corners local = local_derivatives((p & 1) ? g : -g, (p & 2) ? g : -g, (p & 4) ? g : -g);
    const Matrix3d jacobian = x.transpose() * local;  // dX_i / dxi_j
    const double det = jacobian.determinant();
    if (!(det > 0)) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("{}: the Jacobian of the hexahedron is {:.6g} m^3 at Gauss point {}, it must be positive", what, det, p));
    }
    points[p] = {local * jacobian.inverse(), det};
  }
  return points;
}

double largest_of_three(const Matrix3d& a) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(a, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

/// lambda tr A + 2 mu lambda_max(A) with A = sum_a grad N_a grad N_a^T [Pa/m^2].
double modulus_bound(const Eigen::Matrix<double, Eigen::Dynamic, 3>& gradients, const Material& m) {
  const Matrix3d a = gradients.transpose() * gradients;
  return std::max(m.moduli.lambda, 0.0) * a.trace() + 2 * m.moduli.mu * largest_of_three(a);
}

}  // namespace

TetGeometry tet_geometry(const std::array<Vec3d, 4>& x) {
  Matrix3d edges;
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < 3; ++c) edges(a, c) = x[a + 1][c] - x[0][c];
  }
  TetGeometry t;
  t.volume = edges.determinant() / 6;
  const Matrix3d inverse = edges.inverse();  // column a is grad N_(a+1)
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < 3; ++c) t.gradients[3 * a + c] = inverse(c, a);
  }
  return t;
}

double hourglass_stiffness(const Material& material, double volume) {
  return material.hourglass * material.moduli.young() * std::cbrt(volume) / 48;
}

namespace {

/// What the records of all one-point hexahedra begin with, and what follows from it.
struct OnePoint {
  OnePoint(const Corners& x, const std::string& what) {
    // Mean gradients over the element (exact with 2 x 2 x 2 points), as Flanagan and Belytschko 1981: linear fields are exact.
    for (const GaussPoint& p : gauss_points(x, what)) {
      mean += p.weight * p.gradients;
      volume += p.weight;
    }
    mean /= volume;
    for (int a = 0; a < 8; ++a) {
      for (int c = 0; c < 3; ++c) record.push_back(mean(a, c));
    }
  }
  Corners mean = Corners::Zero();
  double volume = 0;
  std::vector<double> record;
};

}  // namespace

std::vector<double> hex8_record(const std::array<Vec3d, 8>& corners, const Material& material, const std::string& what) {
  const Corners x = corners_of(corners);
  OnePoint e(x, what);
  const std::vector<double> hourglass = hourglass_numbers(x, e.mean, e.volume, material);
  e.record.insert(e.record.end(), hourglass.begin(), hourglass.end());
  e.record.push_back(e.volume);
  return e.record;
}

std::vector<double> hex8_cube_record(double edge, const Material& material, const std::string& what) {
  Corners x;
  for (int a = 0; a < 8; ++a) x.row(a) << edge * (a & 1), edge * (a >> 1 & 1), edge * (a >> 2 & 1);
  OnePoint e(x, what);
  // gamma = h - (h . X) b: the products of two or three corner signs, made orthogonal to every linear field.
  for (const int mode : {3, 5, 6, 7}) {
    Eigen::Matrix<double, 8, 1> h;
    for (int a = 0; a < 8; ++a) h[a] = __builtin_popcount(~a & mode) % 2 ? -1 : 1;
    const Eigen::Matrix<double, 8, 1> gamma = h - e.mean * (x.transpose() * h);
    e.record.insert(e.record.end(), gamma.begin(), gamma.end());
  }
  e.record.push_back(e.volume);
  e.record.push_back(hourglass_stiffness(material, e.volume));
  return e.record;
}

std::vector<double> hex8full_record(const std::array<Vec3d, 8>& corners, const std::string& what) {
  std::vector<double> record;
  for (const GaussPoint& p : gauss_points(corners_of(corners), what)) {
    for (int a = 0; a < 8; ++a) {
      for (int c = 0; c < 3; ++c) record.push_back(p.gradients(a, c));
    }
    record.push_back(p.weight);
  }
  return record;
}

double tet_frequency(const TetGeometry& tet, const Material& m) {
  Eigen::Matrix<double, 4, 3> g;
  g.row(0).setZero();
  for (int a = 0; a < 3; ++a) {
    g.row(a + 1) << tet.gradients[3 * a], tet.gradients[3 * a + 1], tet.gradients[3 * a + 2];
    g.row(0) -= g.row(a + 1);
  }
  return std::sqrt(4 / m.density * modulus_bound(g, m));
}

double hex8_frequency(const std::vector<double>& record, const Material& m) {
  const Corners b = Eigen::Map<const Eigen::Matrix<double, 8, 3, Eigen::RowMajor>>(record.data());
  const Eigen::Matrix<double, 4, 8> gamma = hourglass_vectors(record);
  const double volume = hex8_volume(record), hourglass = hourglass_bound(record, Displacements8::Zero());
  // The two parts act on orthogonal modes of a parallelepiped, where the larger counts; in general their sum is safe.
  const double cross = (gamma * b).cwiseAbs().maxCoeff() * std::cbrt(volume);
  const double strain = volume * modulus_bound(b, m);
  const double total = cross < 1e-9 ? std::max(strain, hourglass) : strain + hourglass;
  return std::sqrt(total / (m.density * volume / 8));
}

double hex8full_frequency(const std::vector<double>& record, const Material& m) {
  double stiffness = 0, volume = 0;
  for (int p = 0; p < 8; ++p) {
    const Corners g = Eigen::Map<const Eigen::Matrix<double, 8, 3, Eigen::RowMajor>>(record.data() + 25 * p);
    stiffness += record[25 * p + 24] * modulus_bound(g, m);
    volume += record[25 * p + 24];
  }
  return std::sqrt(stiffness / (m.density * volume / 8));
}

}  // namespace pliant
