// The report at the end of a run.
#pragma once
#include <string>
#include <vector>

#include "cli/cli.h"
#include "cli/energy_report.h"
#include "cli/frames.h"
#include "cli/live_run.h"
#include "cli/probes.h"
#include "cli/run_loop.h"

namespace pliant::cli {

struct FinishedRun {
  const Common& common;
  const std::string& stem;  ///< of the scene
  Simulation& simulation;
  const RunResult& result;
  const Probes& probes;        ///< of the command line
  const Probes& scene_probes;  ///< of the scene
  const EnergyReport& energy;
  const std::vector<std::string>& warnings;  ///< about surfaces
  const FrameWriter* frames = nullptr;       ///< nullptr: none were written
  const std::string& checkpoint;             ///< file that holds the end; empty: none
  double first_time = 0;                     ///< when this run began, on the scene's clock [s]
  bool hash = false, deep_hash = false, profile = false;
  LiveRun* live = nullptr;  ///< nullptr: no hands were in it
};

/// Prints the summary, remarks, and the JSON object (docs/schema/run.json).
void report_run(const FinishedRun& report);

}  // namespace pliant::cli
