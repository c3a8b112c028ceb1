#include "render/font.h"

#include <cmath>

#include "pliant/error.h"
#include "render/font_bytes.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace pliant::render {
namespace {

struct Font {
  stbtt_fontinfo info{};
  float capitals = 1;  ///< height of H in units of the font

  Font() {
    const auto* bytes = reinterpret_cast<const unsigned char*>(font_bytes().data());
    int top = 0;
    if (stbtt_InitFont(&info, bytes, 0) == 0 || stbtt_GetCodepointBox(&info, 'H', nullptr, nullptr, nullptr, &top) == 0) {
      throw Error(ErrorCode::internal, "the font of labels that was built in is not a TrueType font");
    }
    capitals = static_cast<float>(top);
  }
};

const Font& font() {
  static const Font font;
  return font;
}

int code_of(char c) { return c >= ' ' && c <= '~' ? c : ' '; }

}  // namespace

Coverage cover(char c, float x, float y, float height) {
  const Font& f = font();
  const float scale = height / f.capitals, left = std::floor(x), top = std::floor(y);
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  stbtt_GetCodepointBitmapBoxSubpixel(&f.info, code_of(c), scale, scale, x - left, y - top, &x0, &y0, &x1, &y1);
  Coverage result{static_cast<int>(left) + x0, static_cast<int>(top) + y0, x1 - x0, y1 - y0, {}};
  if (result.width <= 0 || result.height <= 0) return {};
  result.share.resize(static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height));
  stbtt_MakeCodepointBitmapSubpixel(&f.info, result.share.data(), result.width, result.height, result.width, scale, scale,
                                    x - left, y - top, code_of(c));
  return result;
}

float advance(char c, char next) {
  const Font& f = font();
  int width = 0;
  stbtt_GetCodepointHMetrics(&f.info, code_of(c), &width, nullptr);
  if (next != 0) width += stbtt_GetCodepointKernAdvance(&f.info, code_of(c), code_of(next));
  return static_cast<float>(width) / f.capitals;
}

}  // namespace pliant::render
