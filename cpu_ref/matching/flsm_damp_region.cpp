// Twin of kernels/matching/flsm_damp_region.cl.
#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar, int Width>
void flsm_damp_region(Range range, const Scalar* node_w, const Scalar* flsm_plates, const std::int32_t* flsm_link,
                      const std::int32_t* missing_offset, const std::int32_t* missing, const Scalar* missing_factor,
                      const Scalar* flsm_rest, const Scalar* flsm_spin, const Scalar* flsm_regions, Scalar* flsm_rates,
                      Scalar inverse_spacing) {
  const Scalar origin[4] = {};
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar s[PLIANT_FLSM_RECORD];
    moments_of<Width>(node_w, flsm_plates, flsm_link, missing_offset, missing, missing_factor, origin, i, s);
    const auto rest = [&](int plane) { return flsm_rest[tile_base(i, PLIANT_FLSM_REST_PLANES) + plane * PLIANT_TILE]; };
    const auto spin = [&](int plane) { return flsm_spin[tile_base(i, PLIANT_FLSM_SPIN_PLANES) + plane * PLIANT_TILE]; };
    const Scalar d[3] = {rest(1), rest(2), rest(3)};
    Scalar b[3][3], r[3][3], m[3][3];
    for (int c = 0; c < 3; ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        b[c][axis] = std::fma(-s[c], d[axis], s[4 * axis + 4 + c]);
        r[c][axis] = std::fma(flsm_regions[PLIANT_FLSM_RECORD * i + 4 * axis + 4 + c], inverse_spacing, Scalar(c == axis));
      }
    }
    for (int p = 0; p < 3; ++p) {  // R^T B
      for (int q = 0; q < 3; ++q) m[p][q] = dot3(r[0][p], b[0][q], r[1][p], b[1][q], r[2][p], b[2][q]);
    }
    const Scalar lx = m[2][1] - m[1][2], ly = m[0][2] - m[2][0], lz = m[1][0] - m[0][1];
    const Scalar w[3] = {dot3(spin(0), lx, spin(3), ly, spin(4), lz), dot3(spin(3), lx, spin(1), ly, spin(5), lz),
                         dot3(spin(4), lx, spin(5), ly, spin(2), lz)};
    Scalar* out = flsm_rates + PLIANT_FLSM_RECORD * i;
    for (int c = 0; c < 3; ++c) {
      Scalar column[3];  // R (spin x e)
      for (int axis = 0; axis < 3; ++axis) {
        const int next = (axis + 1) % 3, other = (axis + 2) % 3;
        column[axis] = std::fma(r[c][next], w[other], -(r[c][other] * w[next]));
        out[4 * axis + 4 + c] = column[axis];
      }
      out[c] = rest(0) * s[c];
      for (int axis = 0; axis < 3; ++axis) out[c] = std::fma(-column[axis], d[axis], out[c]);
    }
    for (int block = 0; block < 4; ++block) out[4 * block + 3] = Scalar(0);
  }
}

void register_flsm_damp_region(Registry& registry) {
  registry.add_specialised<flsm_widths>("flsm_damp_region", {"WIDTH"},
                                        [](auto scalar, auto width) { return flsm_damp_region<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
