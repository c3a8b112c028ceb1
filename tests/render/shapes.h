// Surfaces for the tests of pictures.
#pragma once
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "render/renderer.h"

namespace pliant::render {

/// The message of the Error that `run` throws, whoever is to blame; empty if it throws none.
template <class Run>
std::string message_of(Run&& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

struct TestSurface {
  std::vector<float> positions;
  std::vector<std::int32_t> triangles;
  [[nodiscard]] Surface view() const {
    Surface s;
    s.positions = positions;
    s.triangles = triangles;
    return s;
  }
};

/// A sphere of radius r around (0, r, 0).
inline TestSurface sphere(float r, int rings = 48) {
  TestSurface s;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < columns; ++j) {
      const float a = std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rings);
      const float b = 2 * std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(columns);
      s.positions.insert(s.positions.end(),
                         {r * std::sin(a) * std::cos(b), r + r * std::cos(a), r * std::sin(a) * std::sin(b)});
    }
  }
  const auto at = [&](int i, int j) { return i * columns + j % columns; };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i > 0) s.triangles.insert(s.triangles.end(), {at(i, j), at(i, j + 1), at(i + 1, j)});
      if (i + 1 < rings) s.triangles.insert(s.triangles.end(), {at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return s;
}

/// The unit cube scaled by `edge`, standing on y = 0; two triangles per face, faces -x, +x, -y, +y, -z, +z.
inline TestSurface cube(float edge) {
  TestSurface s;
  for (int i = 0; i < 8; ++i) {
    s.positions.insert(s.positions.end(), {edge * static_cast<float>((i & 1) - 0.5), edge * static_cast<float>(i >> 1 & 1),
                                           edge * static_cast<float>((i >> 2 & 1) - 0.5)});
  }
  s.triangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return s;
}

}  // namespace pliant::render
