// Springs, membranes and vessels of a scene (docs/scene.md).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene_conditions.h"

namespace pliant {

/// The law of springs: the force F over the elongation e from the length l0 at rest.
struct SpringSpec {
  std::string law = "linear";                ///< linear, cubic, measured or table
  double stiffness = 0;                      ///< linear: k of F = k e [N/m]; 0: of each edge of a body from Young's modulus
  double lambda1 = 0;                        ///< cubic: F = lambda1 (e / l0)^3 + lambda2 e / l0 [N]
  double lambda2 = 0;                        ///< cubic: the same law, required [N]
  double a = 0;                              ///< measured: F = e / (a abs(e) + b) [1/N]
  double b = 0;                              ///< measured: 1 / b is the stiffness at rest, required [m/N]
  std::vector<std::array<double, 2>> curve;  ///< table: pairs e [m], F [N], e ascending
  double damping = 0;                        ///< force over the rate of the length [N s/m]
  bool slack = false;                        ///< no force when it is shorter than at rest
};

/// Springs between nodes of a body, a volume mesh or a sheet.
struct SpringListSpec {
  std::vector<std::array<std::int32_t, 2>> nodes;  ///< [springs] two nodes each
  std::vector<double> factor;                      ///< [springs] on the force of the law; empty: 1
  std::vector<double> length;                      ///< [springs] at rest [m]; empty or 0: that between the nodes
  SpringSpec spring;                               ///< each of them
};

/// Springs between the nodes of two bodies that are near each other at rest.
struct JoinSpec {
  std::array<std::string, 2> bodies;  ///< names
  double distance = 0;                ///< pairs of nodes that are no further apart at rest are joined [m]
  SpringSpec spring;                  ///< each of them
  double break_stretch = 0;           ///< a spring longer than this times its length at rest breaks; 0: never
  double break_force = 0;             ///< a spring that pulls more breaks [N]; 0: never
};

/// A thin elastic layer on the whole surface of a body, as the capsule of an organ; it does not resist bending.
struct MembraneSpec {
  double thickness = 0;   ///< [m]
  double young = 0;       ///< Young's modulus [Pa]
  double poisson = 0.5;   ///< 0 to 0.5; 0.5: incompressible
  double density = 1000;  ///< [kg/m^3]
};

/// A tree of straight tubes, or solid bars, inside a body: they stretch with the tissue around them and do not resist bending.
struct VesselSpec {
  std::vector<Vec3d> points;                          ///< at rest [m], after scale and translate of the body
  std::vector<std::array<std::int32_t, 2>> segments;  ///< indices of points; empty: from each to the next
  double radius = 0;                                  ///< outer radius [m]
  double wall = 0;                                    ///< thickness of the wall [m]; 0: a solid bar
  double young = 0;                                   ///< Young's modulus of the wall [Pa]
  double density = 0;                                 ///< of the wall [kg/m^3], in addition to the mass of the body
};

}  // namespace pliant
