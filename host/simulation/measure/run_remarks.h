// Remarks on a run in progress or completed.
#pragma once
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace pliant {

/// Returns sentences on the events since the start: elements that were calmed, inverted or split by overstretch, ballast,
/// networks of springs that are inside out, tools that went deep, had no contact, grip nothing or are too thin, and tool forces
/// with a contribution from damping.
[[nodiscard]] std::vector<std::string> run_remarks(Simulation& simulation);

}  // namespace pliant
