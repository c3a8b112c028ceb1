// An orbiting camera, matrices and rays.
#pragma once
#include <array>
#include <cmath>

namespace window {

using Vec3 = std::array<float, 3>;
using Mat4 = std::array<float, 16>;  ///< column-major, as OpenGL takes it

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator*(Vec3 a, float s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline float dot(Vec3 a, Vec3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
inline Vec3 unit(Vec3 a) { return a * (1 / std::sqrt(dot(a, a))); }

inline Mat4 product(const Mat4& a, const Mat4& b) {
  Mat4 c{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
    }
  }
  return c;
}

struct Ray {
  Vec3 from, along;  ///< along has unit length
};

struct Orbit {
  Vec3 target{};
  float distance = 1, turn = 0.35F, lift = 0.35F;  ///< [m], angles [rad]
  float half_height = 0.27F;                       ///< tangent of half the vertical field of view

  [[nodiscard]] Vec3 back() const { return {std::cos(lift) * std::sin(turn), std::sin(lift), std::cos(lift) * std::cos(turn)}; }
  [[nodiscard]] Vec3 eye() const { return target + back() * distance; }
  [[nodiscard]] Vec3 right() const { return {std::cos(turn), 0, -std::sin(turn)}; }
  [[nodiscard]] Vec3 up() const { return cross(back(), right()); }

  [[nodiscard]] Mat4 matrix(float aspect) const {
    const Vec3 x = right(), y = up(), z = back(), e = eye();
    const Mat4 view{x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, e), -dot(y, e), -dot(z, e), 1};
    const float near = 0.05F * distance, far = 20 * distance;
    const Mat4 projection{
        1 / (half_height * aspect),    0, 0, 0, 0, 1 / half_height, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0,
        2 * far * near / (near - far), 0};
    return product(projection, view);
  }
  /// Through a point of the window, x and y in [-1, 1].
  [[nodiscard]] Ray ray(float x, float y, float aspect) const {
    return {eye(), unit(right() * (x * half_height * aspect) + up() * (y * half_height) - back())};
  }
};

}  // namespace window
