// A font of lines and arcs.
#pragma once
#include <array>
#include <vector>

namespace pliant::render {

/// Lines in units of the capitals' height, y upwards from the baseline.
struct Glyph {
  std::vector<std::vector<std::array<float, 2>>> strokes;
  float advance = 0.4F;
};

/// Letters, digits and the signs . , - + / [ ] ( ) % : =; everything else is a blank.
const Glyph& glyph(char c);

}  // namespace pliant::render
