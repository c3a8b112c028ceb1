// Normals of a triangle surface that are smooth where the surface is, and sharp along creases and rims of cuts.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "render/vec3f.h"

namespace pliant::render {

/// Which corners of which triangles share a normal: decided once per topology, used in every frame.
class SmoothNormals {
 public:
  /// positions: [3 * vertices] [m], triangles: [3 * triangles] vertex indices, kind: [triangles] or empty. Two triangles share
  /// the normal of a common vertex when a chain of triangles around it, each sharing an edge, of the same kind and bent by less
  /// than `crease` [rad] here, leads from one to the other.
  SmoothNormals(std::span<const float> positions, std::span<const std::int32_t> triangles,
                std::span<const std::uint8_t> kind = {}, float crease = 1.1F);
  SmoothNormals() = default;

  /// [3 * triangles] index of each corner's normal.
  [[nodiscard]] const std::vector<std::int32_t>& corner() const { return corner_; }
  /// [count] the vertex that a normal belongs to.
  [[nodiscard]] const std::vector<std::int32_t>& vertex() const { return vertex_; }
  [[nodiscard]] std::size_t count() const { return vertex_.size(); }

  /// Unit normals [count] of the present positions, weighted by the angles of the triangles (Thurmer and Wuthrich 1998).
  [[nodiscard]] std::vector<Vec3f> compute(std::span<const float> positions, std::span<const std::int32_t> triangles) const;

 private:
  std::vector<std::int32_t> corner_, vertex_;
};

}  // namespace pliant::render
