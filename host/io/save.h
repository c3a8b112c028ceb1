// A simulation into a checkpoint and back.
#pragma once
#include <filesystem>

#include "io/checkpoint.h"
#include "simulation/simulation.h"

namespace pliant {

/// Everything from which a run goes on with the same bits: the state buffers and what the host carries between batches.
Checkpoint take_checkpoint(const Simulation& simulation);

/// Put a simulation of the same scene into that state. Throws Error, with nothing changed, when the checkpoint belongs to
/// another scene or other settings, to another real type, or is damaged; `file` is for messages.
void restore_checkpoint(Simulation& simulation, const Checkpoint& checkpoint, const std::filesystem::path& file);

}  // namespace pliant
