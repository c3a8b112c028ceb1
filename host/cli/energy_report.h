// Checks whether a run created energy.
#pragma once
#include <optional>
#include <string>

#include "cli/run_loop.h"
#include "simulation/simulation.h"

namespace pliant::cli {

/// Checks the energy of a run with contact periodically. Disabled if there is work that is not accounted for: by follower
/// pressures, sequences, cuts, tears, split edges, dynamic relaxation.
class EnergyReport {
 public:
  EnergyReport(Simulation& simulation, const RunLoop& loop);
  /// Call after every batch.
  void look();
  /// Created energy as a fraction of the largest energy; empty if unknown.
  [[nodiscard]] std::optional<double> created() const;
  /// Returns a sentence if that is more than a hundredth.
  [[nodiscard]] std::optional<std::string> remark() const;

 private:
  Simulation& simulation_;
  const RunLoop& loop_;
  bool accounted_ = false;
  std::int64_t every_ = 0, next_ = 0;  ///< [steps left]
};

}  // namespace pliant::cli
