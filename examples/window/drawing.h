// The soft body in OpenGL: smooth shading, cut faces in another colour, its shadow on the ground.
#pragma once
#include <pliant/world.h>

#include <vector>

#include "camera.h"
#include "gl.h"

namespace window {

class Drawing {
 public:
  Drawing();
  /// Upload what changed since the last frame.
  void update(const pliant::Frame& frame);
  void draw(const Orbit& camera, int width, int height, float ground);
  /// Rows from top to bottom, red, green, blue.
  [[nodiscard]] std::vector<std::uint8_t> pixels(int width, int height) const;

 private:
  void set_topology(const pliant::Frame& frame);
  void draw_ground(const Mat4& matrix, const Orbit& camera, float ground);
  void draw_body();

  Gl gl_;
  GLuint body_program_ = 0, flat_program_ = 0;
  GLuint body_ = 0, positions_ = 0, normals_ = 0, indices_ = 0;
  GLuint ground_ = 0, ground_corners_ = 0;
  GLsizei outside_ = 0, cut_ = 0;  ///< indices
  std::uint64_t topology_ = 0;
  bool empty_ = true;
};

}  // namespace window
