// A copy of the state, to be output once it is certain that Recovery will not roll back behind it.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "simulation/edits/blade_press.h"
#include "simulation/state/run_report.h"
#include "simulation/state/tool_state.h"

namespace pliant {

struct Moment {
  Clock clock;
  std::vector<std::vector<std::uint8_t>> buffers;  ///< LoadedModel::state_bytes()
  RunReport report;
  DriveHistory<ToolDrive> driven;               ///< RunState::driven
  std::map<std::string, PressedBlade> pressed;  ///< RunState::pressed
  BladeDrives driven_blades;                    ///< RunState::driven_blades
  BladePress::Felt felt;
};

}  // namespace pliant
