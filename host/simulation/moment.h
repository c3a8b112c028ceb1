// A state of a run that is set aside, to be written once it is certain that no batch takes it back.
#pragma once
#include <cstdint>
#include <vector>

#include "simulation/run_state_parts.h"
#include "simulation/tool_contact.h"

namespace pliant {

struct Moment {
  Clock clock;
  std::vector<std::vector<std::uint8_t>> buffers;  ///< LoadedModel::state_bytes()
  Felt felt;
};

}  // namespace pliant
