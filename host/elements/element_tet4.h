// The linear tetrahedron: one point, constant strain.
#pragma once
#include <Eigen/Dense>

#include "elements/element.h"
#include "elements/hexahedron.h"
#include "layout.h"

namespace pliant {

struct Tet4 {
  static constexpr ElementInfo info{.word = "tet4",
                                    .what = "linear tetrahedron",
                                    .kernel = "tled_tet4_force",
                                    .buffers = "tet",
                                    .cell = "tetrahedron",
                                    .cells = "tetrahedra",
                                    .corners = 4,
                                    .record = PLIANT_TET_DATA_PLANES,
                                    .weighted = 9,
                                    .force = PLIANT_TET_FORCE_PLANES,
                                    .averaged = false,
                                    .hourglass = false,
                                    .brick = nullptr,
                                    .statics = true,
                                    .splits = true,
                                    .reference = false,
                                    .trial = 4};

  /// Gradients of the shape functions 1 to 3, and the volume, which is negative for an inverted element.
  static std::vector<double> record(std::span<const Vec3d> x, const Material&, const std::string&) {
    Eigen::Matrix3d edges;
    for (int a = 0; a < 3; ++a) {
      for (int c = 0; c < 3; ++c) edges(a, c) = x[a + 1][c] - x[0][c];
    }
    const Eigen::Matrix3d inverse = edges.inverse();  // column a is grad N_(a+1)
    std::vector<double> out(inverse.data(), inverse.data() + 9);
    out.push_back(edges.determinant() / 6);
    return out;
  }
  static std::vector<double> cube_record(double, const Material&, const std::string&) {
    return {};
  }  ///< a cube is divided into six

  static double volume(std::span<const double> record) { return record[9]; }

  static double frequency(std::span<const double> record, const Material& m) {
    double frequency = 0;
    for_each_point(record, [&](const auto& b, double) { frequency = std::sqrt(4 / m.density * modulus_bound(b, m)); });
    return frequency;
  }

  template <class F>
  static void for_each_point(std::span<const double> record, const F& f) {
    Eigen::Matrix<double, 4, 3> b;
    b.row(0).setZero();
    for (int a = 1; a < 4; ++a) {
      b.row(a) = Eigen::Map<const Eigen::RowVector3d>(record.data() + 3 * (a - 1));
      b.row(0) -= b.row(a);
    }
    f(b, record[9]);
  }

  /// Indices 16, data 40, corner forces 48.
  static ElementCost cost(double law, bool) { return {104, 1, 9 + 45 + law + 45 + 9}; }

  template <class U>
  static double hourglass_energy(std::span<const double>, const U&) {
    return 0;
  }
  template <class U>
  static double hourglass_bound(std::span<const double>, const U&) {
    return 0;
  }
};

}  // namespace pliant
