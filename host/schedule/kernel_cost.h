// Memory traffic [bytes] and operations (an fma is two) per element and step. Each datum counts once; cache hits do not
// count.
#pragma once
#include "material/material.h"

namespace pliant {

/// Invariants of H and the first Piola-Kirchhoff stress, counted from kernels/elements/deformation.cl and kernels/law_*.cl.
inline double law_flops(Law law) {
  constexpr double invariants = 27 + 5 + 7 + 1;  // cofactor, det, sums, the test of J
  return invariants + law_info(law).flops;
}

/// Per slot of a brick: node texels 16 (425 are read for 256 slots, the rest from cache), fill 4, forces 1280 * 4 / 256 = 20.
inline double brick_force_bytes() { return 40; }
inline double brick_force_flops(Law law) { return 75 + 42 + 18 + law_flops(law) + 15 + 24 + 60; }

/// Per slot: brick forces 20, u and w read and written 64, load 16.
inline double brick_update_bytes(bool load) { return 84 + (load ? 16 : 0); }

}  // namespace pliant
