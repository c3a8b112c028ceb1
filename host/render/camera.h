// A pinhole camera, and how it finds a scene by itself.
#pragma once
#include <span>

#include "render/vec3f.h"
#include "scene/scene.h"

namespace pliant::render {

struct Camera {
  Vec3f eye;                  ///< [m]
  Basis axes;                 ///< x right, y up, z towards the viewer
  float half_height = 0.27F;  ///< tangent of half the vertical field of view
  float shift = 0;            ///< of the picture to the right, in half widths
  Vec3f up{0, 1, 0};          ///< normal of the ground

  /// Unit direction through a point of the picture: x, y in [-1, 1], right and up; aspect = width / height.
  [[nodiscard]] Vec3f direction(float x, float y, float aspect) const;
  /// Whether a point [m] lies within the picture.
  [[nodiscard]] bool sees(Vec3f p, float aspect) const;
};

struct Framing {
  float aspect = 16.0F / 9;
  float margin = 0.1F;  ///< share of the picture that stays free on each side
  float right = 0;      ///< share of the width that is kept free on the right, for a colour bar
};

/// What `view` leaves open is found from the points [3 * n] to be seen [m]: the target is their middle, the eye so far away
/// that they fill the picture, at front right above. `up` is the scene's vertical unless the view has its own.
Camera fit_camera(const SceneView& view, std::span<const float> points, Vec3f up, const Framing& frame);

}  // namespace pliant::render
