#include "api/trust.h"

#include <algorithm>
#include <vector>

namespace pliant::api {
namespace {

constexpr double kFastMotion = 0.5;     ///< light nodes at a rim reach 0.3 where contact pushes them, and nothing bursts
constexpr double kMoreThanUsual = 2.0;  ///< free flight gains less than this in a grid step

/// Greatest increment of a node, in edges of the shortest element.
double fastest(const Simulation& simulation) {
  const BufferId summary = simulation.program().find("increment_summary");
  if (summary < 0 || !(simulation.model().shortest > 0) || simulation.quiet()) return 0;  // quiet() computes the summary
  const std::vector<double> most = simulation.backend().read_reals(summary);
  return *std::max_element(most.begin(), most.end()) / simulation.model().shortest;
}

}  // namespace

void Trust::look(const Simulation& simulation, bool live) {
  given_ = !live || simulation.divergence() || trusts(simulation);
  if (given_) last_given_ = simulation.step();
  told_ = live ? last_given_ : kAll;
}

void Trust::renew(const Simulation& simulation) {
  usual_ = fastest(simulation);
  usual_inverted_ = simulation.report().inversions.last;
  last_given_ = simulation.step();
  given_ = true;
  told_ = kAll;
}

std::vector<ForceSample> Trust::told(std::vector<ForceSample> samples) const {
  const std::int64_t last = told_;
  while (!samples.empty() && samples.back().step > last) samples.pop_back();
  return samples;
}

bool Trust::trusts(const Simulation& simulation) {
  const double now = fastest(simulation);
  const std::int64_t inverted = simulation.report().inversions.last;
  if (simulation.settled()) {
    usual_ = now;
    usual_inverted_ = inverted;
    return true;
  }
  return inverted <= usual_inverted_ && now <= std::max(kFastMotion, kMoreThanUsual * usual_);
}

}  // namespace pliant::api
