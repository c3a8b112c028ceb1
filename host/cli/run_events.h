// Events of the bodies in a run: cuts, tears, pieces, displacements.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace pliant::cli {

/// Since the scene's start, as the present state has it.
struct RunEvents {
  std::int64_t cut_edges = 0;         ///< that blades have cut, without those that parted by themselves (RunState::opened)
  std::int64_t removed_elements = 0;  ///< by blades that remove what they touch
  std::int64_t cut_in_part = 0;       ///< elements with a cut edge whose ends still hold together in the element
  std::int64_t broken_faces = 0;      ///< of tetrahedra, by tearing
  std::int64_t pieces = 0;            ///< of all bodies: elements that share a node belong to one piece
  double max_displacement = 0;        ///< of any node [m]
};

RunEvents run_events(const Simulation& simulation);

/// A sentence for each body of which a part has flown further than twenty times its size.
std::vector<std::string> parts_far_away(const Simulation& simulation);
/// When a blade begins to cut [s].
double first_time(const Blade& blade);
/// Names of blades of the scene that have come to the end of their path and met no body. `certain`: only those that have been
/// followed to the end, which a blade is not while steps of its last batch are still to come.
std::vector<std::string> blades_without_contact(const Simulation& simulation, bool certain);
/// Names of blades whose path is over and led through tissue, in a run in which nothing has been divided.
std::vector<std::string> blades_without_effect(const Simulation& simulation);
/// Blades of the scene whose path or `start` is still to come.
std::vector<const Blade*> blades_to_come(const Simulation& simulation);

}  // namespace pliant::cli
