#include "render/font.h"

#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace pliant::render {
namespace {

using Points = std::vector<std::array<float, 2>>;

/// Part of an ellipse, angles in degrees, counter-clockwise from the right.
Points arc(float cx, float cy, float rx, float ry, float from, float to) {
  constexpr int kSteps = 16;
  Points points;
  for (int i = 0; i <= kSteps; ++i) {
    const float a = (from + (to - from) * static_cast<float>(i) / kSteps) * std::numbers::pi_v<float> / 180;
    points.push_back({cx + rx * std::cos(a), cy + ry * std::sin(a)});
  }
  return points;
}

Points join(Points a, const Points& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

constexpr float kX = 0.68F;   ///< height of small letters
constexpr float kW = 0.50F;   ///< width of most small letters
constexpr float kR = kW / 2;  ///< their radius
constexpr float kM = kX / 2;  ///< their middle

Points bowl() { return arc(kR, kM, kR, kM, 0, 360); }
Points stem(float x, float from, float to) { return {{x, from}, {x, to}}; }
/// The arch of n, h, m and r, from the stem at x.
Points arch(float x, float width, float foot) {
  return join(arc(x + width / 2, kX - 0.24F, width / 2, 0.24F, 180, 0), {{x + width, foot}});
}

using Table = std::map<char, Glyph>;

void add(Table& t, char c, float width, std::vector<Points> strokes) { t[c] = {std::move(strokes), width + 0.24F}; }

void add_digits(Table& t) {
  add(t, '0', 0.54F, {arc(0.27F, 0.5F, 0.27F, 0.5F, 0, 360)});
  add(t, '1', 0.40F, {{{0.05F, 0.8F}, {0.30F, 1}, {0.30F, 0}}});
  add(t, '2', 0.52F, {join(arc(0.26F, 0.73F, 0.25F, 0.27F, 165, -25), {{0.02F, 0}, {0.53F, 0}})});
  add(t, '3', 0.52F, {join(arc(0.24F, 0.75F, 0.23F, 0.25F, 150, -80), arc(0.24F, 0.26F, 0.27F, 0.26F, 85, -150))});
  add(t, '4', 0.56F, {{{0.42F, 0}, {0.42F, 1}, {0, 0.28F}, {0.56F, 0.28F}}});
  add(t, '5', 0.52F, {join({{0.46F, 1}, {0.08F, 1}, {0.04F, 0.55F}}, arc(0.24F, 0.32F, 0.28F, 0.32F, 130, -145))});
  add(t, '6', 0.54F, {arc(0.27F, 0.31F, 0.26F, 0.31F, 0, 360), join({{0.42F, 1}}, arc(0.36F, 0.34F, 0.35F, 0.42F, 130, 180))});
  add(t, '7', 0.52F, {{{0, 1}, {0.52F, 1}, {0.16F, 0}}});
  add(t, '8', 0.54F, {arc(0.27F, 0.76F, 0.22F, 0.24F, 0, 360), arc(0.27F, 0.27F, 0.27F, 0.27F, 0, 360)});
  add(t, '9', 0.54F, {arc(0.27F, 0.69F, 0.26F, 0.31F, 0, 360), join({{0.12F, 0}}, arc(0.18F, 0.66F, 0.35F, 0.42F, -50, 0))});
}

void add_round_letters(Table& t) {
  add(t, 'a', kW, {bowl(), stem(kW, 0, kX)});
  add(t, 'b', kW, {bowl(), stem(0, 0, 1)});
  add(t, 'c', 0.44F, {arc(kR, kM, kR, kM, 50, 310)});
  add(t, 'd', kW, {bowl(), stem(kW, 0, 1)});
  add(t, 'e', kW, {join({{0, kM}, {kW, kM}}, arc(kR, kM, kR, kM, 0, 315))});
  add(t, 'f', 0.32F, {join(arc(0.26F, 0.84F, 0.16F, 0.16F, 70, 180), {{0.10F, 0}}), {{0, kX}, {0.28F, kX}}});
  add(t, 'g', kW, {bowl(), join({{kW, kX}}, arc(kR, -0.05F, kR, 0.24F, 0, -150))});
  add(t, 'o', kW, {bowl()});
  add(t, 'p', kW, {bowl(), stem(0, -0.3F, kX)});
  add(t, 'q', kW, {bowl(), stem(kW, -0.3F, kX)});
  add(t, 's', 0.40F, {join(arc(0.20F, 0.51F, 0.18F, 0.17F, 40, 250), arc(0.20F, 0.175F, 0.20F, 0.175F, 80, -145))});
}

void add_straight_letters(Table& t) {
  add(t, 'h', 0.46F, {stem(0, 0, 1), arch(0, 0.46F, 0)});
  add(t, 'i', 0, {stem(0, 0, kX), {{0, 0.93F}, {0, 0.95F}}});
  add(t, 'j', 0.1F, {join({{0.1F, kX}}, arc(-0.05F, -0.15F, 0.15F, 0.15F, 0, -90)), {{0.1F, 0.93F}, {0.1F, 0.95F}}});
  add(t, 'k', 0.42F, {stem(0, 0, 1), {{0.40F, kX}, {0, 0.26F}}, {{0.14F, 0.38F}, {0.43F, 0}}});
  add(t, 'l', 0, {stem(0, 0, 1)});
  add(t, 'm', 0.76F, {stem(0, 0, kX), arch(0, 0.38F, 0), arch(0.38F, 0.38F, 0)});
  add(t, 'n', 0.46F, {stem(0, 0, kX), arch(0, 0.46F, 0)});
  add(t, 'r', 0.28F, {stem(0, 0, kX), arc(0.23F, kX - 0.24F, 0.23F, 0.24F, 180, 70)});
  add(t, 't', 0.30F, {join({{0.10F, 0.92F}}, arc(0.25F, 0.15F, 0.15F, 0.15F, 180, 285)), {{0, kX}, {0.28F, kX}}});
  add(t, 'u', 0.46F, {join({{0, kX}}, arc(0.23F, 0.24F, 0.23F, 0.24F, 180, 360)), stem(0.46F, 0, kX)});
  add(t, 'v', 0.46F, {{{0, kX}, {0.23F, 0}, {0.46F, kX}}});
  add(t, 'w', 0.70F, {{{0, kX}, {0.18F, 0}, {0.35F, kX}, {0.52F, 0}, {0.70F, kX}}});
  add(t, 'x', 0.44F, {{{0, kX}, {0.44F, 0}}, {{0, 0}, {0.44F, kX}}});
  add(t, 'y', 0.46F, {{{0, kX}, {0.24F, 0.02F}}, {{0.46F, kX}, {0.16F, -0.3F}}});
  add(t, 'z', 0.42F, {{{0.02F, kX}, {0.42F, kX}, {0, 0}, {0.42F, 0}}});
}

void add_capitals(Table& t) {
  add(t, 'A', 0.64F, {{{0, 0}, {0.32F, 1}, {0.64F, 0}}, {{0.11F, 0.34F}, {0.53F, 0.34F}}});
  add(t, 'E', 0.46F, {{{0.46F, 1}, {0, 1}, {0, 0}, {0.46F, 0}}, {{0, 0.53F}, {0.40F, 0.53F}}});
  add(t, 'F', 0.46F, {{{0.46F, 1}, {0, 1}, {0, 0}}, {{0, 0.53F}, {0.40F, 0.53F}}});
  add(t, 'G', 0.62F, {join(arc(0.32F, 0.5F, 0.32F, 0.5F, 50, 330), {{0.62F, 0.45F}, {0.36F, 0.45F}})});
  add(t, 'H', 0.58F, {stem(0, 0, 1), stem(0.58F, 0, 1), {{0, 0.53F}, {0.58F, 0.53F}}});
  add(t, 'J', 0.38F, {join({{0.38F, 1}}, arc(0.19F, 0.22F, 0.19F, 0.22F, 0, -160))});
  add(t, 'L', 0.44F, {{{0, 1}, {0, 0}, {0.44F, 0}}});
  add(t, 'M', 0.72F, {{{0, 0}, {0, 1}, {0.36F, 0.3F}, {0.72F, 1}, {0.72F, 0}}});
  add(t, 'N', 0.58F, {{{0, 0}, {0, 1}, {0.58F, 0}, {0.58F, 1}}});
  add(t, 'P', 0.52F, {join({{0, 0}, {0, 1}, {0.26F, 1}}, join(arc(0.26F, 0.73F, 0.26F, 0.27F, 90, -90), {{0, 0.46F}}))});
  add(t, 'S', 0.52F, {join(arc(0.27F, 0.75F, 0.24F, 0.25F, 40, 255), arc(0.26F, 0.255F, 0.27F, 0.255F, 80, -150))});
  add(t, 'T', 0.60F, {{{0, 1}, {0.60F, 1}}, stem(0.30F, 0, 1)});
}

void add_signs(Table& t) {
  add(t, '.', 0, {{{0, 0}, {0, 0.02F}}});
  add(t, ',', 0.04F, {{{0.05F, 0.02F}, {0, -0.16F}}});
  add(t, ':', 0, {{{0, 0}, {0, 0.02F}}, {{0, 0.58F}, {0, 0.60F}}});
  add(t, '-', 0.36F, {{{0, 0.42F}, {0.36F, 0.42F}}});
  add(t, '+', 0.46F, {{{0, 0.42F}, {0.46F, 0.42F}}, stem(0.23F, 0.19F, 0.65F)});
  add(t, '=', 0.46F, {{{0, 0.32F}, {0.46F, 0.32F}}, {{0, 0.54F}, {0.46F, 0.54F}}});
  add(t, '/', 0.36F, {{{0, -0.1F}, {0.36F, 1.05F}}});
  add(t, '[', 0.18F, {{{0.18F, 1.1F}, {0, 1.1F}, {0, -0.2F}, {0.18F, -0.2F}}});
  add(t, ']', 0.18F, {{{0, 1.1F}, {0.18F, 1.1F}, {0.18F, -0.2F}, {0, -0.2F}}});
  add(t, '(', 0.16F, {arc(0.32F, 0.45F, 0.32F, 0.7F, 120, 240)});
  add(t, ')', 0.16F, {arc(-0.16F, 0.45F, 0.32F, 0.7F, 60, -60)});
  add(t, '%', 0.70F, {{{0.08F, 0}, {0.62F, 1}}, arc(0.14F, 0.8F, 0.14F, 0.2F, 0, 360), arc(0.56F, 0.2F, 0.14F, 0.2F, 0, 360)});
}

Table make_glyphs() {
  Table t;
  add_digits(t);
  add_round_letters(t);
  add_straight_letters(t);
  add_capitals(t);
  add_signs(t);
  return t;
}

}  // namespace

const Glyph& glyph(char c) {
  static const Table table = make_glyphs();
  static const Glyph blank{};
  const auto found = table.find(c);
  return found == table.end() ? blank : found->second;
}

}  // namespace pliant::render
