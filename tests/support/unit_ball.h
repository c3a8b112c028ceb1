// A ball of triangles.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "geometry/mesh.h"

namespace pliant::test {

/// Of `around` meridians about the z axis, with the volume of the ball of radius 1.
inline TriangleMesh unit_ball(int around) {
  TriangleMesh mesh;
  const int up = around / 2;
  for (int j = 0; j <= up; ++j) {
    const double v = std::numbers::pi * (static_cast<double>(j) / up - 0.5);
    for (int i = 0; i < (j == 0 || j == up ? 1 : around); ++i) {
      const double u = 2 * std::numbers::pi * i / around;
      mesh.vertices.push_back({std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)});
    }
  }
  const auto at = [&](int j, int i) {
    return j == 0 ? 0 : j == up ? 1 + (up - 1) * around : 1 + (j - 1) * around + i % around;
  };
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < around; ++i) {
      if (j > 0) mesh.triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i)});
      if (j + 1 < up) mesh.triangles.push_back({at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)});
    }
  }
  const double grow = std::cbrt(4.0 / 3 * std::numbers::pi / signed_volume(mesh));
  for (Vec3d& v : mesh.vertices) v = {grow * v[0], grow * v[1], grow * v[2]};
  return mesh;
}

}  // namespace pliant::test
