// Quantities that a run records over time: the keys "probes" and "probe_every" of a scene.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/selection.h"

namespace pliant {

/// Of a point: position, displacement, velocity, stress, strains. Of chosen nodes: the first three, and reaction, force,
/// energy; position, displacement and velocity are their means. Between tools and bodies: interpenetration.
enum class Quantity {
  position,          ///< [m]
  displacement,      ///< [m]
  velocity,          ///< [m/s]
  stress,            ///< Cauchy stress of the material at the point [Pa]
  green_strain,      ///< Green-Lagrange strain there, in the axes at rest [1]
  almansi_strain,    ///< Almansi strain there, in the axes of space [1]
  reaction,          ///< force that fixes or moves the nodes, summed [N]
  force,             ///< applied loads on the nodes, summed (simulation/step/applied_loads.h) [N]
  energy,            ///< kinetic of the nodes, strain of the elements between them [J]
  interpenetration,  ///< volume [m^3], centroid [m], two areas [m^2], depth and deepest point [m] (docs/contact.md)
};

struct SceneProbe {
  std::string name;
  std::optional<Vec3d> point;        ///< at rest [m]; absent: see `where`
  Selection where;                   ///< nodes of `body`
  std::string body;                  ///< its name; of a point empty: the one that holds it
  std::vector<std::string> between;  ///< instead of nodes: a tool or a body, and a body; none: all bodies
  std::vector<Quantity> quantities;  ///< in the order in which they are written
  std::string pointer;               ///< for messages: "/probes/0", "--probe tip"
};

struct SceneProbes {
  std::vector<SceneProbe> list;
  std::int64_t every_steps = 0;  ///< 0: see every_seconds
  double every_seconds = 0;      ///< [s]; 0 too: with every frame
};

}  // namespace pliant
