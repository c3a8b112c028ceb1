#include "render/lighting.h"

#include <numbers>

namespace pliant::render {
namespace {

constexpr float kReflectance = 0.04F;  ///< of water and most tissue at normal incidence

float fresnel(float cosine) {
  const float m = 1 - std::fmin(std::fmax(cosine, 0.0F), 1.0F), m2 = m * m;
  return kReflectance + (1 - kReflectance) * m2 * m2 * m;
}

/// A rectangle of light seen in direction d: 1 inside, soft at the rim.
float window(Vec3f d, const Basis& at, float half_width, float half_height, float softness) {
  const float z = dot(d, at.z);
  if (z <= 0.05F) return 0;
  const float x = std::fabs(dot(d, at.x)) / z, y = std::fabs(dot(d, at.y)) / z;
  return (1 - smoothstep(half_width - softness, half_width + softness, x)) *
         (1 - smoothstep(half_height - softness, half_height + softness, y));
}

}  // namespace

Lighting::Lighting(const Camera& camera) : up_(camera.up), view_(camera.axes) {
  // Horizontal axes of the view; a view straight down keeps its own right.
  const Vec3f right = unit(view_.x - up_ * dot(view_.x, up_), {1, 0, 0});
  const Vec3f front = cross(right, up_);
  behind_ = -front;
  key_ = basis_around(unit(up_ * 1.05F - right * 0.95F + front * 0.45F));
  const Vec3f level = unit(cross(up_, key_.z), right);
  key_ = {level, cross(key_.z, level), key_.z};
}

Vec3f Lighting::sky(Vec3f d) const {
  const float height = dot(d, up_);
  const Vec3f horizon{0.25F, 0.27F, 0.30F}, zenith{0.50F, 0.54F, 0.60F};
  const float back = std::fmax(0.0F, dot(d, behind_));
  return mix(horizon, zenith, std::fmax(0.0F, height)) + Vec3f{0.46F, 0.45F, 0.44F} * (back * back);
}

Vec3f Lighting::reflected_sky(Vec3f d, float roughness) const {
  const Vec3f floor{0.42F, 0.41F, 0.40F};
  const Vec3f base = mix(floor, sky(d), smoothstep(-roughness, roughness, dot(d, up_)));
  const Basis rear{-view_.x, up_, unit(behind_ + up_ * 0.45F)};
  const float light =
      1.4F * window(d, key_, 0.42F, 0.42F, 0.55F * roughness) + 1.1F * window(d, rear, 0.9F, 0.25F, 0.8F * roughness);
  return base + Vec3f{1, 0.98F, 0.95F} * light;
}

float Lighting::key_highlight(Vec3f n, Vec3f v, const Material& material) const {
  const Vec3f l = key_.z, h = unit(l + v);
  const float nl = dot(n, l), nv = std::fmax(dot(n, v), 1e-3F), nh = std::fmax(dot(n, h), 0.0F);
  if (nl <= 0) return 0;
  const float alpha = std::fmin(1.0F, material.roughness * material.roughness + kSinKey / 2);
  const float a2 = alpha * alpha, b = nh * nh * (a2 - 1) + 1;
  const float distribution = a2 / (std::numbers::pi_v<float> * b * b);
  const float k = a2 / 2;
  const float shadowing = 1 / ((nl * (1 - k) + k) * (nv * (1 - k) + k));
  // The key colour is irradiance over pi, hence the factor pi.
  return material.gloss * std::numbers::pi_v<float> * distribution * shadowing * fresnel(dot(v, h)) / 4 * nl;
}

float Lighting::sky_share(Vec3f n, Vec3f v, const Material& material) {
  const float share = fresnel(dot(n, v));
  // Rough surfaces lose most of the mirror at grazing angles.
  return material.gloss * (kReflectance + (share - kReflectance) * (1 - material.roughness) * (1 - material.roughness));
}

}  // namespace pliant::render
