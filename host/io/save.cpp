#include "io/save.h"

#include <fmt/format.h>

#include "pliant/error.h"

namespace pliant {

Checkpoint take_checkpoint(const Simulation& simulation) { return {simulation.scene().name, simulation.snapshot()}; }

void restore_checkpoint(Simulation& simulation, const Checkpoint& checkpoint, const std::filesystem::path& file) {
  try {
    simulation.restore(checkpoint.snapshot);
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: a checkpoint of \"{}\" cannot resume \"{}\": {}", file.string(),
                                          checkpoint.scene_name, simulation.scene().name, error.what()));
  }
}

}  // namespace pliant
