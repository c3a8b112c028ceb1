// What an edit of a running body must keep, taken before it and after it.
#pragma once
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace pliant::bench {

/// Where elements lie at rest: copies of one lie at the same place.
using ElementPlaces = std::set<std::array<double, 12>>;

/// Whether the middle of an element lies in one of others, as that of a part of one of them does.
bool lies_in(const std::array<double, 12>& element, const ElementPlaces& others);

/// A body at one moment.
struct EditFigures {
  std::int64_t elements = 0;
  double mass = 0, volume = 0;  ///< [kg], enclosed by the surface at rest [m^3]
  double bound = 0;             ///< of the step, by the single elements [s]
  std::int64_t open_edges = 0;  ///< of the surface
  Vec3d momentum{};             ///< [kg m/s]
  double motion = 0;            ///< sum of m |v|, what the momentum is compared with [kg m/s]
  double kinetic = 0;           ///< of it [J]
  double energy = 0;            ///< kinetic and of strain [J]; NaN where an element is inverted
  ElementPlaces inverted;       ///< elements with J <= 0
  bool finite = true;           ///< displacements and velocities are
};
EditFigures edit_figures(const Simulation& simulation);

/// Pieces of a body, which share no node, against what their surface encloses.
struct PieceFigures {
  std::int64_t pieces = 0;
  std::int64_t strays = 0;  ///< triangles of the surface with corners in two pieces
  double share = 0;         ///< largest |mass / (density volume) - 1| of pieces of a cell and more
  double cells = 0;         ///< largest difference, in masses of a cell
};
/// `density`: the same everywhere [kg/m^3]; `cell`: volume of a cell [m^3].
PieceFigures piece_figures(const Model& model, double density, double cell);

}  // namespace pliant::bench
