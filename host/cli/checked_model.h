// The Model of a scene, with warnings about its surfaces and figures.
#pragma once
#include <string>
#include <vector>

#include "cli/cli.h"
#include "model/surface_check.h"
#include "model/unit_remarks.h"

namespace pliant::cli {

/// Warnings about all bodies, printed as remarks.
inline std::vector<std::string> tell(const std::vector<SurfaceCheck>& checks, const Model& model, const Scene& scene,
                                     const Common& common) {
  std::vector<std::string> warnings = model_remarks(checks, model, scene);
  for (const std::string& warning : warnings) common.note(warning);
  return warnings;
}

inline Model checked_model(const Scene& scene, const Common& common, std::vector<std::string>& warnings) {
  std::vector<SurfaceCheck> checks;
  Model model = build_model(scene, checks);
  warnings = tell(checks, model, scene, common);
  return model;
}

}  // namespace pliant::cli
