#include "render/color.h"

#include <algorithm>
#include <numbers>

namespace pliant::render {
namespace {

float clamped(float v) { return std::fmin(std::fmax(v, 0.0F), 1.0F); }

float decode(float v) { return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F); }
float encode(float v) { return v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F; }

float bend(float v) {
  constexpr float kFrom = 0.75F;
  return v < kFrom ? std::fmax(v, 0.0F) : 1 - (1 - kFrom) * std::exp((kFrom - v) / (1 - kFrom));
}

/// OKLab to linear sRGB, with the matrices of Ottosson 2020.
Vec3f of_oklab(float lightness, float a, float b) {
  const float l = lightness + 0.3963377774F * a + 0.2158037573F * b;
  const float m = lightness - 0.1055613458F * a - 0.0638541728F * b;
  const float s = lightness - 0.0894841775F * a - 1.2914855480F * b;
  const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
  return {4.0767416621F * l3 - 3.3077115913F * m3 + 0.2309699292F * s3,
          -1.2684380046F * l3 + 2.6097574011F * m3 - 0.3413193965F * s3,
          -0.0041960863F * l3 - 0.7034186147F * m3 + 1.7076147010F * s3};
}

/// Little where the screen has no more to give (blue-green), much at the ends; all of it inside sRGB.
float chroma_at(float t) {
  constexpr float kLeast = 0.098F, kThere = 0.42F;
  const float before = std::fmax(0.0F, kThere - t) / kThere;
  return kLeast + 0.040F * before * before + 0.07F * smoothstep(kThere, 0.95F, t);
}

Vec3f compute(float t) {
  const float lightness = 0.28F + 0.64F * t;
  const float hue = (305 - 202 * t) * std::numbers::pi_v<float> / 180;
  const float chroma = chroma_at(t);
  const Vec3f c = of_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
  return {clamped(c.x), clamped(c.y), clamped(c.z)};
}

constexpr int kShades = 256;

std::array<Vec3f, kShades + 1> make_table() {
  std::array<Vec3f, kShades + 1> table;
  for (int i = 0; i <= kShades; ++i) table[i] = compute(static_cast<float>(i) / kShades);
  return table;
}

}  // namespace

Vec3f linear_of(Vec3f c) { return {decode(clamped(c.x)), decode(clamped(c.y)), decode(clamped(c.z))}; }
Vec3f srgb_of(Vec3f c) { return {encode(clamped(c.x)), encode(clamped(c.y)), encode(clamped(c.z))}; }
Vec3f tone(Vec3f c) { return {bend(c.x), bend(c.y), bend(c.z)}; }

Vec3f map_color(float value) {
  static const std::array<Vec3f, kShades + 1> table = make_table();
  if (std::isnan(value)) return {0.2F, 0.2F, 0.2F};
  const float place = clamped(value) * kShades;
  const int i = std::min(static_cast<int>(place), kShades - 1);
  return mix(table[i], table[i + 1], place - static_cast<float>(i));
}

Vec3f kind_color(int kind) {
  constexpr std::array<Vec3f, 3> kColors{Vec3f{0.78F, 0.27F, 0.21F}, Vec3f{0.95F, 0.78F, 0.32F}, Vec3f{0.32F, 0.52F, 0.70F}};
  return linear_of(kColors[static_cast<std::size_t>(std::clamp(kind, 0, 2))]);
}

}  // namespace pliant::render
