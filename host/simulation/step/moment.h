// A copy of the state, to be output once it is certain that Recovery will not roll back behind it.
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
