// The light of every picture: a bright soft key light at the viewer's upper left, and a sky that is brightest overhead and
// behind.
#pragma once
#include "render/camera.h"
#include "render/vec3f.h"

namespace pliant::render {

/// How a surface reflects.
struct Material {
  Vec3f albedo{0.5F, 0.5F, 0.5F};  ///< linear light
  float roughness = 0.30F;
  float gloss = 1;  ///< factor on the reflected highlight
};

class Lighting {
 public:
  explicit Lighting(const Camera& camera);

  /// Light from the sky in this direction; reflections see soft windows in it.
  [[nodiscard]] Vec3f sky(Vec3f direction) const;
  [[nodiscard]] Vec3f reflected_sky(Vec3f direction, float roughness) const;

  /// Towards a point of the key light.
  [[nodiscard]] Vec3f key_direction(Vec3f local) const { return key_.world(local); }
  [[nodiscard]] Vec3f key_axis() const { return key_.z; }
  /// Irradiance over pi of a surface that faces the key light.
  [[nodiscard]] Vec3f key_color() const { return {1.32F, 1.25F, 1.16F}; }

  /// Highlight of the key light: normal n, direction v to the viewer (Trowbridge-Reitz with Smith's shadowing and Schlick's
  /// Fresnel term, widened by the light's size: Walter et al. 2007, Karis 2013).
  [[nodiscard]] float key_highlight(Vec3f n, Vec3f v, const Material& material) const;
  /// Share of the sky that a dielectric surface reflects to the viewer.
  [[nodiscard]] static float sky_share(Vec3f n, Vec3f v, const Material& material);

  static constexpr float kCosKey = 0.9781F;  ///< half-angle of 12 degrees
  static constexpr float kSinKey = 0.2079F;

 private:
  Vec3f up_;
  Vec3f behind_;  ///< horizontal, away from the viewer
  Basis key_;
  Basis view_;
};

}  // namespace pliant::render
