// What is done about a batch whose result is not to be trusted: one list of remedies, tried in order.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/edits/topology_edits.h"
#include "simulation/recovery/divergence.h"
#include "simulation/state/run_report.h"
#include "simulation/step/step_control.h"

namespace pliant {

/// What a batch left behind.
struct Symptoms {
  std::int64_t batch_start = 0;  ///< steps done before it
  // From the one read of the marks of its elements:
  std::int32_t lost_in = 0;       ///< the step of the batch, from 1, in which an element was lost first; 0: none was
  std::int32_t lost = 0;          ///< that element
  std::int64_t inverted = 0;      ///< elements with J <= 0
  std::int32_t inverted_one = 0;  ///< the lowest of those
  // Found by Recovery::calm_down where nothing is lost:
  bool burst = false;                    ///< nodes of an element moved too far against each other in a step
  bool outgrown = false;                 ///< the step is longer than its own result stands
  double dt = 0;                         ///< the step to take then [s]
  std::vector<NodeInertia> ballast;      ///< what to give the elements instead, if the step is the shortest already
  std::optional<Divergence> divergence;  ///< nothing helped
};

class Recovery {
 public:
  Recovery(RunContext& run, StepControl& step, TopologyEdits& edits, RunReports& reports)
      : run_(run), step_(step), edits_(edits), reports_(reports) {}

  /// Before a batch: keep the present state to go back to if there is none, or if states are kept here (`on_grid`) and it is
  /// good.
  void keep(bool on_grid);
  /// After a batch that began after `batch_start` steps: what to do so that the run can go on. The divergence if nothing is
  /// left.
  std::optional<Divergence> look(std::int64_t batch_start);

  // The remedies. True: the run goes on, or ends, from what this one left.
  /// Takes out motion that is faster than waves. All that a batch needs whose step was short enough.
  bool calm_down(Symptoms& s);
  /// The last good state again. Helps nothing by itself; what follows is done to it.
  bool go_back(Symptoms& s);
  /// Hybrids go on with fewer substeps: what drives elements apart between two of them no shorter step heals.
  bool fewer_substeps(Symptoms& s);
  /// Lost or burst: the estimate of the stable step is trusted less, down to a limit.
  bool trust_less(Symptoms& s);
  /// Outgrown, with the shortest step that the scene wants: inertia for single elements.
  bool add_ballast(Symptoms& s);
  /// Outgrown: a step that the state stood.
  bool shorter_step(Symptoms& s);
  bool give_up(Symptoms& s);
  using Remedy = bool (Recovery::*)(Symptoms&);
  static constexpr Remedy remedies[] = {&Recovery::calm_down,  &Recovery::go_back,     &Recovery::fewer_substeps,
                                        &Recovery::trust_less, &Recovery::add_ballast, &Recovery::shorter_step,
                                        &Recovery::give_up};

 private:
  [[nodiscard]] Symptoms read(std::int64_t batch_start, std::int32_t step_in_batch) const;
  void count_inversions(const Symptoms& s);
  /// Whether there is inertia, or a shorter step, for a state that does not stand its step.
  void measure(Symptoms& s);
  /// What a step of this length takes of the limits of motion: below half the first step they are velocities.
  [[nodiscard]] double fast_share() const;
  [[nodiscard]] bool may_trust_less() const;
  bool made_again();

  RunContext& run_;
  StepControl& step_;
  TopologyEdits& edits_;
  RunReports& reports_;
};

}  // namespace pliant
