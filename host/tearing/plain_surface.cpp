#include "tearing/plain_surface.h"

#include <algorithm>
#include <limits>

#include "geometry/vec.h"

namespace pliant {

std::array<std::int32_t, 3> face_key(std::array<std::int32_t, 3> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

SurfaceSources::SurfaceSources(const BodyMesh& whole) {
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    std::array<std::int32_t, 3> nodes{};
    for (std::size_t k = 0; k < 3; ++k) nodes[k] = whole.surface_nodes[whole.triangles[t][k]][0];
    at_[face_key(nodes)] = static_cast<std::int32_t>(t);
  }
}

void surface_of_faces(const BodyMesh& whole, std::span<const OuterFace> faces, BodyMesh& solid) {
  solid.surface = whole.surface;
  solid.surface_nodes = whole.surface_nodes;
  solid.surface_weights = whole.surface_weights;
  solid.triangles.clear();
  solid.triangle_cut.clear();
  solid.triangle_middle.clear();
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::int32_t> vertex(solid.nodes.size(), -1);  // of a node
  for (std::size_t v = 0; v < whole.surface.size(); ++v) vertex[whole.surface_nodes[v][0]] = static_cast<std::int32_t>(v);
  for (const OuterFace& face : faces) {
    std::array<std::int32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t n = face.nodes[k];
      if (vertex[n] < 0) {
        vertex[n] = static_cast<std::int32_t>(solid.surface.size());
        solid.surface.push_back(solid.nodes[n]);
        solid.surface_nodes.push_back({n, n, n, n, n, n, n, n});
        solid.surface_weights.push_back({1, 0, 0, 0, 0, 0, 0, 0});
      }
      triangle[k] = vertex[n];
    }
    Vec3d middle{none, none, none};
    if (face.source >= 0) {
      middle = {};
      for (const std::int32_t v : whole.triangles[face.source]) middle = vec::add(middle, vec::mul(whole.surface[v], 1.0 / 3));
    }
    solid.triangles.push_back(triangle);
    solid.triangle_cut.push_back(static_cast<char>(face.source < 0));
    solid.triangle_middle.push_back(middle);
  }
}

}  // namespace pliant
