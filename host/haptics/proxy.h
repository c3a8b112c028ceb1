// The god object (Zilles and Salisbury 1995) or proxy (Ruspini, Kolarov and Khatib 1997): a point that goes with the instrument
// but stays outside a surface, and a spring between both.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "haptics/force_model.h"

namespace pliant::haptics {

/// A sphere about the instrument's origin against the triangles near the contact; without friction.
///
/// The proxy goes to the point nearest to the instrument that a half space for each triangle allows. The half space is bounded
/// by a plane between the triangle and the sphere at the proxy, so that the way there crosses nothing. Triangles below the
/// plane that separates the sphere from the nearest point of the surface share it, so that a flat or convex surface of many
/// triangles is none of many obstacles; for others it is the plane along the triangle's own normal or the one across the
/// direction to the proxy, whichever hinders less. This repeats from the new place until the proxy rests, up to kRounds times a
/// tick. The nearest point under the planes that are touched is found by Hildreth's coordinate ascent of the dual (1957).
///
/// F = k (proxy - instrument), or zero where the instrument's place is no number; the torque about the origin of a sphere is
/// zero. The reports of the simulation are not used: it uses the surface alone.
class ProxyForce : public ForceModel {
 public:
  static constexpr std::size_t kTriangles = 256, kTouched = 12;
  static constexpr int kRounds = 8;
  using Triangle = std::array<Vec3d, 3>;  ///< counter-clockwise from outside [m]

  /// `radius` > 0 [m], `stiffness` [N/m].
  ProxyForce(double radius, double stiffness) : radius_(radius), stiffness_(stiffness) {}
  /// From the haptic thread, as receive(): the surface near the contact. Takes the first kTriangles, returns whether these are
  /// all. A proxy behind a triangle by less than the radius is put in front of it.
  bool surface(std::span<const Triangle> triangles) noexcept;
  void receive(const FrameReport& report) noexcept override;
  Wrench tick(const Pose& tool, double dt) noexcept override;
  /// Centre of the sphere after the last tick [m].
  [[nodiscard]] const Vec3d& proxy() const noexcept { return proxy_; }
  /// Lets the proxy begin where the instrument is in the next tick.
  void restart() noexcept { started_ = false; }

 private:
  struct Plane {
    Vec3d normal{};
    double offset = 0;  ///< the proxy stays where normal x >= offset [m]
  };
  struct Near {
    std::size_t triangle = 0;
    double distance = 0;
    Vec3d point{};
  };
  [[nodiscard]] Near nearest(double reach) noexcept;
  void put_outside(const Near& near) noexcept;
  [[nodiscard]] Plane plane_for(std::size_t triangle, const Plane& below, const Vec3d& goal) const noexcept;
  [[nodiscard]] Vec3d nearest_allowed(const Vec3d& goal, std::size_t planes) const noexcept;

  double radius_, stiffness_;
  std::array<Triangle, kTriangles> triangles_{};
  std::array<Vec3d, kTriangles> normals_{};
  std::array<Vec3d, kTriangles> centres_{};
  std::array<double, kTriangles> extents_{};     ///< greatest distance of a corner from the centre [m]
  std::array<std::size_t, kTriangles> close_{};  ///< triangles within reach
  std::size_t close_count_ = 0;
  std::array<Vec3d, kTriangles> points_{};  ///< of those: nearest to the proxy
  std::array<Plane, kTriangles> planes_{};
  std::size_t count_ = 0;
  Vec3d proxy_{};
  bool started_ = false;
};

}  // namespace pliant::haptics
