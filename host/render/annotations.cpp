#include "render/annotations.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/color.h"
#include "render/font.h"

namespace pliant::render {
namespace {

/// Distance of a point from a segment.
float distance(float px, float py, float x0, float y0, float x1, float y1) {
  const float dx = x1 - x0, dy = y1 - y0, l2 = dx * dx + dy * dy;
  const float t = l2 > 0 ? std::fmin(std::fmax(((px - x0) * dx + (py - y0) * dy) / l2, 0.0F), 1.0F) : 0;
  return std::hypot(px - x0 - t * dx, py - y0 - t * dy);
}

std::string number_text(double value, double step) {
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  std::string text = fmt::format("{:.{}f}", value + 0.0, digits);
  // 2.5 next to 5.0: one digit for all; 250 next to 500: none.
  if (std::fabs(step * std::pow(10, digits) - std::round(step * std::pow(10, digits))) > 1e-6) {
    text = fmt::format("{:.{}f}", value, digits + 1);
  }
  return text;
}

constexpr Vec3f kInk{0.16F, 0.17F, 0.20F};

}  // namespace

void Pen::blend(int x, int y, float cover) {
  if (cover <= 0 || x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
  std::uint8_t* p = image_.rgb.data() +
                    3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x));
  const float c = std::fmin(cover, 1.0F);
  for (const auto& [i, value] : {std::pair{0, color_.x}, std::pair{1, color_.y}, std::pair{2, color_.z}}) {
    p[i] = static_cast<std::uint8_t>(static_cast<float>(p[i]) * (1 - c) + 255 * value * c + 0.5F);
  }
}

void Pen::line(float x0, float y0, float x1, float y1, float width) { stroke({{x0, y0}, {x1, y1}}, width); }

void Pen::stroke(const std::vector<std::array<float, 2>>& points, float width) {
  float left = HUGE_VALF, right = -HUGE_VALF, top = HUGE_VALF, bottom = -HUGE_VALF;
  for (const auto& p : points) {
    left = std::min(left, p[0]);
    right = std::max(right, p[0]);
    top = std::min(top, p[1]);
    bottom = std::max(bottom, p[1]);
  }
  const float reach = width / 2 + 1;
  for (int y = static_cast<int>(std::floor(top - reach)); y <= static_cast<int>(std::ceil(bottom + reach)); ++y) {
    for (int x = static_cast<int>(std::floor(left - reach)); x <= static_cast<int>(std::ceil(right + reach)); ++x) {
      float d = HUGE_VALF;
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        d = std::min(d, distance(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, points[i][0], points[i][1],
                                 points[i + 1][0], points[i + 1][1]));
      }
      blend(x, y, width / 2 + 0.5F - d);
    }
  }
}

void Pen::rectangle(float x0, float y0, float x1, float y1) {
  for (int y = static_cast<int>(std::floor(y0)); y < static_cast<int>(std::ceil(y1)); ++y) {
    const float rows = std::min(y1, static_cast<float>(y) + 1) - std::max(y0, static_cast<float>(y));
    for (int x = static_cast<int>(std::floor(x0)); x < static_cast<int>(std::ceil(x1)); ++x) {
      blend(x, y, rows * (std::min(x1, static_cast<float>(x) + 1) - std::max(x0, static_cast<float>(x))));
    }
  }
}

float Pen::text(float x, float y, float height, const std::string& text) {
  float size = height, base = y;
  for (const char c : text) {
    if (c == '^') {  // what follows is a power
      size = 0.65F * height;
      base = y - 0.5F * height;
      continue;
    }
    const Glyph& g = glyph(c);
    for (auto points : g.strokes) {
      for (auto& p : points) p = {x + size * p[0], base - size * p[1]};
      stroke(points, std::fmax(0.13F * size, 1.2F));
    }
    x += size * g.advance;
  }
  return x;
}

float text_width(float height, const std::string& text) {
  float width = 0, size = height;
  for (const char c : text) {
    if (c == '^') {
      size = 0.65F * height;
      continue;
    }
    width += size * glyph(c).advance;
  }
  return width;
}

