// Twin of kernels/matching/flsm_region.cl.
#include <algorithm>
#include <array>

#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/matching/flsm_rotation.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/texels.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {
namespace {

/// Symmetric: xx yy zz xy xz yz.
template <class Scalar>
using Symmetric = std::array<Scalar, 6>;

/// a m for a symmetric m.
template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> times_symmetric(const Mat3<Scalar>& a, const Symmetric<Scalar>& m) {
  const auto [xx, yy, zz, xy, xz, yz] = m;
  const auto sum = [](Scalar a0, Scalar b0, Scalar a1, Scalar b1, Scalar a2, Scalar b2) {
    return std::fma(a2, b2, std::fma(a1, b1, a0 * b0));
  };
  return {sum(a.m00, xx, a.m01, xy, a.m02, xz), sum(a.m00, xy, a.m01, yy, a.m02, yz), sum(a.m00, xz, a.m01, yz, a.m02, zz),
          sum(a.m10, xx, a.m11, xy, a.m12, xz), sum(a.m10, xy, a.m11, yy, a.m12, yz), sum(a.m10, xz, a.m11, yz, a.m12, zz),
          sum(a.m20, xx, a.m21, xy, a.m22, xz), sum(a.m20, xy, a.m21, yy, a.m22, yz), sum(a.m20, xz, a.m21, yz, a.m22, zz)};
}

/// First Piola-Kirchhoff stress P of the deformation H with the rotation I + D.
template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> corotated_stress(const Mat3<Scalar>& h, const Mat3<Scalar>& d, Scalar shear,
                                                            Scalar bulk) {
  const Mat3<Scalar> r{h.m00 - d.m00, h.m01 - d.m01, h.m02 - d.m02, h.m10 - d.m10, h.m11 - d.m11,
                       h.m12 - d.m12, h.m20 - d.m20, h.m21 - d.m21, h.m22 - d.m22};
  const auto turned_back = [](Scalar d0, Scalar r0, Scalar d1, Scalar r1, Scalar d2, Scalar r2, Scalar own) {
    return std::fma(d2, r2, std::fma(d1, r1, std::fma(d0, r0, own)));
  };
  const Symmetric<Scalar> s{turned_back(d.m00, r.m00, d.m10, r.m10, d.m20, r.m20, r.m00),
                            turned_back(d.m01, r.m01, d.m11, r.m11, d.m21, r.m21, r.m11),
                            turned_back(d.m02, r.m02, d.m12, r.m12, d.m22, r.m22, r.m22),
                            turned_back(d.m00, r.m01, d.m10, r.m11, d.m20, r.m21, r.m01),
                            turned_back(d.m00, r.m02, d.m10, r.m12, d.m20, r.m22, r.m02),
                            turned_back(d.m01, r.m02, d.m11, r.m12, d.m21, r.m22, r.m12)};
  const auto [xx, yy, zz, xy, xz, yz] = s;
  const Scalar half = Scalar(0.5), eighth = Scalar(0.125), one = Scalar(1);
  const Mat3<Scalar> q = times_symmetric(Mat3<Scalar>{xx, xy, xz, xy, yy, yz, xz, yz, zz}, s);
  // At large strain the cubic and quartic terms of the energy shrink by k and k^2.
  const auto sum = [](const Mat3<Scalar>& a, Scalar b00, Scalar b11, Scalar b22, Scalar b01, Scalar b02, Scalar b12) {
    const Scalar outside = std::fma(a.m12, b12, std::fma(a.m02, b02, a.m01 * b01));
    return std::fma(Scalar(2), outside, std::fma(a.m22, b22, std::fma(a.m11, b11, a.m00 * b00)));
  };
  const Scalar most = Scalar(PLIANT_FLSM_STRAIN), tr2 = (q.m00 + q.m11) + q.m22, tr3 = sum(q, xx, yy, zz, xy, xz, yz);
  const Scalar tr4 = sum(q, q.m00, q.m11, q.m22, q.m01, q.m02, q.m12);
  const Scalar y = tr2 > most ? most / tr2 : one, k = y * (Scalar(2) - y);
  const Scalar own = std::fma(((Scalar(4) * (y - one)) * (y * y)) / most,
                              std::fma(k * Scalar(0.0625), tr4, -(Scalar(1) / Scalar(6)) * tr3), one);
  const Scalar linear = -half * k, quadratic = eighth * (k * k);
  const auto diagonal = [&](Scalar square, Scalar strain) {
    return std::fma(quadratic, square, std::fma(linear, strain, own));
  };
  const auto beside = [&](Scalar square, Scalar strain) { return std::fma(quadratic, square, linear * strain); };
  const Mat3<Scalar> factor{diagonal(q.m00, xx), beside(q.m01, xy), beside(q.m02, xz), beside(q.m10, xy),  diagonal(q.m11, yy),
                            beside(q.m12, yz),   beside(q.m20, xz), beside(q.m21, yz), diagonal(q.m22, zz)};
  const Mat3<Scalar> f = times_symmetric(factor, s);
  const Scalar p = bulk * ((xx + yy) + zz);
  const Symmetric<Scalar> stress{std::fma(shear, f.m00, p),
                                 std::fma(shear, f.m11, p),
                                 std::fma(shear, f.m22, p),
                                 shear * f.m01,
                                 shear * f.m02,
                                 shear * f.m12};
  const Mat3<Scalar> t = times_symmetric(d, stress);
  return {stress[0] + t.m00, stress[3] + t.m01, stress[4] + t.m02, stress[3] + t.m10, stress[1] + t.m11,
          stress[5] + t.m12, stress[4] + t.m20, stress[5] + t.m21, stress[2] + t.m22};
}

/// The inverse of a region's moments, from its first plane.
template <class Scalar>
[[gnu::always_inline]] inline Symmetric<Scalar> inverse_of(const Scalar* plane) {
  return {plane[0],
          plane[PLIANT_TILE],
          plane[2 * PLIANT_TILE],
          plane[3 * PLIANT_TILE],
          plane[4 * PLIANT_TILE],
          plane[5 * PLIANT_TILE]};
}

/// Matrices of a tile's regions, entry by entry.
template <class Scalar>
struct Mat3Tile {
  Scalar m[3][3][PLIANT_TILE];

  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> at(int l) const {
    return {m[0][0][l], m[0][1][l], m[0][2][l], m[1][0][l], m[1][1][l], m[1][2][l], m[2][0][l], m[2][1][l], m[2][2][l]};
  }
  [[gnu::always_inline]] inline void set(int l, const Mat3<Scalar>& a) {
    m[0][0][l] = a.m00, m[0][1][l] = a.m01, m[0][2][l] = a.m02;
    m[1][0][l] = a.m10, m[1][1][l] = a.m11, m[1][2][l] = a.m12;
    m[2][0][l] = a.m20, m[2][1][l] = a.m21, m[2][2][l] = a.m22;
  }
};

/// Records of a tile's regions: [block][component].
template <class Scalar>
using Records = SortedTexels<Scalar>[4];
static_assert(PLIANT_FLSM_RECORD == 16);

/// Writes records of hd [component][axis]; t follows the centroid with it.
template <class Scalar>
void store_records(const Scalar* rest, const Records<Scalar>& field, const Mat3Tile<Scalar>& hd, Scalar* records) {
  Records<Scalar> sorted{};
  Scalar rows[4][PLIANT_TILE][4];
  for (int c = 0; c < 3; ++c) {
#pragma GCC unroll 1
    for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
      const Scalar t = rest[l] * field[0][c][l], x = std::fma(-hd.m[c][0][l], rest[PLIANT_TILE + l], t);
      const Scalar y = std::fma(-hd.m[c][1][l], rest[2 * PLIANT_TILE + l], x);
      sorted[0][c][l] = std::fma(-hd.m[c][2][l], rest[3 * PLIANT_TILE + l], y);
    }
    for (int axis = 0; axis < 3; ++axis) std::copy_n(hd.m[c][axis], PLIANT_TILE, sorted[axis + 1][c]);
  }
  for (int block = 0; block < 4; ++block) store_texels(sorted[block], rows[block][0]);
  for (int l = 0; l < PLIANT_TILE; ++l) {
    for (int block = 0; block < 4; ++block) std::copy_n(rows[block][l], 4, records + PLIANT_FLSM_RECORD * l + 4 * block);
  }
}

