#include "render/export.h"

#include <map>
#include <numeric>

namespace pliant::render {
namespace {

std::vector<float> packed_positions(const Surface& surface) {
  std::vector<float> packed;
  packed.reserve(surface.positions.size() / surface.stride * 3);
  for (std::size_t i = 0; i + 2 < surface.positions.size(); i += surface.stride) {
    packed.insert(packed.end(), {surface.positions[i], surface.positions[i + 1], surface.positions[i + 2]});
  }
  return packed;
}

}  // namespace

/// A vertex for each normal, and where a texture has a seam for each pair of a normal and coordinates.
void FrameSplitter::part(std::span<const float> positions, const Surface& surface, std::span<const TextureCorners> texture) {
  smooth_ = SmoothNormals(positions, surface.triangles, surface.cut);
  corner_ = smooth_.corner();
  normal_.resize(smooth_.count());
  std::iota(normal_.begin(), normal_.end(), 0);
  texture_.clear();
  if (texture.empty()) return;
  normal_.clear();
  std::map<std::pair<std::int32_t, std::array<float, 2>>, std::int32_t> known;
  for (std::size_t c = 0; c < corner_.size(); ++c) {
    const std::array<float, 2>& at = texture[c / 3][c % 3];
    const auto [place, added] = known.try_emplace({corner_[c], at}, static_cast<std::int32_t>(normal_.size()));
    if (added) {
      normal_.push_back(corner_[c]);
      texture_.insert(texture_.end(), at.begin(), at.end());
    }
    corner_[c] = place->second;
  }
}

SurfaceFrame FrameSplitter::split(const Surface& surface, double time, const std::vector<VertexArray>& fields,
                                  std::span<const TextureCorners> texture) {
  const std::vector<float> packed = packed_positions(surface);
  if (!ready_ || topology_ != surface.topology) {
    part(packed, surface, texture);
    topology_ = surface.topology;
    ready_ = true;
  }
  SurfaceFrame frame;
  frame.time = time;
  frame.topology = surface.topology;
  frame.triangles = corner_;
  frame.texture = texture_;
  frame.cut.assign(surface.cut.begin(), surface.cut.end());
  const std::vector<Vec3f> normals = smooth_.compute(packed, surface.triangles);
  const auto vertex = [&](std::int32_t normal) { return smooth_.vertex()[static_cast<std::size_t>(normal)]; };
  for (const std::int32_t i : normal_) {
    const Vec3f& n = normals[static_cast<std::size_t>(i)];
    frame.normals.insert(frame.normals.end(), {n.x, n.y, n.z});
    const float* p = packed.data() + 3 * static_cast<std::size_t>(vertex(i));
    frame.positions.insert(frame.positions.end(), {p[0], p[1], p[2]});
  }
  for (const VertexArray& field : fields) {
    VertexArray& out = frame.fields.emplace_back(VertexArray{field.name, field.components, {}});
    for (const std::int32_t i : normal_) {
      const auto at = field.values.begin() + static_cast<std::ptrdiff_t>(vertex(i)) * field.components;
      out.values.insert(out.values.end(), at, at + field.components);
    }
  }
  return frame;
}

ObjCorners obj_corners(const Surface& surface, std::span<const TextureCorners> texture) {
  const std::vector<float> packed = packed_positions(surface);
  const SmoothNormals smooth(packed, surface.triangles, surface.cut);
  ObjCorners out;
  for (const Vec3f& n : smooth.compute(packed, surface.triangles)) out.normals.push_back({n.x, n.y, n.z});
  std::map<std::array<float, 2>, std::int32_t> known;
  for (std::size_t t = 0; t < texture.size(); ++t) {
    auto& normal = out.normal_of.emplace_back();
    auto& at = out.texture_of.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      normal[k] = smooth.corner()[3 * t + k];
      const auto [place, added] = known.try_emplace(texture[t][k], static_cast<std::int32_t>(out.texture.size()));
      if (added) out.texture.push_back(texture[t][k]);
      at[k] = place->second;
    }
  }
  out.cut.assign(surface.cut.begin(), surface.cut.end());
  return out;
}

}  // namespace pliant::render