Ticks ticks_within(double low, double high) {
  const double width = high - low, raw = width / 5, power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double nice : {5.0, 2.5, 2.0, 1.0}) {
    if (nice * power >= raw * (1 - 1e-9)) step = nice * power;
  }
  Ticks ticks{low, high, {}};
  for (double n = std::ceil(low / step - 1e-9); n * step <= high + 1e-9 * width; ++n) ticks.at.push_back(n * step);
  return ticks;
}

Ticks nice_ticks(double low, double high) {
  Ticks ticks = ticks_within(low, high);
  if (ticks.at.size() < 2) return ticks;
  const double step = ticks.at[1] - ticks.at[0];
  return ticks_within(std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step);
}

ScaledUnit scaled_unit(const std::string& unit, double largest) {
  const auto power = [&](double factor, const char* prefix) { return ScaledUnit{factor, prefix + unit}; };
  if (unit == "1") return {1, unit};
  if (unit == "m") {
    if (largest >= 1) return {1, unit};
    return largest >= 1e-3 || largest == 0 ? power(1e3, "m") : power(1e6, "u");
  }
  if (largest >= 1e6) return power(1e-6, "M");
  if (largest >= 1e3) return power(1e-3, "k");
  return largest >= 1 || largest == 0 ? ScaledUnit{1, unit} : power(1e3, "m");
}

void draw_color_bar(Image& image, const ColorBar& bar) {
  const auto w = static_cast<float>(image.width), h = static_cast<float>(image.height);
  const float top = std::round(0.24F * h), bottom = std::round(0.86F * h);
  const float left = w * (1 - kBarShare) + 0.2F * kBarShare * w, right = left + 0.026F * h;
  const float room = 0.98F * w - left;
  float size = std::fmax(0.022F * h, 7.0F);
  for (std::size_t from = 0; from < bar.title.size();) {  // no word is wider than the strip
    const std::size_t to = std::min(bar.title.find(' ', from), bar.title.size());
    const float width = text_width(size, bar.title.substr(from, to - from));
    if (width > room) size *= room / width;
    from = to + 1;
  }
  for (float y = top; y < bottom; ++y) {
    const Vec3f c = srgb_of(map_color((bottom - y - 0.5F) / (bottom - top)));
    Pen(image, c).rectangle(left, y, right, std::min(y + 1, bottom));
  }
  Pen ink(image, kInk);
  const auto& at = bar.ticks.at;
  const double step = at.size() > 1 ? at[1] - at[0] : bar.ticks.high - bar.ticks.low;
  for (const double value : at) {
    const auto share = static_cast<float>((value - bar.ticks.low) / (bar.ticks.high - bar.ticks.low));
    const float y = bottom - share * (bottom - top);
    ink.line(right, y, right + 0.35F * size, y, std::fmax(0.1F * size, 1.0F));
    ink.text(right + 0.75F * size, y + size / 2, size, number_text(value, step));
  }
  const std::string unit = "[" + bar.unit + "]";
  // The title stands over the bar, one line per word group, so that it fits the strip.
  float y = top - 1.6F * size;
  ink.text(left, y, size, unit);
  std::vector<std::string> lines{""};
  for (std::size_t from = 0; from < bar.title.size();) {
    const std::size_t to = std::min(bar.title.find(' ', from), bar.title.size());
    const std::string word = bar.title.substr(from, to - from);
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (text_width(size, longer) <= room || lines.back().empty()) {
      lines.back() = longer;
    } else {
      lines.push_back(word);
    }
    from = to + 1;
  }
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) ink.text(left, y -= 1.7F * size, size, *line);
}

void draw_key(Image& image, const std::vector<KeyEntry>& entries) {
  const auto w = static_cast<float>(image.width), h = static_cast<float>(image.height);
  const float size = std::fmax(0.024F * h, 7.0F), left = 0.03F * w;
  float y = h - 0.04F * h - 2 * size * static_cast<float>(entries.size() - 1);
  for (const KeyEntry& e : entries) {
    Pen(image, e.color).rectangle(left, y - 1.15F * size, left + 1.3F * size, y + 0.15F * size);
    Pen(image, kInk).text(left + 2 * size, y, size, e.text);
    y += 2 * size;
  }
}

}  // namespace pliant::render
