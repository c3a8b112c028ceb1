#include "render/camera.h"

#include <algorithm>
#include <numbers>

namespace pliant::render {
namespace {

Vec3f vec(const Vec3d& v) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}; }

struct Extent {
  float low = HUGE_VALF, high = -HUGE_VALF;
  void add(float v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

Vec3f middle(std::span<const float> points) {
  std::array<Extent, 3> box;
  for (std::size_t i = 0; i < points.size(); ++i) box[i % 3].add(points[i]);
  return points.empty() ? Vec3f{}
                        : Vec3f{(box[0].low + box[0].high) / 2, (box[1].low + box[1].high) / 2, (box[2].low + box[2].high) / 2};
}

Basis looking(Vec3f towards_viewer, Vec3f up) {
  const Vec3f z = unit(towards_viewer, {0, 0, 1});
  Vec3f x = cross(up, z);
  if (length(x) < 1e-4F) x = basis_around(z).x;  // straight from above
  x = unit(x);
  return {x, cross(z, x), z};
}

/// Moves the eye so that all points lie inside the frame and touch it.
void move_to_fit(Camera& camera, std::span<const float> points, const Framing& frame) {
  const float tan_y = camera.half_height * (1 - 2 * frame.margin);
  const float tan_x = camera.half_height * frame.aspect * (1 - 2 * frame.margin - frame.right);
  // Against the four planes through the eye that bound the frame: right, left, above, below.
  float right = -HUGE_VALF, left = -HUGE_VALF, above = -HUGE_VALF, below = -HUGE_VALF;
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    const Vec3f p{points[i], points[i + 1], points[i + 2]};
    const float x = dot(p, camera.axes.x), y = dot(p, camera.axes.y), z = dot(p, camera.axes.z);
    right = std::max(right, x + tan_x * z);
    left = std::max(left, -x + tan_x * z);
    above = std::max(above, y + tan_y * z);
    below = std::max(below, -y + tan_y * z);
  }
  const float z = std::max((right + left) / (2 * tan_x), (above + below) / (2 * tan_y));
  camera.eye = camera.axes.world({(right - left) / 2, (above - below) / 2, z});
}

}  // namespace

Vec3f Camera::direction(float x, float y, float aspect) const {
  return unit(axes.world({(x - shift) * aspect * half_height, y * half_height, -1}), -axes.z);
}

bool Camera::sees(Vec3f p, float aspect) const {
  const Vec3f from_eye = p - eye;
  const float away = -dot(from_eye, axes.z);
  if (!(away > 0)) return false;
  const float x = dot(from_eye, axes.x) / (away * half_height * aspect) + shift,
              y = dot(from_eye, axes.y) / (away * half_height);
  return std::fabs(x) <= 1 && std::fabs(y) <= 1;
}

Camera fit_camera(const SceneView& view, std::span<const float> points, Vec3f up, const Framing& frame) {
  Camera camera;
  camera.up = view.up ? unit(vec(*view.up), up) : up;
  camera.half_height = std::tan(static_cast<float>(view.field_of_view) * std::numbers::pi_v<float> / 360);
  camera.shift = -frame.right;
  const Vec3f target = view.target ? vec(*view.target) : middle(points);
  if (view.eye) {
    camera.eye = vec(*view.eye);
    camera.axes = looking(camera.eye - target, camera.up);
    return camera;
  }
  // Front right above: front is +z where y is up, and -y where z is up.
  const Vec3f side = std::fabs(camera.up.x) < 0.9F ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
  const Vec3f front = unit(cross(side, camera.up));
  const Vec3f right = cross(camera.up, front);
  camera.axes = looking(front + 0.35F * right + 0.4F * camera.up, camera.up);
  camera.eye = target + camera.axes.z;
  if (points.empty()) return camera;
  move_to_fit(camera, points, frame);
  if (view.target) camera.eye = target + camera.axes.z * dot(camera.eye - target, camera.axes.z);
  return camera;
}

}  // namespace pliant::render
