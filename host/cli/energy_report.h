// Checks whether a run created energy.
#pragma once
#include <optional>
#include <string>
#include <vector>

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
  /// The work of parting tissue that had come inside other tissue, likewise.
  [[nodiscard]] std::optional<double> parted() const;
  /// Returns a sentence for each of the two that is more than a hundredth.
  [[nodiscard]] std::vector<std::string> remarks() const;

 private:
  Simulation& simulation_;
  const RunLoop& loop_;
  bool accounted_ = false;
  std::int64_t every_ = 0, next_ = 0;  ///< [steps left]
};

}  // namespace pliant::cli
