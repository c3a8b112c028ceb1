// Treatment of a batch whose result is unreliable: a list of remedies, tried in order.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/edits/topology_edits.h"
#include "simulation/recovery/divergence.h"
#include "simulation/state/run_report.h"
#include "simulation/step/step_control.h"

namespace pliant {

/// Findings on a batch.
struct Symptoms {
  std::int64_t batch_start = 0;  ///< number of steps before the batch
  // From one read of the fault marks:
  std::int32_t lost_in = 0;    ///< the step of the batch, counted from 1, in which the first element was lost; 0: none was lost
  std::int32_t lost = 0;       ///< the fault index of that element; -1: a node that belongs to none
  std::int32_t lost_slot = 0;  ///< of that node
  std::int64_t inverted = 0;   ///< number of elements with J <= 0
  std::int32_t inverted_one = 0;  ///< the lowest of their fault indices
  double increment = 0;           ///< LoadedModel::largest_increment()
  // Set by Recovery::calm_down if no element is lost:
  bool burst = false;                    ///< nodes of an element moved too far relative to each other in one step
  bool outgrown = false;                 ///< the step exceeds the stability limit of the batch's result
  double dt = 0;                         ///< the step to use then [s]
  std::vector<NodeInertia> ballast;      ///< or the ballast to add, if the step is already the shortest allowed
  std::optional<Divergence> divergence;  ///< set if no remedy helped
};

class Recovery {
 public:
  Recovery(RunContext& run, StepControl& step, TopologyEdits& edits, RunReports& reports)
      : run_(run), step_(step), edits_(edits), reports_(reports) {}

  /// Call before a batch. Keeps the current state for rollback if there is none, or if this is a grid step (`on_grid`) and
  /// the state is good.
  void keep(bool on_grid);
  /// Call after a batch that began after `batch_start` steps. Applies remedies so that the run can continue; returns the
  /// divergence if none helps.
  std::optional<Divergence> look(std::int64_t batch_start);

  /// Call once nobody needs the step of the batch any more: the next has a shorter one if look() found the safety gone.
  void shorten();

  /// Returns true if a check of this state would find nothing fast.
  [[nodiscard]] bool quiet() const;

  // The remedies. A return value of true ends the list.
  /// Reduces motion faster than waves. Sufficient unless the batch has burst or outgrown its step.
  bool calm_down(Symptoms& s);
  /// Restores the last good state. Returns false: the following remedies modify that state.
  bool go_back(Symptoms& s);
  /// Reduces the number of substeps of hybrids. A shorter step does not help if elements are driven apart between two steps
  /// of shape matching.
  bool fewer_substeps(Symptoms& s);
  /// Lost or burst: reduces the trust in the estimated stable step, down to a limit.
  bool trust_less(Symptoms& s);
  /// Outgrown at the shortest step that the scene allows: adds inertia to single elements.
  bool add_ballast(Symptoms& s);
  /// Outgrown: uses a step that the result is stable at.
  bool shorter_step(Symptoms& s);
  bool give_up(Symptoms& s);
  using Remedy = bool (Recovery::*)(Symptoms&);
  static constexpr Remedy remedies[] = {&Recovery::calm_down,  &Recovery::go_back,     &Recovery::fewer_substeps,
                                        &Recovery::trust_less, &Recovery::add_ballast, &Recovery::shorter_step,
                                        &Recovery::give_up};

 private:
  [[nodiscard]] Symptoms read(std::int64_t batch_start, std::int32_t step_in_batch) const;
  /// Sets outgrown and dt where springs have stiffened so much that the step is too long for their network.
  void look_at_networks(Symptoms& s) const;
  void find_lost_node(Symptoms& s) const;
  void count_inversions(const Symptoms& s);
  /// Sets outgrown, dt and ballast for a state whose step exceeds its stability limit, or leaves to shorten() what only the
  /// safety forbids.
  void measure(Symptoms& s);
  /// Factor on the limits of motion for the current step: below half the first step the limits are velocities.
  [[nodiscard]] double fast_share() const;
  [[nodiscard]] bool may_trust_less() const;
  void stand_where_placed();
  bool made_again();

  RunContext& run_;
  StepControl& step_;
  TopologyEdits& edits_;
  RunReports& reports_;
  double shorter_ = 0;  ///< step for shorten() [s]; 0: the present one
};

}  // namespace pliant
