// Shared by the twins of shape matching: sums of blocks of numbers along the links of one axis.
#pragma once
#include <cmath>
#include <cstdint>

#include "layout.h"

namespace pliant::ref {

/// Sums over the links of region i: all Numbers of the records (Stride apart), and o (above - below) of the block that starts
/// at number Moment, or o (below - above) with Back.
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

/// Adds one entry of a correction list: four factors times a record, or times one block (BlockStride 0).
template <int BlockStride, class Scalar>
inline void add_entry(const Scalar* factor, const Scalar* numbers, Scalar (&sum)[PLIANT_FLSM_RECORD]) {
  for (int block = 0; block < 4; ++block) {
    for (int k = 0; k < 4; ++k)
      sum[4 * block + k] = std::fma(factor[block], numbers[BlockStride * block + k], sum[4 * block + k]);
  }
}

/// The moments of one region: sum m u, then sum m u o_x, o_y, o_z.
template <int Width, class Scalar>
inline void moments_of(const Scalar* node_u, const Scalar* flsm_plates, const std::int32_t* flsm_link,
                       const std::int32_t* missing_offset, const std::int32_t* missing, const Scalar* missing_factor,
                       const Scalar (&origin)[4], std::int64_t i, Scalar (&s)[PLIANT_FLSM_RECORD]) {
  Scalar sum[12], moment[4], listed[PLIANT_FLSM_RECORD];
  sum_links<Width, 12, PLIANT_FLSM_RECORD, 0, false>(flsm_plates, flsm_link, i, sum, moment);
  for (Scalar& l : listed) l = Scalar(-0.0);
  for (std::int64_t e = missing_offset[i]; e < missing_offset[i + 1]; ++e) {
    Scalar u[4];
    for (int k = 0; k < 4; ++k) u[k] = node_u[std::int64_t{4} * missing[e] + k] - origin[k];
    add_entry<0>(missing_factor + 4 * e, u, listed);
  }
  for (int k = 0; k < 12; ++k) s[k] = sum[k] + listed[k];
  for (int k = 0; k < 4; ++k) s[12 + k] = moment[k] + listed[12 + k];
}

/// The sum of T X - X over the regions that hold node i: twin of kernels/matching/flsm_goal_sum.cl.
template <int Width, class Scalar>
inline void goal_sum(const Scalar* flsm_bars, const std::int32_t* flsm_link, const Scalar* flsm_regions,
                     const std::int32_t* missing_of_offset, const std::int32_t* missing_of, const Scalar* missing_of_factor,
                     std::int64_t i, Scalar (&goal)[4]) {
  Scalar moment[4], listed[PLIANT_FLSM_RECORD];
  sum_links<Width, 4, 8, 4, true>(flsm_bars, flsm_link, i, goal, moment);
  for (Scalar& s : listed) s = Scalar(-0.0);
  for (std::int64_t e = missing_of_offset[i]; e < missing_of_offset[i + 1]; ++e) {
    add_entry<4>(missing_of_factor + 4 * e, flsm_regions + std::int64_t{PLIANT_FLSM_RECORD} * missing_of[e], listed);
  }
  for (int k = 0; k < 4; ++k) {
    goal[k] = (goal[k] + moment[k]) + ((listed[k] + listed[4 + k]) + (listed[8 + k] + listed[12 + k]));
  }
}

/// Widths 1 to 5 as values of the define WIDTH; 0 is not used.
constexpr int flsm_widths = 6;

}  // namespace pliant::ref
