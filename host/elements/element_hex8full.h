// The hexahedron with 2 x 2 x 2 Gauss points.
#pragma once
#include "elements/element.h"
#include "elements/hexahedron.h"
#include "layout.h"

namespace pliant {

struct Hex8Full {
  static constexpr ElementInfo info{.word = "hex8full",
                                    .what = "hexahedron with 2x2x2 points",
                                    .kernel = "tled_hex8full_force",
                                    .buffers = "hex",
                                    .cell = "hexahedron",
                                    .cells = "hexahedra",
                                    .corners = 8,
                                    .record = PLIANT_HEXFULL_DATA_PLANES,
                                    .weighted = -1,
                                    .force = PLIANT_HEX_FORCE_PLANES,
                                    .averaged = false,
                                    .hourglass = false,
                                    .brick = nullptr,
                                    .statics = true,
                                    .splits = false,
                                    .reference = true,
                                    .trial = 3};

  static std::vector<double> record(std::span<const Vec3d> x, const Material&, const std::string& what);
  static std::vector<double> cube_record(double edge, const Material&, const std::string& what);
  static double volume(std::span<const double> record) {
    double volume = 0;
    for (int p = 0; p < 8; ++p) volume += record[25 * p + 24];
    return volume;
  }
  static double frequency(std::span<const double> record, const Material& m);

  template <class F>
  static void for_each_point(std::span<const double> record, const F& f) {
    for (int p = 0; p < 8; ++p) {
      const Corners8 b = Eigen::Map<const Eigen::Matrix<double, 8, 3, Eigen::RowMajor>>(record.data() + 25 * p);
      f(b, record[25 * p + 24]);
    }
  }

  static ElementCost cost(double law, bool uniform) { return {132.0 + (uniform ? 0 : 800) + 16, 0, 8 * (144 + law + 144)}; }

  static double hourglass_energy(std::span<const double>, const Displacements8&) { return 0; }
  static double hourglass_bound(std::span<const double>, const Displacements8&) { return 0; }
};

}  // namespace pliant
