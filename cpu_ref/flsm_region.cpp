// Twin of kernels/flsm_region.cl.
#include "flsm.h"
#include "flsm_rotation.h"
#include "registry.h"
#include "tile.h"

namespace pliant::ref {
template <class Scalar, int Width>
void flsm_region(Range range, const Scalar* node_u, const Scalar* flsm_plates, const std::int32_t* flsm_link,
                 const std::int32_t* missing_offset, const std::int32_t* missing, const Scalar* missing_factor,
                 const Scalar* flsm_reference, const Scalar* flsm_rest, Scalar* flsm_regions, Scalar spacing) {
  const Scalar origin[4] = {flsm_reference[0], flsm_reference[1], flsm_reference[2], flsm_reference[3]};
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    Scalar field[16][PLIANT_TILE];
    for (int l = 0; l < PLIANT_TILE; ++l) {
      Scalar s[16];
      moments_of<Width>(node_u, flsm_plates, flsm_link, missing_offset, missing, missing_factor, origin, tile + l, s);
      for (int k = 0; k < 16; ++k) field[k][l] = s[k];
    }
    const Scalar* rest = flsm_rest + PLIANT_FLSM_REST_PLANES * tile;
    Scalar hd[3][3][PLIANT_TILE], t[3][PLIANT_TILE];
    bool valid[PLIANT_TILE];
    for (int l = 0; l < PLIANT_TILE; ++l) {
      const auto at = [&](int plane) { return rest[plane * PLIANT_TILE + l]; };
      const Scalar d[3] = {at(1), at(2), at(3)};
      const auto added = [&](int c, int axis) { return std::fma(-field[c][l], d[axis], field[4 * axis + 4 + c][l]); };
      const Mat3<Scalar> e{added(0, 0), added(0, 1), added(0, 2), added(1, 0), added(1, 1),
                           added(1, 2), added(2, 0), added(2, 1), added(2, 2)};
      const Scalar a[6] = {at(4), at(5), at(6), at(7), at(8), at(9)};
      bool ok = false;
      const Mat3<Scalar> r = rotation_of(a, e, (a[0] + a[1]) + a[2], ok);
      valid[l] = ok;
      hd[0][0][l] = spacing * r.m00, hd[0][1][l] = spacing * r.m01, hd[0][2][l] = spacing * r.m02;
      hd[1][0][l] = spacing * r.m10, hd[1][1][l] = spacing * r.m11, hd[1][2][l] = spacing * r.m12;
      hd[2][0][l] = spacing * r.m20, hd[2][1][l] = spacing * r.m21, hd[2][2][l] = spacing * r.m22;
    }
    for (int l = 0; l < PLIANT_TILE; ++l) {
      Scalar* record = flsm_regions + PLIANT_FLSM_RECORD * (tile + l);
      for (int c = 0; c < 3; ++c) {
        for (int axis = 0; axis < 3; ++axis) {
          if (!valid[l]) hd[c][axis][l] = record[4 * axis + 4 + c];
        }
        t[c][l] = rest[l] * field[c][l];
        for (int axis = 0; axis < 3; ++axis) t[c][l] = std::fma(-hd[c][axis][l], rest[(axis + 1) * PLIANT_TILE + l], t[c][l]);
      }
      for (int c = 0; c < 3; ++c) {
        record[c] = t[c][l];
        for (int axis = 0; axis < 3; ++axis) record[4 * axis + 4 + c] = hd[c][axis][l];
      }
      for (int block = 0; block < 4; ++block) record[4 * block + 3] = Scalar(0);
    }
  }
}

void register_flsm_region(Registry& registry) {
  registry.add_specialised<flsm_widths>("flsm_region", {"WIDTH"},
                                        [](auto scalar, auto width) { return flsm_region<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
