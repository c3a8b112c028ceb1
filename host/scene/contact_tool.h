// Rigid tools that touch the bodies of a scene: their shapes, their paths, and the law of their contact.
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

enum class ToolShape { sphere, capsule, box, half_space, mesh, sequence };

/// A rigid placement: x = R(turn) y + position.
struct Pose {
  Vec3d position{};                        ///< of the tool's origin [m]
  std::array<double, 4> turn{0, 0, 0, 1};  ///< unit quaternion x, y, z, w
  bool operator==(const Pose&) const = default;
};

/// Rows of the rotation matrix of a unit quaternion.
std::array<Vec3d, 3> rotation_matrix(const std::array<double, 4>& turn);
/// Whether it is finite, with a quaternion whose length is 1 within 1e-3.
bool good_pose(const Pose& pose);
/// From one pose to another, s in [0, 1]: along a line, and turning along the shorter arc at constant speed (Shoemake 1985).
Pose between(const Pose& from, const Pose& to, double s);
/// R(turn) y + position.
Vec3d place(const Pose& pose, const Vec3d& y);
/// R(turn)^T (x - position).
Vec3d place_back(const Pose& pose, const Vec3d& x);
/// The rotation that turns one pose into another, the shorter way: its axis times its angle [rad].
Vec3d turn_between(const Pose& from, const Pose& to);
/// Placed by `inner` first and by `outer` then.
Pose compose(const Pose& outer, const Pose& inner);

/// A rigid body on a prescribed path that pushes what it meets and is not pushed itself. Shapes stand in the tool's own frame.
struct ContactTool {
  std::string name;
  ToolShape shape = ToolShape::sphere;
  double radius = 0;              ///< of a sphere about the origin, or of a capsule [m]
  Vec3d first{}, second{};        ///< ends of a capsule [m]; a point of a half space [m] and its outward normal, of any length
  Vec3d size{};                   ///< edges of a box about the origin [m]
  std::filesystem::path mesh;     ///< a closed surface, or the folder of a sequence of them
  double scale = 1;               ///< of the mesh's coordinates
  double frames_per_second = 30;  ///< of a sequence, whose first mesh stands at time 0 [1/s]
  /// (time [s], position [m], turn x, y, z, w); times ascending, linear in between, held outside; empty: it stands at the
  /// origin.
  std::vector<std::array<double, 8>> path;
  double friction = 0;  ///< Coulomb's coefficient
  double stiffness =
      0;                ///< lambda of Hunt and Crossley (1975) per area [Pa/m^exponent]; 0: "auto", as stiff as the step allows
  double exponent = 1;  ///< 1 or 1.5
  double alpha = 0;     ///< slope of the coefficient of restitution [s/m]: e = 1 - alpha v for small speeds v
  bool edges = false;   ///< a sphere, capsule, box or mesh that passes between points of contact is met along its edges
  std::string pointer;  ///< JSON pointer ("/tools/0")
  [[nodiscard]] Pose at(double time) const;
  bool operator==(const ContactTool&) const = default;
};

/// Bodies touch each other and themselves, and so do the faces of a cut.
struct TissueContact {
  double friction = 0;  ///< Coulomb's coefficient
};

}  // namespace pliant
