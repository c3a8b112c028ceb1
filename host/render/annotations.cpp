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
  std::string text = fmt::format("{:.{}f}", value, digits);
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

void Pen::line(float x0, float y0, float x1, float y1, float width) {
  const float reach = width / 2 + 1;
  const int left = static_cast<int>(std::floor(std::min(x0, x1) - reach)),
            right = static_cast<int>(std::ceil(std::max(x0, x1) + reach));
  const int top = static_cast<int>(std::floor(std::min(y0, y1) - reach)),
            bottom = static_cast<int>(std::ceil(std::max(y0, y1) + reach));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const float d = distance(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, x0, y0, x1, y1);
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

namespace {

/// Walks over a text: calls draw(character, x, size, height of the baseline over the first one) and returns the end in x. The
/// number after a ^ is a power.
template <class Draw>
float walk(float x, float height, const std::string& text, const Draw& draw) {
  bool power = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '^') {
      power = true;
      continue;
    }
    power = power && (text[i] == '-' || (text[i] >= '0' && text[i] <= '9'));
    const float size = power ? 0.65F * height : height;
    draw(text[i], x, size, power ? 0.5F * height : 0);
    x += size * advance(text[i], i + 1 < text.size() && text[i + 1] != '^' ? text[i + 1] : '\0');
  }
  return x;
}

}  // namespace

float Pen::text(float x, float y, float height, const std::string& text) {
  return walk(x, height, text, [&](char c, float at, float size, float raised) {
    const Coverage glyph = cover(c, at, y - raised, size);
    for (int row = 0; row < glyph.height; ++row) {
      for (int column = 0; column < glyph.width; ++column) {
        const std::size_t pixel =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(glyph.width) + static_cast<std::size_t>(column);
        blend(glyph.left + column, glyph.top + row, static_cast<float>(glyph.share[pixel]) / 255);
      }
    }
  });
}

float text_width(float height, const std::string& text) {
  return walk(0, height, text, [](char, float, float, float) {});
}

Ticks ticks_within(double low, double high) {
  const double width = high - low, raw = width / 5, power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double nice : {5.0, 2.5, 2.0, 1.0}) {
    if (nice * power >= raw * (1 - 1e-9)) step = nice * power;
  }
  Ticks ticks{low, high, {}};
  for (double n = std::ceil(low / step - 1e-9); n * step <= high + 1e-9 * width; ++n)
    ticks.at.push_back((n + 0.0) * step);  // no -0
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

namespace {

/// Words of a title in lines that are no wider than `room`, which a single word may be.
std::vector<std::string> title_lines(const std::string& title, float size, float room) {
  std::vector<std::string> lines{""};
  for (std::size_t from = 0; from < title.size();) {
    const std::size_t to = std::min(title.find(' ', from), title.size());
    const std::string word = title.substr(from, to - from);
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (text_width(size, longer) <= room || lines.back().empty()) {
      lines.back() = longer;
    } else {
      lines.push_back(word);
    }
    from = to + 1;
  }
  return lines;
}

/// Over the bar, which begins at (left, top). A wide title begins further left, and where that is not enough it is smaller.
void draw_title(Image& image, const ColorBar& bar, float left, float top, float size) {
  const auto w = static_cast<float>(image.width);
  const float right = 0.98F * w, strip = right - w * (1 - kBarShare);
  std::vector<std::string> lines = title_lines(bar.title, size, strip);
  lines.push_back("[" + bar.unit + "]");
  float widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, text_width(size, line));
  const float smaller = std::fmin(1.0F, strip / widest);
  const float start = std::fmin(left, right - smaller * widest);
  float y = top + 0.1F * size;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    Pen(image, kInk).text(start, y -= 1.7F * size, smaller * size, *line);
  }
}

}  // namespace

void draw_color_bar(Image& image, const ColorBar& bar) {
  const auto w = static_cast<float>(image.width), h = static_cast<float>(image.height);
  const float top = std::round(0.24F * h), bottom = std::round(0.86F * h);
  const float left = w * (1 - kBarShare) + 0.2F * kBarShare * w, right = left + 0.026F * h;
  const float size = std::fmax(0.022F * h, 7.0F);
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
  draw_title(image, bar, left, top, size);
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
