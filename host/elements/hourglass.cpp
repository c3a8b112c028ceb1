#include "elements/hourglass.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "elements/eigenvalues.h"
#include "layout.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Modes = Eigen::Matrix<double, 4, 8>;
using Strains = Eigen::Matrix<double, 12, 1>;  ///< p_ia at 4 i + a
using Moduli12 = Eigen::Matrix<double, 12, 12>;

enum Mode { xy, xz, yz, xyz };
constexpr int at(int axis, int mode) { return 4 * axis + mode; }

/// What the record of a hexahedron that is no cube says, and W(p) = p . moduli p / 2.
struct Shape {
  explicit Shape(std::span<const double> record)
      : axes(Eigen::Map<const Matrix3d>(record.data() + 36)), normal(record.data() + 45), twist(record.data() + 51) {
    const auto couple = [&](int i, int a, int j, int b, double n) {
      moduli(at(i, a), at(j, b)) = moduli(at(j, b), at(i, a)) = n;
    };
    const auto shear = [&](int i, int a, double of_i, int j, int b, double of_j) {
      Strains s = Strains::Zero();
      s[at(i, a)] = of_i;
      s[at(j, b)] = of_j;
      moduli += s * s.transpose();
    };
    moduli.setZero();
    for (int i = 0; i < 3; ++i) {
      for (int a = 0; a < 4; ++a) moduli(at(i, a), at(i, a)) = a == xyz ? normal[i] / 3 : normal[i];
    }
    for (const auto& [i, a] : {std::pair{2, xy}, {0, yz}, {1, xz}}) moduli(at(i, a), at(i, a)) = -record[54];
    couple(0, xz, 1, yz, record[48]);
    couple(0, xy, 2, yz, record[49]);
    couple(1, xy, 2, xz, record[50]);
    shear(2, xy, twist[0], 0, yz, twist[2]);
    shear(2, xy, twist[1], 1, xz, twist[2]);
    shear(1, xz, twist[0], 0, yz, twist[1]);
    all = record[54];
  }

  Matrix3d axes;  ///< columns
  Eigen::Map<const Vector3d> normal, twist;
  double all;
  Moduli12 moduli;
};

bool is_cube(std::span<const double> record) { return record.size() == PLIANT_HEX_CUBE_RECORD; }

Corners8 gradients(std::span<const double> record) {
  return Eigen::Map<const Eigen::Matrix<double, 8, 3, Eigen::RowMajor>>(record.data());
}

/// The columns g_i of the axes moved by F = I + H.
Matrix3d turned(const Matrix3d& axes, const Matrix3d& h) {
  Matrix3d g = axes + h * axes;
  for (int i = 0; i < 3; ++i) g.col(i) *= 2 / (1 + g.col(i).squaredNorm());
  return g;
}

/// The smallest eigenvalue of bending and twisting: of what couples D_i with D_j, and of the three shears.
double least_stiffness(const Vector3d& d, double poisson, const Vector3d& a) {
  double least = d.minCoeff();
  for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    const double mean = (d[i] + d[j]) / 2;
    least = std::min(least, mean - std::hypot((d[i] - d[j]) / 2, poisson * std::sqrt(d[i] * d[j])));
  }
  Matrix3d shears;
  shears << a[0], a[1], 0, a[2], 0, a[1], 0, a[2], a[0];  // rows: shares of p_z,xy, p_x,yz and p_y,xz in xz, yz, xy
  return std::min(least, Eigen::SelfAdjointEigenSolver<Matrix3d>(shears * shears.transpose()).eigenvalues()[0]);
}

}  // namespace

double hourglass_stiffness(const Material& material, double volume) {
  return material.hourglass * material.moduli.young() * std::cbrt(volume) / 48;
}

Modes hourglass_signs() {
  Modes h;
  constexpr int modes[4] = {3, 5, 6, 7};
  for (int a = 0; a < 4; ++a) {
    for (int c = 0; c < 8; ++c) h(a, c) = __builtin_popcount(static_cast<unsigned>(~c & modes[a])) % 2 != 0 ? -1 : 1;
  }
  return h;
}

