// The surface in Embree, and ray queries. Only ray_scene_embree.cpp uses Embree.
#pragma once
#include <memory>
#include <vector>

#include "render/renderer.h"
#include "render/smooth_normals.h"

namespace pliant::render {

struct Hit {
  float distance = 0;
  std::int32_t triangle = -1;
  float u = 0, v = 0;  ///< weights of the triangle's second and third corner
};

class RayScene {
 public:
  /// Throws Error in a build without Embree.
  RayScene();
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Returns whether the hierarchy was rebuilt.
  bool update(const Surface& surface);

  /// The nearest triangle, or triangle = -1.
  [[nodiscard]] Hit nearest(Vec3f origin, Vec3f direction) const;
  /// Whether anything is in this direction.
  [[nodiscard]] bool blocked(Vec3f origin, Vec3f direction) const;

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const SmoothNormals& smooth() const { return smooth_; }
  [[nodiscard]] const std::vector<Vec3f>& normals() const { return normals_; }
  /// Whether the edge opposite a corner of a triangle of the skin belongs to the face of a cut too.
  [[nodiscard]] bool seam(std::size_t corner) const { return !seams_.empty() && seams_[corner] != 0; }
  [[nodiscard]] std::size_t vertices() const { return positions_.size() / 3; }
  [[nodiscard]] Vec3f vertex(std::int32_t i) const {
    const float* p = positions_.data() + 3 * static_cast<std::size_t>(i);
    return {p[0], p[1], p[2]};
  }
  /// Diagonal of the box around all vertices [m], at least 1e-6 m.
  [[nodiscard]] float size() const { return size_; }
  /// Length by which rays leave a surface [m].
  [[nodiscard]] float step() const { return 1e-4F * size_; }

  static bool available();

 private:
  struct Embree;  // ray_scene_embree.cpp, or ray_scene_no_embree.cpp
  void build(const Surface& surface);
  void refit();
  void check() const;
  void pack();
  void measure();
  void find_seams();
  std::unique_ptr<Embree> embree_;
  Surface surface_;
  std::vector<float> positions_;  ///< [3 * vertices]
  std::size_t vertices_ = 0, corners_ = 0;
  std::uint64_t topology_ = 0;
  bool built_ = false;
  SmoothNormals smooth_;
  std::vector<Vec3f> normals_;
  std::vector<char> seams_;  ///< [3 * triangles]; empty: nothing is cut
  float size_ = 1;
};

}  // namespace pliant::render
