// Whether a run made energy out of nothing.
#pragma once
#include <optional>
#include <string>

#include "cli/run_loop.h"
#include "simulation/simulation.h"

namespace pliant::cli {

/// Looks at the energy of a run with contact now and then. Nothing where work is done that nobody accounts for: by follower
/// pressures, sequences, cuts, tears, edges that part, dynamic relaxation.
class EnergyReport {
 public:
  EnergyReport(Simulation& simulation, const RunLoop& loop);
  /// After every batch.
  void look();
  /// Share of the largest energy; nothing where it cannot be told.
  [[nodiscard]] std::optional<double> created() const;
  /// A sentence where that is more than a hundredth.
  [[nodiscard]] std::optional<std::string> remark() const;

 private:
  Simulation& simulation_;
  const RunLoop& loop_;
  bool accounted_ = false;
  std::int64_t every_ = 0, next_ = 0;  ///< [steps left]
};

}  // namespace pliant::cli
