// Energy that nothing put in.
#pragma once
#include <optional>

#include "simulation/simulation.h"

namespace pliant {

/// Once all loads of a scene are constant, its energy (kinetic, of the elements, of gravity and of node forces) less the work
/// of its tools can only fall. Follower pressures and forces of the host are not accounted for.
class EnergyWatch {
 public:
  explicit EnergyWatch(const Scene& scene);
  /// Between two batches, the more often the better. States with inverted elements are passed over: they swing too fast for
  /// what is kinetic between two steps to be known.
  void look(Simulation& s);
  /// The highest rise above an earlier state as a share of the highest kinetic and strain energy, or of the
  /// work; nothing if there was nothing
  /// to look at: shape matching has no energy, a load may change to the end.
  [[nodiscard]] std::optional<double> created() const;

 private:
  double from_ = 0;                   ///< loads are constant from here on [s]
  std::optional<double> least_;       ///< [J]
  double created_ = 0, highest_ = 0;  ///< [J]
};

}  // namespace pliant
