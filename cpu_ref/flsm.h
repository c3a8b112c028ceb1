// What the twins of shape matching share: sums of blocks of numbers along the links of one axis.
#pragma once
#include <cmath>
#include <cstdint>

#include "layout.h"

namespace pliant::ref {

/// Sums over the links of region i: all Numbers of the records (Stride apart), and o (above - below) of the block that begins
/// at number Moment, or o (below - above) where Back.
template <int Width, int Numbers, int Stride, int Moment, bool Back, class Scalar>
inline void sum_links(const Scalar* records, const std::int32_t* link, std::int64_t i, Scalar (&sum)[Numbers],
                      Scalar (&moment)[4]) {
  for (int k = 0; k < Numbers; ++k) sum[k] = records[Stride * i + k];
  for (Scalar& m : moment) m = Scalar(0);
  std::int64_t below = i, above = i;
  for (int o = 1; o <= Width; ++o) {
    below = link[2 * below];
    above = link[2 * above + 1];
    const Scalar *b = records + Stride * below, *a = records + Stride * above;
    for (int k = 0; k < Numbers; ++k) sum[k] = (sum[k] + b[k]) + a[k];
    for (int k = 0; k < 4; ++k) {
      const Scalar difference = Back ? b[Moment + k] - a[Moment + k] : a[Moment + k] - b[Moment + k];
      moment[k] = std::fma(Scalar(o), difference, moment[k]);
    }
  }
}

/// The grid offset of a missing node from its region's centre along an axis.
inline std::int32_t packed_offset(std::int32_t packed, int axis) { return (packed >> 8 * axis & 255) - 128; }

/// The sum of T X - X over the regions that hold node i: twin of kernels/flsm_goal_sum.cl.
template <int Width, class Scalar>
inline void goal_sum(const Scalar* flsm_bars, const std::int32_t* flsm_link, const Scalar* flsm_regions,
                     const std::int32_t* missing_of_offset, const std::int32_t* missing_of, std::int64_t i, Scalar (&goal)[4]) {
  Scalar moment[4];
  sum_links<Width, 4, 8, 4, true>(flsm_bars, flsm_link, i, goal, moment);
  for (int k = 0; k < 4; ++k) goal[k] = goal[k] + moment[k];
  for (std::int32_t e = missing_of_offset[i]; e < missing_of_offset[i + 1]; ++e) {
    const Scalar* region = flsm_regions + std::int64_t{PLIANT_FLSM_RECORD} * missing_of[2 * e];
    for (int k = 0; k < 4; ++k) {
      goal[k] = goal[k] + region[k];
      for (int axis = 0; axis < 3; ++axis) {
        goal[k] = std::fma(Scalar(packed_offset(missing_of[2 * e + 1], axis)), region[4 * axis + 4 + k], goal[k]);
      }
    }
  }
}

/// Widths 1 to 5 as values of the define WIDTH; 0 is not used.
constexpr int flsm_widths = 6;

}  // namespace pliant::ref
