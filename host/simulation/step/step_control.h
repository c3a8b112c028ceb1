// Controls the step size and where batches end.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

class StepControl {
 public:
  explicit StepControl(RunContext& run) : run_(run) {}

  /// Chooses the first step. `wanted` [s]: 0 for an automatic step; `estimate`: estimate the stable step even if it is not
  /// needed. Throws Error (bad_input) if there is no stable step, or if a given beta is unstable at the given step.
  void start(double wanted, bool estimate);
  /// Estimates 2 / omega_max of the current configuration [s] and stores it in StepLimit::stable_dt.
  double estimate(int iterations = 48);

  /// Returns true if batches end at this step however a run is divided. Only states at these steps are kept for rollback.
  [[nodiscard]] bool on_grid(std::int64_t step) const;
  /// Returns the number of steps of the next batch, at most `wanted`.
  [[nodiscard]] std::int32_t next_batch(std::int64_t wanted) const;

  /// Adapts an automatic step to the stable step of the deformed body: reduces it at once, and increases it (at most to the
  /// first step) once the stable step has recovered by a tenth.
  void adapt();
  /// Calls adapt() at the steps where an automatic step is due for a check.
  void adapt_when_due();
  /// Call after an operational region has moved: adapts the step unless it is at its ceiling and a bound of the elements, which
  /// takes a fraction of the time of the estimate, shows that it is stable.
  void adapt_after_move();
  /// Call after a topology edit. Limits the step to the stable step of the new elements, both undeformed and as deformed now.
  /// `changed`: per slot, nonzero if its elements or mass changed.
  void limit_after_edit(const std::vector<char>& changed);

  /// Call after the parameters of the scene have changed: the limits of the step follow the new elements. `before`: step of the
  /// element bound before the change [s].
  void follow_parameters(double before);

  // Used by recovery/.
  /// The largest automatic step in the current configuration [s], and the nodal stiffness (model/nodes/ballast.h) if the
  /// elements had to be evaluated one by one.
  struct Allowed {
    double dt = 0;
    double estimate = 0;  ///< of the stable step, before a bound took its place [s]
    std::vector<double> stiffness;
  };
  [[nodiscard]] Allowed allowed();
  /// The nodal stiffness of all elements, evaluated if it was not.
  const std::vector<double>& full_stiffness(Allowed& now) const;
  /// Returns true if a bound of the elements, which takes less time than the estimate, shows that the present step is stable.
  [[nodiscard]] bool bound_allows() const;
  /// The longest step that networks of springs allow as they are now [s]; infinite without networks.
  [[nodiscard]] double networks_allow() const;
  /// The same from the estimate alone [s].
  [[nodiscard]] double estimated();
  /// Returns the ballast that makes a step of `dt` stable if it exceeds the current ballast and is within the limit;
  /// otherwise empty.
  [[nodiscard]] std::vector<NodeInertia> more_ballast(double dt, const std::vector<double>& stiffness) const;
  /// The scene's lower limit of the step [s].
  [[nodiscard]] double least_step() const;
  /// Changes the step size and preserves the velocities.
  void change(double dt);
  /// Prevents the step from growing for a while.
  void hold();

 private:
  [[noreturn]] void refuse_step() const;
  [[nodiscard]] bool adapts_at(std::int64_t step) const;
  [[nodiscard]] bool changes_at(std::int64_t step) const;
  [[nodiscard]] bool follows() const;
  [[nodiscard]] double share() const;
  [[nodiscard]] bool clearly_allows(const std::vector<char>& changed) const;
  /// Adds ballast so that elements are stable at least_step(), and removes ballast that is no longer needed. If this exceeds
  /// the mass limit, chooses a step between `wanted` and least_step(). Returns the step [s].
  double balance(double wanted, const std::vector<double>& stiffness);
  /// Returns the ballast that makes a step of `dt` stable.
  [[nodiscard]] std::vector<NodeInertia> ballast_for(double dt, const std::vector<double>& stiffness) const;
  [[nodiscard]] bool too_much(const std::vector<NodeInertia>& ballast) const;
  RunContext& run_;
  /// The last estimate and what it is of: several checks of one state share it.
  struct Estimated {
    std::shared_ptr<const Model> model;
    std::vector<double> u;
    std::vector<HostForce> forces;  ///< whose rounding is in differences of forces
    double time = 0;
    int iterations = 0;
    double dt = 0;
  };
  Estimated last_;
  std::size_t stiffest_ = 0;  ///< a slot that probably has the least bound of all; decides nothing but the cost
};

}  // namespace pliant
