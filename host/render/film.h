// The sums of the samples of a picture, and their conversion to bytes.
#pragma once
#include <cstdint>
#include <vector>

#include "io/image.h"
#include "render/vec3f.h"

namespace pliant::render {

/// Contents of a pixel. Pixels that show several things are `mixed`, and no filter touches them.
enum class Shows : std::uint8_t { background, ground, outside, cut, mixed };

/// One sample. Its colour is albedo * (light + key * key_light) + key_gloss * key + sky_gloss * open.
struct Radiance {
  Shows shows = Shows::background;
  Vec3f albedo;     ///< of the ground: the background's colour
  Vec3f light;      ///< from the sky and other surfaces, irradiance over pi
  Vec3f key_light;  ///< of the key light if nothing is in between
  float key = 0;    ///< 1 if the key light is seen
  Vec3f key_gloss;  ///< highlight of the key light
  Vec3f sky_gloss;  ///< reflection of the sky
  float open = 1;   ///< 1 if the sky is seen
  Vec3f normal;
  float depth = 0;  ///< distance from the eye [m]
  [[nodiscard]] Vec3f color() const { return albedo * (light + key_light * key) + key_gloss * key + sky_gloss * open; }
};

/// The average of a pixel's samples. `noisy` are the parts that random directions decide, which the filter smooths.
struct Pixel {
  Vec3f color;
  Vec3f albedo, key_light, key_gloss, sky_gloss;
  struct Noisy {
    Vec3f light;
    float key = 0, open = 0;
  } noisy;
  Vec3f normal;
  float depth = 0;
  Shows shows = Shows::background;
};

/// Sums samples in the order given.
class PixelSum {
 public:
  void add(const Radiance& r);
  [[nodiscard]] Pixel average() const;

 private:
  Pixel sum_;
  int count_ = 0;
};

class Film {
 public:
  Film(int width, int height) : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height) {}
  [[nodiscard]] Pixel& at(int x, int y) { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }
  [[nodiscard]] const Pixel& at(int x, int y) const { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// One line of the noisy parts averaged over a tile's width along x or y, among pixels that show the same smooth surface.
  /// Reads `from`, writes `to` [width * height].
  void filter_row(int y, bool along_y, const std::vector<Pixel::Noisy>& from, std::vector<Pixel::Noisy>& to) const;
  [[nodiscard]] std::vector<Pixel::Noisy> noisy() const;

  /// The picture with the noisy parts replaced.
  [[nodiscard]] Image develop(const std::vector<Pixel::Noisy>& smooth) const;

 private:
  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace pliant::render
