// pliant plan: the cheapest configuration of a scene that meets an error tolerance within a frame budget, from measurements on
// this device.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.h"

namespace pliant {

struct PlanOptions {
  double tolerance = 0.02;  ///< relative L2 error of the displacements of the surface's vertices at rest
  double budget = 4;        ///< [ms] of computing per frame
  double frame = 1.0 / 60;  ///< [s] simulated per frame
  std::string backend = "auto";
  std::int64_t least_nodes = 300;                    ///< of the coarsest lattice tried
  std::int64_t most_nodes = 10000;                   ///< of the finest
  std::int64_t reference_nodes = 12000;              ///< of the reference lattice (hex8full, static solver)
  double reference_seconds = 60;                     ///< that finer references may take
  std::function<void(const std::string&)> progress;  ///< a part begins
  std::function<void(const std::string&)> detail;    ///< how far it is
};

struct Plan {
  nlohmann::ordered_json report;  ///< docs/schema/plan.json
  std::string text;               ///< the same for people
  Scene scene;                    ///< the choice, or the nearest one to the tolerance
  bool found = false;
};

/// Throws Error for a scene that it cannot plan: more than one body, a volume mesh, a tool that is followed, no load.
Plan plan_scene(const Scene& scene, const PlanOptions& options);

}  // namespace pliant
