// Scenes with tools have no rest to compare: they are compared on the way, at times that are the same for every lattice.
#pragma once
#include <vector>

#include "plan/plan_trial.h"

namespace pliant::planning {

inline constexpr int kSamples = 8;  ///< times of comparison, evenly spaced, the last one at the end

/// From the start to the last moment at which a tool or a load changes, at most the scene's duration [s].
double course_of(const Scene& scene);

/// One run of a scene.
struct Recording {
  std::vector<Vec3d> u;      ///< displacements of the surface's vertices at all times [m]
  std::vector<Vec3d> force;  ///< of all tools at these times [N]
  std::int64_t nodes = 0;
  double spacing = 0, dt = 0, ms_per_step = 0;
  double seconds = 0;  ///< that it took
  std::string remark;  ///< why it ended early
};

/// Runs a scene for so long [s]. `most` [s]: real time after which it is given up.
Recording record(const Scene& scene, double course, double most, const PlanOptions& options);

/// The mean of three lattices of reference_scene, in two fifths of the time that is given. `course` is shortened where even a
/// coarse reference would take longer.
Reference make_moving_reference(const Scene& scene, const Size& size, const PlanOptions& options, double& course);

/// Time and error of a trial, from one run.
void measure_motion(Trial& trial, const Reference& reference, double course, double most, const PlanOptions& options);

}  // namespace pliant::planning
