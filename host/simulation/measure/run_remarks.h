// What a user should know of a run that goes on or has ended.
#pragma once
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace pliant {

/// Sentences about what happened since the simulation was made: elements that were calmed, driven back or parted, ballast,
/// tools that went deep, touched nothing or are too thin, and forces of tools that damping has a part in.
[[nodiscard]] std::vector<std::string> run_remarks(Simulation& simulation);

}  // namespace pliant
