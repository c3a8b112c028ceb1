// A tree of vessels inside a body, as a scene gives it.
#pragma once
#include <array>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

/// Straight tubes between points, or solid bars, that stretch with the elements that hold them. They do not resist bending.
struct Vessel {
  std::vector<Vec3d> points;                          ///< at rest [m]
  std::vector<std::array<std::int32_t, 2>> segments;  ///< indices of points
  double radius = 0;                                  ///< outer radius [m]
  double wall = 0;                                    ///< thickness of the wall [m]; 0: a solid bar
  double young = 0;                                   ///< Young's modulus of the wall [Pa]
  double density = 0;                                 ///< of the wall, in addition to the mass of the body [kg/m^3]
  std::string pointer;                                ///< JSON pointer ("/bodies/0/vessels/0")
  /// Of the wall's cross-section [m^2].
  [[nodiscard]] double area() const {
    const double hole = wall > 0 ? radius - wall : 0;
    return std::numbers::pi * (radius * radius - hole * hole);
  }
};

}  // namespace pliant
