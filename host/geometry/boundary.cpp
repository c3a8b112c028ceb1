// The boundary of a volume mesh: the faces that belong to one cell only.
#include <algorithm>
#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace pliant {
namespace {

struct Face {
  std::array<std::int32_t, 4> key;    ///< sorted vertices; the first is -1 for a triangle
  std::array<std::int32_t, 4> nodes;  ///< outward; the last repeats the first for a triangle
  std::size_t order;                  ///< of appearance, which the result keeps
};

constexpr std::array<std::array<std::size_t, 3>, 4> kTetFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<std::array<std::size_t, 4>, 6> kHexFaces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

std::vector<Face> all_faces(const VolumeMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size() + 6 * mesh.hexes.size());
  for (const auto& t : mesh.tets) {
    for (const auto& f : kTetFaces) {
      Face face{{-1, t[f[0]], t[f[1]], t[f[2]]}, {t[f[0]], t[f[1]], t[f[2]], t[f[0]]}, faces.size()};
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  }
  for (const auto& h : mesh.hexes) {
    for (const auto& f : kHexFaces) {
      Face face{{h[f[0]], h[f[1]], h[f[2]], h[f[3]]}, {h[f[0]], h[f[1]], h[f[2]], h[f[3]]}, faces.size()};
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  }
  return faces;
}

}  // namespace

std::vector<std::array<std::int32_t, 3>> boundary_triangles(const VolumeMesh& mesh) {
  std::vector<Face> faces = all_faces(mesh);
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.order < b.order; });
  std::vector<Face> outer;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].key == faces[i].key) ++j;
    if (j == i + 1) outer.push_back(faces[i]);
    i = j;
  }
  std::sort(outer.begin(), outer.end(), [](const Face& a, const Face& b) { return a.order < b.order; });
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (const Face& f : outer) {
    triangles.push_back({f.nodes[0], f.nodes[1], f.nodes[2]});
    if (f.key[0] >= 0) triangles.push_back({f.nodes[0], f.nodes[2], f.nodes[3]});
  }
  return triangles;
}

}  // namespace pliant
