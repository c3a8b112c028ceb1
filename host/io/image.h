// A picture in memory.
#pragma once
#include <cstdint>
#include <vector>

namespace pliant {

/// Rows from top to bottom, three bytes red, green, blue per pixel, sRGB.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< [3 * width * height]
};

}  // namespace pliant