/// The matrices A + E whose rotations are sought, as Horn's; `elastic`: the regions' inverse moments, or null.
template <class Scalar>
[[gnu::always_inline]] inline void horn_matrices(const Scalar* rest, const Scalar* elastic, const Records<Scalar>& field,
                                                 Mat3Tile<Scalar>& deformation, HornTile<Scalar>& horn) {
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
    const Scalar dx = rest[PLIANT_TILE + l], dy = rest[2 * PLIANT_TILE + l], dz = rest[3 * PLIANT_TILE + l];
    const auto added = [&](int c, int axis, Scalar d) { return std::fma(-field[0][c][l], d, field[axis + 1][c][l]); };
    deformation.set(l, {added(0, 0, dx), added(0, 1, dy), added(0, 2, dz), added(1, 0, dx), added(1, 1, dy), added(1, 2, dz),
                        added(2, 0, dx), added(2, 1, dy), added(2, 2, dz)});
  }
  if (elastic != nullptr) {
    for (int l = 0; l < PLIANT_TILE; ++l) deformation.set(l, times_symmetric(deformation.at(l), inverse_of(elastic + l)));
  }
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
    const auto at = [&](int plane) { return rest[plane * PLIANT_TILE + l]; };
    const Scalar a[6] = {at(4), at(5), at(6), at(7), at(8), at(9)};
    bool ok = false;
    horn.set(l, horn_matrix(a, deformation.at(l), (a[0] + a[1]) + a[2], ok));
    horn.settled[l] = ok ? 0 : 1;
  }
}

