// Saving a simulation to a checkpoint and restoring it.
#pragma once
#include <filesystem>

#include "io/checkpoint.h"
#include "simulation/simulation.h"

namespace pliant {

/// Returns everything that a run needs to continue with the same bits: the state buffers and the host state between batches.
Checkpoint take_checkpoint(const Simulation& simulation);

/// Put a simulation of the same scene into that state. Throws Error, with nothing changed, when the checkpoint belongs to
/// another scene or other settings, to another real type, or is damaged; `file` is for messages.
void restore_checkpoint(Simulation& simulation, const Checkpoint& checkpoint, const std::filesystem::path& file);

}  // namespace pliant
