#include "model/matching/matching_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pliant {
namespace {

/// Young's modulus of shape matching is E = c rho d^2 alpha / b, with b = H^2 / (1 + D H / 2) for the step H and the damping
/// rate D [1/s]. c, indexed by half-width minus one, is that of a uniaxial pull of bars of any thickness: (w^2 + w) / 3, the
/// variance of a window of 2 w + 1 nodes. Measured by bench/calibrate.py; bending is stiffer if regions are thicker than the
/// body (docs/flsm_stiffness.md).
constexpr double kPullStiffness[] = {2.0 / 3, 2, 4, 20.0 / 3, 10};

constexpr std::int32_t kMostSubsteps = 8;  ///< beyond it shape matching takes hardly any of the time
constexpr double kOverBound = 1.3;         ///< the stable step is usually 1 to 1.6 times the bound of the elements
constexpr double kRegionCost = 3.5;        ///< time of a region of shape matching over that of an element (docs/speed.md)

/// Of the longest step of shape matching with extrapolated goals: beyond it the interface shakes (docs/stability.md).
constexpr double kExtrapolatedShare = 0.5;

/// Extrapolated goals feed a little energy to the interface at that step, too; damping that takes this fraction of the motion
/// in a step of shape matching is more than enough.
constexpr double kLeastDecay = 0.01;

/// Whether a batch leaves its substeps to the program, and may have several.
bool may_have_several(const FlsmBatch& b) {
  return b.settings.substeps == 0 && b.interface > 0 && b.settings.young > 0 && b.settings.beta == 0;
}

/// Of all batches that may.
struct Automatic {
  double single = std::numeric_limits<double>::infinity();   ///< step of shape matching with one substep [s]
  double several = std::numeric_limits<double>::infinity();  ///< with substeps [s]
  double damping = std::numeric_limits<double>::infinity();  ///< least of their materials [1/s]
  double regions = 0;
};

Automatic automatic_batches(const Scene& scene, const Model& model) {
  Automatic all;
  if (scene.contact || !scene.tools.empty() || !model.links.empty() || cuts_by_force(scene)) return all;
  for (const FlsmBatch& b : model.flsm) {
    if (!may_have_several(b)) continue;
    const Material& material = scene.bodies[static_cast<std::size_t>(b.body)].material;
    all.single = std::min(all.single, automatic_matching_step(b, material.damping, false));
    all.several = std::min(all.several, automatic_matching_step(b, material.damping, true));
    all.damping = std::min(all.damping, material.damping);
    all.regions += b.own + b.interface;
  }
  return all;
}

/// Returns the number of substeps with which a second of the scene takes the least time.
std::int32_t fastest(const Automatic& all, const Scene& scene, const Model& model) {
  double elements = 0, best = std::numeric_limits<double>::infinity();
  for (const ModelBody& body : model.bodies) elements += static_cast<double>(body.operational_elements);
  const double step = scene.dt > 0 ? scene.dt : kOverBound * scene.safety * model.element_bound;
  std::int32_t chosen = 1;
  for (std::int32_t n = 1; n <= kMostSubsteps; ++n) {
    if (n > 1 && scene.dt > 0 && n * scene.dt > all.several) break;
    const double dt = std::min(step, n > 1 ? all.several / n : all.single);
    if (n > 1 && all.damping < least_damping(n * dt)) continue;
    const double cost = (elements + kRegionCost * all.regions / n) / dt;
    if (cost < best) {
      best = cost;
      chosen = n;
    }
  }
  return chosen;
}

}  // namespace

double stiffness_unit(const FlsmBatch& batch) {
  return kPullStiffness[batch.settings.width - 1] * batch.density * batch.spacing * batch.spacing;
}

double step_square(double h, double damping) { return h * h / (1 + 0.5 * damping * h); }

double largest_alpha(const FlsmBatch& batch) { return std::min(1.0, 3.8 / batch.stiffest); }

double longest_matching_step(const FlsmBatch& batch, double damping) {
  const double young = batch.settings.young;
  if (young <= 0) return std::numeric_limits<double>::infinity();
  const double b = largest_alpha(batch) * stiffness_unit(batch) / young, quarter = 0.25 * damping * b;
  return quarter + std::sqrt(quarter * quarter + b);
}

bool extrapolates(const FlsmBatch& batch) {
  return batch.settings.extrapolate && batch.settings.substeps > 1 && batch.interface > 0;
}

double automatic_matching_step(const FlsmBatch& batch, double damping, bool extrapolated) {
  return (extrapolated ? kExtrapolatedShare : 1) * longest_matching_step(batch, damping);
}

double least_damping(double h) { return kLeastDecay / h; }

void choose_substeps(const Scene& scene, Model& model) {
  const Automatic all = automatic_batches(scene, model);
  const std::int32_t n = all.regions > 0 ? fastest(all, scene, model) : 1;
  for (FlsmBatch& batch : model.flsm) {
    if (batch.settings.substeps > 0) continue;
    const bool several = n > 1 && may_have_several(batch);
    batch.settings.substeps = several ? n : 1;
    batch.settings.extrapolate = several;
  }
}

void take_substeps(const Model& model, Scene& scene) {
  for (const FlsmBatch& batch : model.flsm) {
    DeformationModel& m = scene.bodies[static_cast<std::size_t>(batch.body)].model;
    if (m.substeps > 0) continue;
    m.substeps = batch.settings.substeps;
    m.extrapolate = batch.settings.extrapolate;
  }
  // A hybrid whose finite elements are the whole body has no shape matching.
  for (Body& body : scene.bodies) body.model.substeps = std::max(body.model.substeps, 1);
}

}  // namespace pliant
