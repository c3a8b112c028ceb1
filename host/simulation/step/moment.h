// A state of a run that is set aside, to be written once it is certain that no batch takes it back.
#pragma once
#include <cstdint>
#include <vector>

#include "simulation/state/run_report.h"

namespace pliant {

struct Moment {
  Clock clock;
  std::vector<std::vector<std::uint8_t>> buffers;  ///< LoadedModel::state_bytes()
  RunReport report;
};

}  // namespace pliant
