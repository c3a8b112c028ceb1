// The parts of `pliant bench cutting`, and what they share.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/cutting/cutting.h"
#include "cutting/blade/blade.h"
#include "simulation/simulation.h"
#include "tearing/method.h"

namespace pliant::bench {

/// Options with nothing left open, and where rows go.
struct CuttingRun {
  CuttingOptions options;
  nlohmann::json& rows;
  std::function<void(const std::string&)> show;                   ///< a measurement begins
  std::function<void(double, const std::string&)> show_progress;  ///< share of the present one
};

/// Times, figures and ms per step of the shipped scenes with blades.
void measure_cut_scenes(const CuttingRun& run);
/// The four methods on the same cuts of the same tetrahedra.
void measure_cut_methods(const CuttingRun& run);
/// The methods of blades on the same stroke through the same running bodies.
void measure_live_methods(const CuttingRun& run);
/// The stable step over random cuts.
void measure_stable_steps(const CuttingRun& run);
/// Random strokes through running bodies under load.
void measure_strokes(const CuttingRun& run);

/// What is compared before and after cuts.
struct BodyFigures {
  std::int64_t elements = 0, nodes = 0;
  double mass = 0;    ///< [kg]
  double volume = 0;  ///< enclosed by the surface at rest [m^3]
  double dt = 0;      ///< bound of the single elements at rest [s]
  bool closed = false;
};
BodyFigures figures_of(const Model& model);

/// Stages of one cut [s].
struct CutTimes {
  double search = 0, topology = 0, surface = 0, model = 0, upload = 0, step = 0;
  [[nodiscard]] double total() const { return search + topology + surface + model + upload + step; }
};

/// The members that every row has; `times` of cuts that changed something (empty: null).
nlohmann::json cutting_row(const std::string& part, const std::string& scene, const std::string& method,
                           const std::string& element, std::int64_t cuts, const BodyFigures& before, const BodyFigures& after,
                           const std::vector<CutTimes>& times);

/// The name of a method of blades in rows and tables.
std::string method_name(BladeMethod method);
/// Median ms of a step [ms].
double ms_per_step(Simulation& simulation, bool quick);

/// What a blade sweeps that goes through all of a box: a plane, or a strip that swings to and fro by `swing` [m].
std::vector<SweepTriangle> plane_sweep(const Vec3d& point, const Vec3d& normal, double reach);
std::vector<SweepTriangle> wavy_sweep(const Vec3d& point, double reach, double swing);

}  // namespace pliant::bench
