// What a scene has apart from its bodies and rigid tools: blades, the focus, and the place from which pictures are taken.
#pragma once
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

/// The name of the focus in "follow".
inline constexpr const char* kFocus = "focus";
/// What the name of a blade that a program moves begins with in "follow".
inline constexpr const char* kHostBlade = "host/";

/// A point on a prescribed path, which operational regions can follow.
struct Focus {
  std::vector<std::array<double, 4>> path;  ///< (time [s], x, y, z [m]), times ascending, linear in between, held outside
  [[nodiscard]] Vec3d position(double time) const;
};

/// A blade on a prescribed path: a segment that cuts whatever it sweeps over.
struct Blade {
  std::string name;
  std::vector<std::array<double, 7>>
      path;  ///< (time [s], both ends [m]), at least two rows, times ascending, linear in between
  double start = -std::numeric_limits<double>::infinity();  ///< it cuts from here [s], and not before its path begins
  double end = std::numeric_limits<double>::infinity();     ///< ... to here [s], and not after its path ends
  std::string pointer;                                      ///< JSON pointer ("/blades/0")
  /// Both ends at a time [m]; held outside the path.
  [[nodiscard]] std::array<Vec3d, 2> at(double time) const;
};

/// Where pictures are taken from. What is absent is found from the scene.
struct SceneView {
  std::optional<Vec3d> eye;     ///< [m]; absent: so far away that the scene fills the picture
  std::optional<Vec3d> target;  ///< what is in the middle [m]; absent: the middle of the scene
  std::optional<Vec3d> up;      ///< absent: against gravity, or y
  double field_of_view = 30;    ///< vertical [degrees], in [1, 120]
  bool ground = true;           ///< draw a ground plane below the bodies; it holds nothing
};

}  // namespace pliant
