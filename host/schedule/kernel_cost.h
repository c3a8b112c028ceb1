// Counted traffic [bytes] and operations (an fma is two) per element and step: each datum once, what a cache serves not at all.
#pragma once
#include "material/material.h"

namespace pliant {

/// Invariants of H and the first Piola-Kirchhoff stress, counted from kernels/deformation.cl and kernels/law_*.cl.
inline double law_flops(Law law) {
  constexpr double invariants = 27 + 5 + 7 + 1;  // cofactor, det, sums, the test of J
  return invariants + law_info(law).flops;
}

/// Indices 16, data 40, corner forces 48; node texels come on top (16 per node).
inline double tet_force_bytes(bool averaged) { return averaged ? 104 : 104; }
inline double tet_force_flops(Law law) { return 9 + 45 + law_flops(law) + 45 + 9; }

/// Indices 32, fill 4, corner forces 96, and the record where every element has its own.
inline double hex_force_bytes(bool full, bool uniform) { return 132 + (uniform ? 0 : (full ? 800 : 224)); }
inline double hex_force_flops(Law law, bool full, bool uniform) {
  if (full) return 8 * (144 + law_flops(law) + 144);
  if (uniform) return 144 + law_flops(law) + 192 + 12 + 120 + 192;
  // Modes and back 57 + 42 + 72, axes 3 * 28, p 60, dW/dp 61, slope by the axes 3 * 55, by the modes 4 * 39.
  return 144 + law_flops(law) + 57 + 42 + 72 + 84 + 60 + 61 + 165 + 156 + 144;
}

/// Per slot of a brick: node texels 16 (425 of 256 are read, the rest from cache), fill 4, forces 1280 * 4 / 256 = 20.
inline double brick_force_bytes() { return 40; }
inline double brick_force_flops(Law law) { return 75 + 42 + 18 + law_flops(law) + 15 + 24 + 60; }

/// Per slot: brick forces 20, u and w read and written 64, load 16.
inline double brick_update_bytes(bool load) { return 84 + (load ? 16 : 0); }

}  // namespace pliant
