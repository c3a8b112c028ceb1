// Which states of a freely running World are shown. Private to host/api and its tests.
#pragma once
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

#include "pliant/live.h"
#include "simulation/simulation.h"

namespace pliant::api {

/// With an automatic step, a step that proves too long is noticed at the end of a grid step (Simulation::settled()), and what
/// came since is taken back. Until then elements burst: their motion grows many times faster than any load lets it.
class Trust {
 public:
  /// Looks at the state between two batches; `live`: the World runs freely. It is not trusted if it may well be taken back: not
  /// settled, and more elements are inverted than in the last settled state, or something moves by more than half an edge
  /// per step and more than twice as fast as anything did there.
  void look(const Simulation& simulation, bool live);
  /// Call after the simulation was replaced: its state is trusted.
  void renew(const Simulation& simulation);
  /// Whether the state of the last look may be shown. For the stepping thread.
  [[nodiscard]] bool given() const { return given_; }
  /// All steps are told from now on, while nobody looks.
  void tell_all() { told_ = kAll; }
  /// The samples of the steps up to the last state that was trusted. For any thread.
  [[nodiscard]] std::vector<ForceSample> told(std::vector<ForceSample> samples) const;

 private:
  static constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
  [[nodiscard]] bool trusts(const Simulation& simulation);

  double usual_ = 0;                 ///< greatest increment of the last settled state, in edges
  std::int64_t usual_inverted_ = 0;  ///< elements that were inverted there
  std::int64_t last_given_ = 0;      ///< number of steps at the last look that trusted
  bool given_ = true;
  std::atomic<std::int64_t> told_{kAll};
};

}  // namespace pliant::api
