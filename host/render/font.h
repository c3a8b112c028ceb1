// The font of labels (DejaVu Sans), drawn with stb_truetype.
#pragma once
#include <cstdint>
#include <vector>

namespace pliant::render {

/// What a glyph covers of each pixel, row by row from above: 255 is all of it. The first pixel is (left, top).
struct Coverage {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> share;
};

/// Of a glyph whose baseline starts at (x, y) [pixels, y downwards], with capitals of this height. Only ASCII has glyphs;
/// anything else is a blank.
Coverage cover(char c, float x, float y, float height);

/// From the start of a glyph to that of the next, in units of the capitals' height; `next` (0 at the end) brings it closer or
/// pushes it away.
float advance(char c, char next);

}  // namespace pliant::render
