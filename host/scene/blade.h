// Parts of a scene other than its bodies: the followed tool, blades, and the camera.
#pragma once
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

/// The name of the focus in "follow".
inline constexpr const char* kFocus = "focus";
/// Prefix in "follow" of the name of a blade that a program moves.
inline constexpr const char* kHostBlade = "host/";

/// A point on a prescribed path, which operational regions can follow.
struct Focus {
  std::vector<std::array<double, 4>> path;  ///< (time [s], x, y, z [m]), times ascending, linear in between, held outside
  [[nodiscard]] Vec3d position(double time) const;
};

/// Cutting mode: all tissue that a blade sweeps, or only tissue that fails under the force of its edge (docs/cutting.md).
enum class BladeCuts { always, by_force };

/// How a blade divides what it cuts: elements become copies with virtual nodes, they part along their faces and stay what they
/// are, they are divided into smaller ones, or they go (docs/cutting.md).
enum class BladeMethod { virtual_nodes, separation, decomposition, removal };

/// A blade on a prescribed path: a segment that cuts the surface it sweeps.
struct Blade {
  std::string name;
  std::vector<std::array<double, 7>>
      path;  ///< (time [s], both ends [m]), times ascending, linear in between; by force one row will do: it stands there
  double start = -std::numeric_limits<double>::infinity();  ///< cutting starts here [s], but not before the path begins
  double end = std::numeric_limits<double>::infinity();     ///< cutting ends here [s], but not after the path ends
  std::string pointer;                                      ///< JSON pointer ("/blades/0")
  BladeCuts cuts = BladeCuts::always;
  BladeMethod method = BladeMethod::virtual_nodes;  ///< the same for all blades of a scene
  double sharpness = 1;                             ///< by force: kappa, the smaller the sharper
  double edge = 0;                                  ///< by force: radius of the edge [m]
  double friction = 0;                              ///< by force: coefficient between blade and tissue
  double thickness = 0;                             ///< by force: of the blade behind its edge [m]; 0: an edge without faces
  double height = 0;                                ///< how far its faces reach back from the edge [m]
  std::optional<Vec3d> back;                        ///< from the edge to the back; absent: against the first motion of the path
  /// Returns both ends at a time [m]; constant outside the path.
  [[nodiscard]] std::array<Vec3d, 2> at(double time) const;
  [[nodiscard]] bool has_faces() const { return thickness > 0; }
  /// From the edge to the back where the path begins, across the edge, of unit length; 0: neither `back` nor the path says it.
  [[nodiscard]] Vec3d back_at_first() const;
  /// Length of the edge, the largest on its path [m].
  [[nodiscard]] double length() const;
  [[nodiscard]] bool stands() const { return path.size() == 1; }  ///< it waits for the host to move it
  /// When it comes, and when it goes [s].
  [[nodiscard]] double begins() const { return stands() ? start : std::max(start, path.front()[0]); }
  [[nodiscard]] double ends() const { return stands() ? end : std::min(end, path.back()[0]); }
};

/// Camera of pictures. Absent values are derived from the scene.
struct SceneView {
  std::optional<Vec3d> eye;     ///< [m]; absent: at a distance from which the scene fills the picture
  std::optional<Vec3d> target;  ///< point in the centre of the picture [m]; absent: the centre of the scene
  std::optional<Vec3d> up;      ///< absent: against gravity, or y
  double field_of_view = 30;    ///< vertical [degrees], in [1, 120]
  bool ground = true;           ///< draw a ground plane below the bodies, for display only
};

}  // namespace pliant
