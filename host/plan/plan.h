// pliant plan: the cheapest configuration of a scene that meets an error tolerance within a frame budget, from measurements on
// this device.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.h"

namespace pliant {

struct PlanOptions {
  double tolerance = 0.02;  ///< relative L2 error of the displacements of the surface's vertices
  double budget = 4;        ///< [ms] of computing per frame
  double frame = 1.0 / 60;  ///< [s] simulated per frame
  std::string backend = "auto";
  std::int64_t least_nodes = 300;       ///< of the coarsest lattice tried
  std::int64_t most_nodes = 10000;      ///< of the finest
  std::int64_t reference_nodes = 3000;  ///< of the first reference lattice
  double reference_seconds = 35;        ///< that finer references of a body at rest may take
  double seconds = 60;                  ///< in which all of it should be done; trials for which none is left are skipped
  std::function<void(const std::string&)> progress;  ///< a part begins
  std::function<void(const std::string&)> detail;    ///< how far it is
};

struct Plan {
  nlohmann::ordered_json report;  ///< docs/schema/plan.json
  std::string text;               ///< the same for people
  Scene scene;                    ///< the choice, or the nearest one to the tolerance
  bool found = false;
};

/// A scene without tools is compared at rest, with a static solution; one with tools on the way, with a finer lattice. Throws
/// Error for a scene that it cannot plan: more than one body, a volume mesh, a region that moves, nothing that moves the body.
Plan plan_scene(const Scene& scene, const PlanOptions& options);

}  // namespace pliant
