// How long the next step is, and where batches end.
#pragma once
#include <cstdint>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

class StepControl {
 public:
  explicit StepControl(RunContext& run) : run_(run) {}

  /// The first step. `wanted` [s]: 0 for an automatic one; `estimate`: look for the stable step also if nobody needs it. Throws
  /// Error (bad_input) if there is none, or for a stiffness that the given step does not stand.
  void start(double wanted, bool estimate);
  /// 2 / omega_max of the present configuration into StepLimit::stable_dt [s].
  double estimate(int iterations = 48);

  /// Whether batches end here however a run is cut into pieces: only these states are kept to go back to.
  [[nodiscard]] bool on_grid(std::int64_t step) const;
  /// Steps that the next batch may hold, at most `wanted`.
  [[nodiscard]] std::int32_t next_batch(std::int64_t wanted) const;

  /// Follow the stable step of the deformed body down at once, and up again to the first step once it has recovered by a tenth.
  void adapt();
  /// adapt() where an automatic step is looked at again.
  void adapt_when_due();
  /// An edit has made elements of others: no step beyond what they stand, at rest and as they are deformed now. `changed`
  /// [slots]: whose elements or mass are others.
  void limit_after_edit(const std::vector<char>& changed);

  // What recovery/ needs.
  /// What an automatic step may be in the present configuration [s], `stiffness` (model/nodes/ballast.h) if it had to be looked
  /// at element by element.
  struct Allowed {
    double dt = 0;
    std::vector<double> stiffness;
  };
  [[nodiscard]] Allowed allowed();
  /// The same by the estimate alone [s].
  [[nodiscard]] double estimated();
  /// The ballast for a step, if it is more than there is and not more than a scene may be given; or none.
  [[nodiscard]] std::vector<NodeInertia> more_ballast(double dt, const std::vector<double>& stiffness) const;
  /// The shortest step that the scene wants [s].
  [[nodiscard]] double least_step() const;
  /// From now on, of the same motion.
  void change(double dt);
  /// It does not grow for a while.
  void hold();

 private:
  [[nodiscard]] bool adapts_at(std::int64_t step) const;
  [[nodiscard]] double share() const;
  /// Let the elements stand least_step() where they need less, and take back what they need no more; where that is too much of
  /// the mass, a step between `wanted` and that. Returns this step [s].
  double balance(double wanted, const std::vector<double>& stiffness);
  /// The ballast for a step, and whether it is more than a scene may be given.
  [[nodiscard]] std::vector<NodeInertia> ballast_for(double dt, const std::vector<double>& stiffness) const;
  [[nodiscard]] bool too_much(const std::vector<NodeInertia>& ballast) const;
  RunContext& run_;
};

}  // namespace pliant
