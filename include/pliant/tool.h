// Rigid tools that touch the bodies of a scene (docs/contact.md): what they are, and what they feel.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene_conditions.h"

namespace pliant {

/// A rigid tool on a prescribed path, or one that stands still. Of the shapes only what belongs to `shape` counts.
struct ToolSpec {
  std::string name;                         ///< different for every tool; empty: tool0, tool1, ...
  std::string shape = "sphere";             ///< sphere, capsule, box, half_space, mesh or sequence, in the tool's own frame
  double radius = 0.01;                     ///< of a sphere about the origin, or of a capsule [m]
  Vec3d first{};                            ///< an end of a capsule, or a point of a half space [m]
  Vec3d second{0, 0.1, 0};                  ///< the other end of a capsule [m], or the outward normal of a half space
  Vec3d size{0.1, 0.1, 0.1};                ///< edges of a box about the origin [m]
  std::string mesh;                         ///< file of a closed surface, or the folder of a sequence of them
  double scale = 1;                         ///< of the mesh's coordinates
  double frames_per_second = 30;            ///< of a sequence; the first mesh stands at time 0 [1/s]
  std::vector<std::array<double, 8>> path;  ///< (time [s], origin [m], unit quaternion x, y, z, w), times ascending; empty: it
                                            ///< stands at the origin
  double friction = 0;                      ///< Coulomb's coefficient
  double stiffness = 0;                     ///< per area [Pa/m^exponent]; 0: "auto", hard at once
  double exponent = 1;                      ///< 1 or 1.5, beside a stiffness
  double alpha = 0;                         ///< slope of the coefficient of restitution, beside a stiffness [s/m]
  bool edges = false;                       ///< where it is thinner than half a cell: met along its edges (docs/contact.md)
};

/// Bodies touch each other and themselves, and so do the faces of a cut (docs/contact.md).
struct ContactSpec {
  double friction = 0;  ///< Coulomb's coefficient
};

/// Where a tool is, and what it feels: the mean of the newest batch of steps.
struct ToolForce {
  std::string name;                        ///< as in the scene, or as it was added
  Vec3d position{};                        ///< of its origin [m]
  std::array<double, 4> turn{0, 0, 0, 1};  ///< unit quaternion x, y, z, w
  Vec3d force{};                           ///< on the tool [N]
  Vec3d torque{};                          ///< about its origin [N m]
  double area = 0;                         ///< of the tissue that touches it, at rest [m^2]
  double penetration = 0;                  ///< of the deepest point [m]
  bool parked = false;                     ///< it touches nothing (World::park_tool)
};

}  // namespace pliant
