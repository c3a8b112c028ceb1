// Three floats with the few operations that the renderer needs.
#pragma once
#include <array>
#include <cmath>

namespace pliant::render {

struct Vec3f {
  float x = 0, y = 0, z = 0;
};

inline Vec3f operator+(Vec3f a, Vec3f b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3f operator-(Vec3f a, Vec3f b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3f operator*(Vec3f a, Vec3f b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3f operator*(Vec3f a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3f operator*(float s, Vec3f a) { return a * s; }
inline Vec3f operator-(Vec3f a) { return {-a.x, -a.y, -a.z}; }
inline Vec3f& operator+=(Vec3f& a, Vec3f b) { return a = a + b; }

inline float dot(Vec3f a, Vec3f b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3f cross(Vec3f a, Vec3f b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(Vec3f a) { return std::sqrt(dot(a, a)); }
/// The direction of a; `fallback` where a has none (zero, or not finite).
inline Vec3f unit(Vec3f a, Vec3f fallback = {0, 1, 0}) {
  const float l = length(a);
  return l > 0 && std::isfinite(l) ? a * (1 / l) : fallback;
}
inline Vec3f mix(Vec3f a, Vec3f b, float t) { return a * (1 - t) + b * t; }
/// 0 up to `from`, 1 from `to` on, smooth in between.
inline float smoothstep(float from, float to, float x) {
  const float t = std::fmin(std::fmax((x - from) / (to - from), 0.0F), 1.0F);
  return t * t * (3 - 2 * t);
}

/// Right-handed orthonormal axes.
struct Basis {
  Vec3f x, y, z;
  [[nodiscard]] Vec3f world(Vec3f local) const { return x * local.x + y * local.y + z * local.z; }
};

/// Any basis with this unit z axis.
inline Basis basis_around(Vec3f z) {
  const Vec3f helper = std::fabs(z.x) < 0.7F ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
  const Vec3f x = unit(cross(helper, z));
  return {x, cross(z, x), z};
}

}  // namespace pliant::render
