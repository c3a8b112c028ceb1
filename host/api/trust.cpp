#include "api/trust.h"

#include <algorithm>
#include <vector>

namespace pliant::api {
namespace {

constexpr double kFast = 0.1;    ///< as quiet(): slower motion is no sign of a step that is too long
constexpr double kFaster = 2.0;  ///< free flight gains less than this in a grid step

}  // namespace

void Trust::look(const Simulation& simulation, bool live) {
  given_ = !live || simulation.divergence() || trusts(simulation);
  if (given_) told_ = live ? simulation.step() : kAll;
}

void Trust::renew() {
  usual_ = 0;
  given_ = true;
  told_ = kAll;
}

std::vector<ForceSample> Trust::told(std::vector<ForceSample> samples) const {
  const std::int64_t last = told_;
  while (!samples.empty() && samples.back().step > last) samples.pop_back();
  return samples;
}

bool Trust::trusts(const Simulation& simulation) {
  const Program& program = simulation.program();
  const BufferId summary = program.find("increment_summary");
  if (summary < 0 || !(simulation.model().shortest > 0)) return true;
  const bool settled = simulation.settled(), quiet = simulation.quiet();
  if (quiet) {
    if (settled) usual_ = 0;
    return true;
  }
  const std::vector<double> most = simulation.backend().read_reals(summary);  // quiet() has set it
  const double increment = *std::max_element(most.begin(), most.end()) / simulation.model().shortest;
  if (settled) usual_ = increment;
  return settled || increment <= std::max(kFast, kFaster * usual_);
}

}  // namespace pliant::api
