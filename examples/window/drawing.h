// The soft body in OpenGL: smooth shading, cut faces in another colour, its shadow on the ground.
#pragma once
#include <pliant/world.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "camera.h"
#include "gl.h"

namespace window {

enum class ToolLook { hidden, steel, active };

/// Colours of values from nothing to the largest, sRGB.
inline constexpr std::array<Vec3, 5> kRamp{Vec3{0.80F, 0.79F, 0.77F}, Vec3{0.96F, 0.83F, 0.45F}, Vec3{0.94F, 0.55F, 0.18F},
                                           Vec3{0.78F, 0.20F, 0.16F}, Vec3{0.40F, 0.02F, 0.16F}};

/// Column-major, of a position [m] and a unit quaternion x, y, z, w.
Mat4 pose_matrix(const pliant::Vec3d& at, const std::array<double, 4>& turn);

class Drawing {
 public:
  Drawing();
  /// Upload what changed since the last frame.
  void update(const pliant::Frame& frame);
  /// Colours the bodies by values of the vertices from 0 to `most`; by nothing if there is not a value for each.
  void set_values(const std::vector<float>& values, float most);
  /// The shape of a tool in its own frame [m], instead of what it was.
  void set_tool(const std::string& name, const pliant::SurfaceSpec& surface);
  void hide_tools();
  /// Where to draw a tool that has a shape.
  void place_tool(const std::string& name, const Mat4& pose, ToolLook look);
  void draw(const Orbit& camera, int width, int height, float ground);
  /// Rows from top to bottom, red, green, blue.
  [[nodiscard]] std::vector<std::uint8_t> pixels(int width, int height) const;

 private:
  void set_topology(const pliant::Frame& frame);
  void draw_ground(const Mat4& matrix, const Orbit& camera, float ground);
  void draw_body();
  void draw_tools(GLuint program);

  struct Solid {
    GLuint array = 0, corners = 0;
    GLsizei count = 0;  ///< corners
    Mat4 pose{};
    ToolLook look = ToolLook::hidden;
  };

  Gl gl_;
  GLuint body_program_ = 0, flat_program_ = 0;
  GLuint body_ = 0, positions_ = 0, normals_ = 0, values_ = 0, indices_ = 0;
  GLuint ground_ = 0, ground_corners_ = 0;
  GLsizei outside_ = 0, cut_ = 0;  ///< indices
  std::map<std::string, Solid> tools_;
  std::uint64_t topology_ = 0;
  std::size_t vertices_ = 0;
  bool empty_ = true, colored_ = false;
};

}  // namespace window
