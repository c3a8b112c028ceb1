// Texels of a tile: four numbers of each of 16 nodes or points, one after the other in the buffers, and sorted by component, so
// that the compiler computes 16 together. Without `unroll 1` gcc 12 unrolls such loops and then does not vectorize them.
#pragma once
#include <algorithm>
#include <cstdint>

#include "layout.h"

namespace pliant::ref {

template <class Scalar>
using SortedTexels = Scalar[4][PLIANT_TILE];

/// Sorts 16 consecutive texels.
template <class Scalar>
inline void load_texels(const Scalar* texels, SortedTexels<Scalar>& out) {
#pragma GCC unroll 1
  for (int l = 0; l < PLIANT_TILE; ++l) {
    out[0][l] = texels[4 * l];
    out[1][l] = texels[4 * l + 1];
    out[2][l] = texels[4 * l + 2];
    out[3][l] = texels[4 * l + 3];
  }
}
/// The inverse.
template <class Scalar>
inline void store_texels(const SortedTexels<Scalar>& in, Scalar* texels) {
#pragma GCC unroll 1
  for (int l = 0; l < PLIANT_TILE; ++l) {
    texels[4 * l] = in[0][l];
    texels[4 * l + 1] = in[1][l];
    texels[4 * l + 2] = in[2][l];
    texels[4 * l + 3] = in[3][l];
  }
}

}  // namespace pliant::ref
