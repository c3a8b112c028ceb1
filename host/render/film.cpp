#include "render/film.h"

#include <algorithm>

#include "render/color.h"
#include "render/sampling.h"

namespace pliant::render {
namespace {

std::uint8_t byte_of(float v) { return static_cast<std::uint8_t>(std::fmin(std::fmax(v, 0.0F), 1.0F) * 255 + 0.5F); }

/// How much of pixel b the average at a may use.
float alike(const Pixel& a, const Pixel& b) {
  if (a.shows != b.shows || a.shows == Shows::mixed || a.shows == Shows::background) return 0;
  if (a.shows == Shows::ground) return 1;
  const float same_way = dot(a.normal, b.normal);
  const float depth = std::fabs(a.depth - b.depth) / a.depth;
  return smoothstep(0.80F, 0.98F, same_way) * (1 - smoothstep(0.01F, 0.03F, depth));
}

}  // namespace

void PixelSum::add(const Radiance& r) {
  Pixel& s = sum_;
  if (count_ == 0) s.shows = r.shows;
  if (s.shows != r.shows) s.shows = Shows::mixed;
  s.color += tone(r.color());  // tone-map before averaging, so that a bright highlight does not dominate an edge pixel
  s.albedo += r.albedo;
  s.key_light += r.key_light;
  s.key_gloss += r.key_gloss;
  s.sky_gloss += r.sky_gloss;
  s.noisy.light += r.light;
  s.noisy.key += r.key;
  s.noisy.open += r.open;
  s.normal += r.normal;
  s.depth += r.depth;
  ++count_;
}

Pixel PixelSum::average() const {
  Pixel p = sum_;
  const float s = 1.0F / static_cast<float>(std::max(count_, 1));
  for (Vec3f* v : {&p.color, &p.albedo, &p.key_light, &p.key_gloss, &p.sky_gloss, &p.noisy.light, &p.normal}) *v = *v * s;
  p.noisy.key *= s;
  p.noisy.open *= s;
  p.depth *= s;
  const bool bent = length(p.normal) < 0.8F && (p.shows == Shows::outside || p.shows == Shows::cut);
  if (bent) p.shows = Shows::mixed;
  p.normal = unit(p.normal);
  return p;
}

std::vector<Pixel::Noisy> Film::noisy() const {
  std::vector<Pixel::Noisy> all;
  all.reserve(pixels_.size());
  for (const Pixel& p : pixels_) all.push_back(p.noisy);
  return all;
}

void Film::filter_row(int y, bool along_y, const std::vector<Pixel::Noisy>& from, std::vector<Pixel::Noisy>& to) const {
  constexpr int kReach = kTile / 2;
  for (int x = 0; x < width_; ++x) {
    const Pixel& here = at(x, y);
    const std::size_t place = static_cast<std::size_t>(y) * width_ + x;
    Pixel::Noisy sum;
    float weights = 0;
    for (int d = -kReach; d <= kReach; ++d) {
      const int i = along_y ? x : x + d, j = along_y ? y + d : y;
      if (i < 0 || j < 0 || i >= width_ || j >= height_) continue;
      // The two ends stand for the same place in the tile: half each.
      const float w = (d == -kReach || d == kReach ? 0.5F : 1.0F) * (d == 0 ? 1 : alike(here, at(i, j)));
      if (w == 0) continue;
      const Pixel::Noisy& n = from[static_cast<std::size_t>(j) * width_ + i];
      sum.light += n.light * w;
      sum.key += n.key * w;
      sum.open += n.open * w;
      weights += w;
    }
    to[place] = {sum.light * (1 / weights), sum.key / weights, sum.open / weights};
  }
}

Image Film::develop(const std::vector<Pixel::Noisy>& smooth) const {
  Image image{width_, height_, std::vector<std::uint8_t>(3 * pixels_.size())};
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    Vec3f color = p.color;
    if (p.shows == Shows::ground || p.shows == Shows::outside || p.shows == Shows::cut) {
      const Pixel::Noisy& s = smooth[i];
      color = tone(p.albedo * (s.light + p.key_light * s.key) + p.key_gloss * s.key + p.sky_gloss * s.open);
    }
    const Vec3f shown = srgb_of(color);
    // Half a step of noise hides the steps of eight bits in smooth gradients.
    const auto x = static_cast<std::uint32_t>(i % width_), y = static_cast<std::uint32_t>(i / width_);
    const float dither = (r2_sample(place_in_tile(static_cast<int>(x), static_cast<int>(y)), 0).u - 0.5F) / 255;
    image.rgb[3 * i] = byte_of(shown.x + dither);
    image.rgb[3 * i + 1] = byte_of(shown.y + dither);
    image.rgb[3 * i + 2] = byte_of(shown.z + dither);
  }
  return image;
}

}  // namespace pliant::render
