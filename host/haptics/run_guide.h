// Interface for code between two steps of a run: it changes the simulation and limits the steps until the next change.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>

#include "haptics/drive_log.h"
#include "simulation/simulation.h"

namespace pliant::haptics {

class RunGuide {
 public:
  RunGuide() = default;
  RunGuide(const RunGuide&) = delete;
  RunGuide& operator=(const RunGuide&) = delete;
  virtual ~RunGuide() = default;
  /// Steps of the present length before next() is due; 0: it is.
  [[nodiscard]] virtual std::int64_t steps_left(const Simulation& simulation) const = 0;
  /// Changes the simulation, and may confirm() it, which may take steps back. Returns false where the run ends; a call after
  /// that changes nothing.
  virtual bool next(Simulation& simulation) = 0;
};

/// A row of the log of drives, without its content.
inline LoggedDrive logged(const Simulation& simulation, const std::string& tool) {
  LoggedDrive row;
  row.at = {simulation.step(), simulation.time(), 0};
  row.again = simulation.report().made_again;
  row.tool = tool;
  return row;
}

/// Whole steps of the present length that fit before `time` [s].
inline std::int64_t steps_before(const Simulation& simulation, double time) {
  const double fit = std::floor((time - simulation.time()) / simulation.dt() + 1e-6);
  return fit < 1 ? 0 : fit < 1e15 ? static_cast<std::int64_t>(fit) : std::int64_t{1'000'000'000'000'000};
}

}  // namespace pliant::haptics
