// The parts of `pliant bench deformation`, and what they share.
#pragma once
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "backends/interface/timing.h"
#include "bench/deformation/deformation.h"
#include "simulation/simulation.h"

namespace pliant::bench {

/// Options with nothing left open, and where rows go.
struct DeformationRun {
  const DeformationOptions& options;
  nlohmann::json& rows;
  std::function<void(const std::string&)> show;  ///< a measurement begins
  [[nodiscard]] Scene scene(const std::string& name) const;
  [[nodiscard]] std::int64_t warm_up() const { return options.quick ? 32 : 256; }
};

void measure_scenes(const DeformationRun& run);
void measure_scaling(const DeformationRun& run);
void measure_accuracy(const DeformationRun& run);

/// Advance; throws Error when the simulation diverges.
void advance(Simulation& simulation, std::int64_t steps);

/// Whole steps as `pliant run` makes them, per step: with loads, the look at the fault flag, and the automatic step's
/// estimates.
Timing time_steps(Simulation& simulation, bool quick);

/// The passes of a step by the device's own clock: [{kernel, label, us_per_launch, launches_per_step}].
nlohmann::json time_each_pass(Simulation& simulation, bool quick);

/// What all rows have.
nlohmann::json deformation_row(const std::string& part, const std::string& scene, const Simulation& simulation);

/// Operational and interface nodes over all nodes.
double operational_share(const Model& model);

/// Members of a row that follow from a Timing.
void add_timing(nlohmann::json& row, const Timing& step, double dt);

}  // namespace pliant::bench
