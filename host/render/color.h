// Colours: tone, and the perceptual map for values.
#pragma once
#include <array>
#include <cstdint>

#include "render/vec3f.h"

namespace pliant::render {

/// Linear light from display values and back (IEC 61966-2-1), per channel in [0, 1].
Vec3f linear_of(Vec3f srgb);
Vec3f srgb_of(Vec3f linear);

/// Up to 0.75 as it is, above bent smoothly towards 1: no channel clips.
Vec3f tone(Vec3f linear);

/// The colour of a value in [0, 1] (clamped), in linear light: from dark violet over teal to light yellow, with a lightness
/// linear in OKLab (Ottosson 2020), so that equal steps of the value appear equal. NaN is grey.
Vec3f map_color(float value);

/// Colours of kinds: 0 finite elements, 1 interface, 2 shape matching (linear light).
Vec3f kind_color(int kind);

}  // namespace pliant::render
