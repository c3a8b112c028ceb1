// The hexahedron with one point and hourglass control (hourglass.h).
#pragma once
#include "elements/element.h"
#include "elements/hourglass.h"
#include "layout.h"

namespace pliant {

struct Hex8 {
  static constexpr ElementInfo info{.word = "hex8",
                                    .what = "hexahedron with one Gauss point and hourglass control",
                                    .kernel = "tled_hex8_force",
                                    .buffers = "hex",
                                    .cell = "hexahedron",
                                    .cells = "hexahedra",
                                    .corners = 8,
                                    .record = PLIANT_HEX_DATA_PLANES,
                                    .weighted = -1,
                                    .force = PLIANT_HEX_FORCE_PLANES,
                                    .averaged = false,
                                    .hourglass = true,
                                    .brick = "tled_hex8_brick_force",
                                    .statics = true,
                                    .splits = false,
                                    .reference = false,
                                    .trial = 1};

  static std::vector<double> record(std::span<const Vec3d> x, const Material& material, const std::string& what);
  static std::vector<double> cube_record(double edge, const Material& material, const std::string& what);
  static double volume(std::span<const double> record) { return hex8_volume(record); }
  static double frequency(std::span<const double> record, const Material& m);

  template <class F>
  static void for_each_point(std::span<const double> record, const F& f) {
    const Corners8 b = Eigen::Map<const Eigen::Matrix<double, 8, 3, Eigen::RowMajor>>(record.data());
    f(b, hex8_volume(record));
  }

  /// Indices 32, fill 4, corner forces 96, and the record if each element has its own.
  static ElementCost cost(double law, bool uniform) {
    if (uniform) return {132 + 16, 0, 144 + law + 192 + 12 + 120 + 192};
    // Modes and inverse 57 + 42 + 72, axes 3 * 28, p 60, dW/dp 61, slope by the axes 3 * 55, by the modes 4 * 39.
    return {132 + 224 + 16, 0, 144 + law + 57 + 42 + 72 + 84 + 60 + 61 + 165 + 156 + 144};
  }

  static double hourglass_energy(std::span<const double> record, const Displacements8& u) {
    return pliant::hourglass_energy(record, u);
  }
  static double hourglass_bound(std::span<const double> record, const Displacements8& u) {
    return pliant::hourglass_bound(record, u);
  }
};

}  // namespace pliant
