// Fixed sampling sequences: a pixel's samples depend on its place alone, never on threads or time.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "render/vec3f.h"

namespace pliant::render {

/// Edge of the tile whose pixels share one sequence (interleaved sampling, Keller and Heidrich 2001): a filter of this width
/// sees the samples of all its pixels, each once, and so removes their noise.
inline constexpr int kTile = 8;

struct Sample2 {
  float u, v;
};

/// The additive recurrence of the plastic number (Roberts 2018): every run of it covers the square evenly. `set` shifts it, for
/// dimensions that must not repeat each other.
inline Sample2 r2_sample(std::uint32_t index, std::uint32_t set) {
  constexpr double kA = 0.7548776662466927, kB = 0.5698402909980532;
  const double n = index + 1.0, s = 0.381966 * set;
  const double u = s + kA * n, v = 1.7 * s + kB * n;
  return {static_cast<float>(u - std::floor(u)), static_cast<float>(v - std::floor(v))};
}

/// Number of a pixel inside its tile along the Z-order curve, so that close pixels take close parts of the sequence.
inline std::uint32_t place_in_tile(int x, int y) {
  const auto spread = [](int i) {
    const auto b = static_cast<std::uint32_t>(i % kTile);
    return (b & 1) | (b & 2) << 1 | (b & 4) << 2;
  };
  return spread(x) | spread(y) << 1;
}

/// Direction around +z with density cos / pi.
inline Vec3f cosine_direction(Sample2 s) {
  const float r = std::sqrt(s.u), phi = 2 * std::numbers::pi_v<float> * s.v;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::fmax(0.0F, 1 - s.u))};
}

/// Uniform direction in the cone of this half-angle around +z.
inline Vec3f cone_direction(Sample2 s, float cos_half_angle) {
  const float z = 1 - s.u * (1 - cos_half_angle), r = std::sqrt(std::fmax(0.0F, 1 - z * z));
  const float phi = 2 * std::numbers::pi_v<float> * s.v;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace pliant::render
