// Surfaces that several tests use.
#pragma once
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "geometry/mesh.h"
#include "scenes/generate/surface_nets.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant::test {

inline TriangleMesh box(const Vec3d& low, const Vec3d& high) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) {
    mesh.vertices.push_back(
        {(c & 1) != 0 ? high[0] : low[0], (c & 2) != 0 ? high[1] : low[1], (c & 4) != 0 ? high[2] : low[2]});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline TriangleMesh sphere(double radius, double step) {
  const double r = radius + 2 * step;
  return surface_nets([radius](const Vec3d& p) { return vec::norm(p) - radius; }, {{-r, -r, -r}, {r, r, r}}, step);
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto shift = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto t : other.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

inline void flip_some(TriangleMesh& mesh, double share, unsigned seed) {
  std::mt19937 random(seed);
  for (auto& t : mesh.triangles) {
    if (static_cast<double>(random()) < share * 4294967296.0) std::swap(t[1], t[2]);
  }
}

inline Vec3d random_point(std::mt19937& random, const Vec3d& low, const Vec3d& high) {
  Vec3d p{};
  for (int a = 0; a < 3; ++a) p[a] = low[a] + (high[a] - low[a]) * (static_cast<double>(random()) / 4294967296.0);
  return p;
}

inline const char* kBunny = "/usr/share/glmark2/models/bunny.obj";

inline std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(test::source_dir()) / "scenes" / "meshes" / (name + ".obj");
}

/// A mesh that is not part of the project; empty if absent.
inline std::filesystem::path outside(const std::string& name) {
  const char* folder = std::getenv("PLIANT_TEST_MESHES");
  const auto file = (folder != nullptr ? std::filesystem::path(folder)
                                       : std::filesystem::path(test::source_dir()) / ".." / "shared" / "meshes") /
                    name;
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

}  // namespace pliant::test
