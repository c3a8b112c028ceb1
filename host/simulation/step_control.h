// How long the next step is, where batches end, and what a failed batch is tried again with.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/run_context.h"

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
  /// Elements are inverted, or nodes fast: what to do instead if an automatic step is longer than this state stands, so that
  /// the batch that led here is not to be trusted. `shorten` is then called in the kept state.
  struct Outgrown {
    double dt = 0;                     ///< the step to take [s]; 0: it is the shortest already
    std::vector<NodeInertia> ballast;  ///< what the elements stand it with, then
  };
  [[nodiscard]] std::optional<Outgrown> outgrown();
  void shorten(const Outgrown& found);
  /// An automatic step may have been overtaken by a fast load: take what follows in smaller steps. False when the step is the
  /// user's, or when smaller steps have not helped.
  [[nodiscard]] bool retry_smaller();
  [[nodiscard]] bool can_retry() const;
  [[nodiscard]] bool above_floor() const { return run_.state.clock.dt > least_step(); }

 private:
  [[nodiscard]] bool adapts_at(std::int64_t step) const;
  [[nodiscard]] double share() const;
  /// The shortest automatic step [s].
  [[nodiscard]] double least_step() const;
  /// What an automatic step may be in the present configuration [s], `stiffness` (model/ballast.h) if it had to be looked at
  /// element by element.
  struct Allowed {
    double dt = 0;
    std::vector<double> stiffness;
  };
  [[nodiscard]] Allowed allowed();
  /// Let the elements stand least_step() where they need less, and take back what they need no more; where that is too much of
  /// the mass, a step between `wanted` and that. Returns this step [s].
  double balance(double wanted, const std::vector<double>& stiffness);
  /// The ballast for a step, and whether it is more than a scene may be given.
  [[nodiscard]] std::vector<NodeInertia> ballast_for(double dt, const std::vector<double>& stiffness) const;
  [[nodiscard]] bool too_much(const std::vector<NodeInertia>& ballast) const;
  void change(double dt);
  RunContext& run_;
};

}  // namespace pliant
