// Rigid contact tools of a scene: shapes, paths, and contact law.
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec3.h"
#include "pliant/tool.h"

namespace pliant {

struct Blade;

/// `blade_face` is none of the words of a scene file: one of the two faces of a blade that cuts by force (blade_face.h).
enum class ToolShape { sphere, capsule, box, half_space, mesh, sequence, blade_face };

/// A rigid placement: x = R(turn) y + position.
struct Pose {
  Vec3d position{};                        ///< of the tool's origin [m]
  std::array<double, 4> turn{0, 0, 0, 1};  ///< unit quaternion x, y, z, w
  bool operator==(const Pose&) const = default;
};

/// Rows of the rotation matrix of a unit quaternion.
std::array<Vec3d, 3> rotation_matrix(const std::array<double, 4>& turn);
/// Returns whether it is finite, with a quaternion of length 1 within 1e-3.
bool good_pose(const Pose& pose);
/// Interpolates two poses, s in [0, 1]: along a line, rotating along the shorter arc at constant speed (Shoemake 1985).
Pose between(const Pose& from, const Pose& to, double s);
/// R(turn) y + position.
Vec3d place(const Pose& pose, const Vec3d& y);
/// R(turn)^T (x - position).
Vec3d place_back(const Pose& pose, const Vec3d& x);
/// Returns the shorter rotation between two poses: axis times angle [rad].
Vec3d turn_between(const Pose& from, const Pose& to);
/// Returns the composition: `inner` is applied first, then `outer`.
Pose compose(const Pose& outer, const Pose& inner);

/// A rigid body on a prescribed path that pushes tissue and is not moved by it. Shapes are in the tool's own frame.
struct ContactTool {
  std::string name;
  ToolShape shape = ToolShape::sphere;
  double radius = 0;              ///< of a sphere about the origin, or of a capsule [m]
  Vec3d first{}, second{};        ///< ends of a capsule [m]; a point of a half space [m] and its outward normal, of any length
  Vec3d size{};                   ///< edges of a box about the origin [m]
  std::filesystem::path mesh;     ///< a closed surface, or the folder of a sequence of them
  double scale = 1;               ///< of the mesh's coordinates
  double frames_per_second = 30;  ///< rate of a sequence [1/s]; its first mesh is used at time 0
  /// (time [s], position [m], turn x, y, z, w); times ascending, interpolated linearly, constant outside; empty: at the
  /// origin.
  std::vector<std::array<double, 8>> path;
  double friction = 0;  ///< Coulomb's coefficient
  double stiffness =
      0;                ///< lambda of Hunt and Crossley (1975) per area [Pa/m^exponent]; 0: "auto", as stiff as the step allows
  double exponent = 1;  ///< 1 or 1.5
  double alpha = 0;     ///< slope of the coefficient of restitution [s/m]: e = 1 - alpha v for small speeds v
  bool edges = false;   ///< contact along edges, for a sphere, capsule, box or mesh that fits between contact points
  std::optional<GripSpec> grip;        ///< absent: it cannot hold tissue
  std::string pointer;                 ///< JSON pointer ("/tools/0")
  std::shared_ptr<const Blade> blade;  ///< of a face: the blade that carries it, which gives it its pose
  int side = 0;                        ///< of a face: 1 or -1, towards x or against it
  [[nodiscard]] Pose at(double time) const;
  bool operator==(const ContactTool&) const = default;
};

/// Contact between bodies, of bodies with themselves, and between the faces of a cut.
struct TissueContact {
  double friction = 0;  ///< Coulomb's coefficient
};

}  // namespace pliant