std::vector<double> hourglass_numbers(const Corners8& x, const Corners8& mean, double volume, const Material& material) {
  Eigen::Matrix<double, 8, 3> signs;
  for (int c = 0; c < 8; ++c) signs.row(c) << ((c & 1) != 0 ? 1 : -1), ((c & 2) != 0 ? 1 : -1), ((c & 4) != 0 ? 1 : -1);
  // The mean of dxi/dX over the element, and half its edges, the columns of the inverse.
  const Matrix3d edges = (signs.transpose() * mean).inverse();
  const Matrix3d axes = edges.colwise().normalized();
  const Vector3d half = edges.colwise().norm();
  const double young = material.moduli.young(), poisson = material.moduli.poisson();
  const double bending = material.hourglass * young / (1 - poisson * poisson) * volume / 192;
  const Vector3d d = bending * half.cwiseAbs2().cwiseInverse();
  const Vector3d a = std::sqrt(material.hourglass * material.moduli.mu * volume / 192) * half.cwiseInverse();
  const double k = least_stiffness(d, poisson, a) / 2;

  const Eigen::Matrix<double, 3, 4> moments = x.transpose() * hourglass_signs().transpose();
  std::vector<double> out(moments.data(), moments.data() + 12);
  out.insert(out.end(), axes.data(), axes.data() + 9);
  for (int i = 0; i < 3; ++i) out.push_back(d[i] - k);
  for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) out.push_back(poisson * std::sqrt(d[i] * d[j]));
  out.insert(out.end(), a.data(), a.data() + 3);
  out.push_back(k);
  return out;
}

double hex8_volume(std::span<const double> record) { return record[is_cube(record) ? 56 : 55]; }

Modes hourglass_vectors(std::span<const double> record) {
  if (is_cube(record)) return Eigen::Map<const Eigen::Matrix<double, 4, 8, Eigen::RowMajor>>(record.data() + 24);
  const Eigen::Map<const Eigen::Matrix<double, 3, 4>> moments(record.data() + 24);
  return hourglass_signs() - moments.transpose() * gradients(record).transpose();
}

double hourglass_energy(std::span<const double> record, const Displacements8& u) {
  const Eigen::Matrix<double, 3, 4> q = u * hourglass_vectors(record).transpose();
  if (is_cube(record)) return record[57] / 2 * q.squaredNorm();
  const Shape shape(record);
  const Eigen::Matrix<double, 4, 3> by_mode = q.transpose() * turned(shape.axes, u * gradients(record));
  const Eigen::Map<const Strains> p(by_mode.data());
  return shape.all / 2 * q.squaredNorm() + p.dot(shape.moduli * p) / 2;
}

double hourglass_bound(std::span<const double> record, const Displacements8& u) {
  const Modes gamma = hourglass_vectors(record);
  const double gram = largest_eigenvalue(gamma.lazyProduct(gamma.transpose()).eval());
  if (is_cube(record)) return record[57] * gram;
  const Shape shape(record);
  const Corners8 b = gradients(record);
  const Matrix3d h = u * b, moved = shape.axes + h * shape.axes, g = turned(shape.axes, h);
  const Eigen::Matrix<double, 3, 4> q = u * gamma.transpose();
  Eigen::Matrix<double, 12, 24> slope;  // of p by the displacements, [corner][component]
  for (int i = 0; i < 3; ++i) {
    const double scale = 2 / (1 + moved.col(i).squaredNorm());
    const Eigen::Matrix<double, 8, 1> share = b * shape.axes.col(i);  // of G_i
    for (int a = 0; a < 4; ++a) {
      const Vector3d turn = scale * (q.col(a) - g.col(i).dot(q.col(a)) * moved.col(i));
      for (int c = 0; c < 8; ++c) slope.block<1, 3>(at(i, a), 3 * c) = (gamma(a, c) * g.col(i) + share[c] * turn).transpose();
    }
  }
  return shape.all * gram + largest_eigenvalue(shape.moduli, slope);
}

}  // namespace pliant