/// hd of the pulls in place of that of the goals, where regions are elastic.
template <class Scalar>
[[gnu::always_inline]] inline void set_pulls(const Scalar* elastic, const Mat3Tile<Scalar>& deformation,
                                             const Mat3Tile<Scalar>& rotation, const std::int32_t* valid, Scalar spacing,
                                             Scalar shear, Scalar bulk, Mat3Tile<Scalar>& hd) {
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
    const Scalar q = elastic[6 * PLIANT_TILE + l], pull = q * spacing;
    const bool pulls = (valid[l] != 0) & (q > Scalar(0));
    const Mat3<Scalar> e = deformation.at(l), old = hd.at(l);
    const Mat3<Scalar> p = times_symmetric(corotated_stress(e, rotation.at(l), shear, bulk), inverse_of(elastic + l));
    const auto put = [&](Scalar before, Scalar from, Scalar by) {
      const Scalar pulled = std::fma(-pull, by, spacing * from);
      return pulls ? pulled : before;
    };
    hd.set(l, {put(old.m00, e.m00, p.m00), put(old.m01, e.m01, p.m01), put(old.m02, e.m02, p.m02), put(old.m10, e.m10, p.m10),
               put(old.m11, e.m11, p.m11), put(old.m12, e.m12, p.m12), put(old.m20, e.m20, p.m20), put(old.m21, e.m21, p.m21),
               put(old.m22, e.m22, p.m22)});
  }
}

}  // namespace

template <class Scalar, int Width, int Elastic>
void flsm_region(Range range, const Scalar* node_u, const Scalar* flsm_plates, const std::int32_t* flsm_link,
                 const std::int32_t* missing_offset, const std::int32_t* missing, const Scalar* missing_factor,
                 const Scalar* flsm_reference, const Scalar* flsm_rest, Scalar* flsm_regions, const Scalar* flsm_elastic,
                 Scalar* flsm_pulls, Scalar spacing, Scalar shear, Scalar bulk) {
  const Scalar origin[4] = {flsm_reference[0], flsm_reference[1], flsm_reference[2], flsm_reference[3]};
  Scalar rows[4][PLIANT_TILE][4];
  Records<Scalar> field;
  Mat3Tile<Scalar> deformation, rotation, hd;
  HornTile<Scalar> horn;
  std::int32_t valid[PLIANT_TILE];
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    for (int l = 0; l < PLIANT_TILE; ++l) {
      Scalar s[PLIANT_FLSM_RECORD];
      moments_of<Width>(node_u, flsm_plates, flsm_link, missing_offset, missing, missing_factor, origin, tile + l, s);
      for (int block = 0; block < 4; ++block) std::copy_n(s + 4 * block, 4, rows[block][l]);
    }
    for (int block = 0; block < 4; ++block) load_texels(rows[block][0], field[block]);
    const Scalar* rest = flsm_rest + PLIANT_FLSM_REST_PLANES * tile;
    const Scalar* soft = Elastic == 1 ? flsm_elastic + PLIANT_FLSM_ELASTIC_PLANES * tile : nullptr;
    horn_matrices(rest, soft, field, deformation, horn);
    for (int l = 0; l < PLIANT_TILE; ++l) valid[l] = 1 - horn.settled[l];
    square_until_settled(horn);
    for (int l = 0; l < PLIANT_TILE; ++l) rotation.set(l, rotation_from(horn.at(l)));
    for (int c = 0; c < 3; ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        for (int l = 0; l < PLIANT_TILE; ++l) hd.m[c][axis][l] = spacing * rotation.m[c][axis][l];
      }
    }
    Scalar* records = flsm_regions + PLIANT_FLSM_RECORD * tile;
    for (int l = 0; l < PLIANT_TILE; ++l) {
      if (valid[l] != 0) continue;
      for (int k = 0; k < 9; ++k) hd.m[k / 3][k % 3][l] = records[PLIANT_FLSM_RECORD * l + 4 * (k % 3) + 4 + k / 3];
    }
    store_records(rest, field, hd, records);
    if constexpr (Elastic == 1) {
      set_pulls(soft, deformation, rotation, valid, spacing, shear, bulk, hd);
      store_records(rest, field, hd, flsm_pulls + PLIANT_FLSM_RECORD * tile);
    }
  }
}

void register_flsm_region(Registry& registry) {
  registry.add_specialised<flsm_widths, 2>("flsm_region", {"WIDTH", "ELASTIC"}, [](auto scalar, auto width, auto elastic) {
    return flsm_region<decltype(scalar), width(), elastic()>;
  });
}

}  // namespace pliant::ref
