// Drawing on a finished picture: lines, text, the colour bar.
#pragma once
#include <string>
#include <vector>

#include "io/image.h"
#include "render/vec3f.h"

namespace pliant::render {

/// Draws with soft edges, in pixels from the upper left corner. Colours are sRGB in [0, 1].
class Pen {
 public:
  Pen(Image& image, Vec3f color) : image_(image), color_(color) {}
  void line(float x0, float y0, float x1, float y1, float width);
  void rectangle(float x0, float y0, float x1, float y1);
  /// Text with its baseline at y; `height` is that of capitals, and ^ raises the number that follows. Characters outside ASCII
  /// are left blank. Returns the end in x.
  float text(float x, float y, float height, const std::string& text);

 private:
  void blend(int x, int y, float cover);
  Image& image_;
  Vec3f color_;
};

/// How far a text reaches [pixels].
float text_width(float height, const std::string& text);

/// Ends and steps of a colour bar in numbers that people read: 1, 2, 2.5 or 5 times a power of ten.
struct Ticks {
  double low = 0, high = 1;
  std::vector<double> at;
};
/// The smallest such range that holds low..high.
Ticks nice_ticks(double low, double high);
/// Returns the ticks inside a user-given range.
Ticks ticks_within(double low, double high);

/// A unit with the prefix that keeps numbers short: 0.02 m -> factor 1000, "mm".
struct ScaledUnit {
  double factor = 1;
  std::string unit;
};
ScaledUnit scaled_unit(const std::string& unit, double largest);

struct ColorBar {
  std::string title;  ///< "von Mises stress"
  std::string unit;   ///< "Pa"
  Ticks ticks;        ///< in that unit
};
/// At the right, over the whole height but a margin. Takes `kBarShare` of the picture's width.
void draw_color_bar(Image& image, const ColorBar& bar);
inline constexpr float kBarShare = 0.16F;

/// Boxes of colour with a word each, at the lower left.
struct KeyEntry {
  Vec3f color;  ///< sRGB
  std::string text;
};
void draw_key(Image& image, const std::vector<KeyEntry>& entries);

}  // namespace pliant::render
