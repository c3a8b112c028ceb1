#include "model/surface_texture.h"

#include <algorithm>

#include "geometry/vec.h"

namespace pliant {
namespace {

/// The coordinates at a point of the plane of a triangle at rest: corners, and their coordinates.
std::array<float, 2> affine(const std::array<Vec3d, 3>& x, const TextureCorners& at, const Vec3d& p) {
  const Vec3d e = vec::sub(x[1], x[0]), f = vec::sub(x[2], x[0]), d = vec::sub(p, x[0]);
  const Vec3d n = vec::cross(e, f);
  const double area2 = vec::dot(n, n);
  const double v = vec::dot(vec::cross(d, f), n) / area2, w = vec::dot(vec::cross(e, d), n) / area2;
  std::array<float, 2> out{};
  for (std::size_t c = 0; c < 2; ++c) {
    out[c] = static_cast<float>((1 - v - w) * double(at[0][c]) + v * double(at[1][c]) + w * double(at[2][c]));
  }
  return out;
}

void texture_body(const ModelBody& body, const ModelSurface& surface, std::vector<TextureCorners>& out) {
  const SurfaceTexture& texture = *body.texture;
  const auto rest = [&](std::int32_t vertex) { return surface.rest[static_cast<std::size_t>(body.first_vertex + vertex)]; };
  for (std::int32_t t = 0; t < body.triangles; ++t) {
    const std::int32_t source = body.triangle_source.empty() ? t : body.triangle_source[static_cast<std::size_t>(t)];
    if (source < 0) continue;
    const auto& whole = texture.triangles[static_cast<std::size_t>(source)];
    const TextureCorners& corners = texture.corners[static_cast<std::size_t>(source)];
    const auto at = static_cast<std::size_t>(body.first_triangle + t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t vertex = surface.triangles[at][k] - body.first_vertex;
      const auto same = std::find(whole.begin(), whole.end(), vertex);
      out[at][k] = same != whole.end() ? corners[static_cast<std::size_t>(same - whole.begin())]
                                       : affine({rest(whole[0]), rest(whole[1]), rest(whole[2])}, corners, rest(vertex));
    }
  }
}

}  // namespace

std::vector<TextureCorners> texture_of(const Model& model) {
  std::vector<TextureCorners> out;
  for (const ModelBody& body : model.bodies) {
    if (body.texture == nullptr) continue;
    out.resize(model.surface.triangles.size());
    texture_body(body, model.surface, out);
  }
  return out;
}

}  // namespace pliant
