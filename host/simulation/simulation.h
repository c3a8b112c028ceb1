// A scene running on a backend: stepping, reading, editing, saving and restoring it.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulation/contact/tool_contact.h"
#include "simulation/edits/blade_press.h"
#include "simulation/edits/parameter_edits.h"
#include "simulation/edits/tool_edits.h"
#include "simulation/edits/topology_edits.h"
#include "simulation/measure/drift.h"
#include "simulation/recovery/recovery.h"
#include "simulation/state/snapshot.h"
#include "simulation/step/host_loads.h"
#include "simulation/step/moment.h"
#include "simulation/step/step_control.h"

namespace pliant {

struct SimulationOptions {
  double dt = 0;                  ///< step size [s]; 0: as in the scene
  std::int32_t batch_steps = 64;  ///< maximum number of steps between two reads of the fault flags
  bool stable_step = true;        ///< estimate the stable step at the start (always done for an automatic step)
  TopologyEdits::Shared like{};   ///< of another simulation of the same scene
};

class Simulation {
 public:
  /// Builds the model, loads it to the backend and sets the initial state. Throws Error.
  Simulation(Scene scene, std::unique_ptr<Backend> backend, const SimulationOptions& options = {});
  /// The same with a model that is already built (several backends can share one).
  Simulation(Scene scene, std::shared_ptr<const Model> model, std::unique_ptr<Backend> backend,
             const SimulationOptions& options = {});
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Performs at most `steps` steps and returns the number done. Stops early at a divergence or, with dynamic relaxation, at
  /// equilibrium. The number is negative or smaller if a batch was rolled back.
  std::int64_t advance(std::int64_t steps);

  /// One batch in parts, for lockstep runs. next_batch() returns how many steps it may have; begin_batch() and end_batch() do
  /// the work before and after the steps.
  [[nodiscard]] std::int32_t next_batch(std::int64_t wanted) const { return step_.next_batch(wanted); }
  void begin_batch(std::int32_t steps);
  void end_batch(std::int32_t steps);
  /// Runs `count` steps of the batch, starting at its step `first`.
  void run_steps(std::int32_t first, std::int32_t count);
  /// Host work before a step of a batch whose passes are run one by one.
  void before_step(std::int32_t step_in_batch) { contact_.before_step(step_in_batch, 1); }

  [[nodiscard]] const std::optional<Divergence>& divergence() const { return divergence_; }
  /// Statistics of the run so far.
  [[nodiscard]] const RunReport& report() const { return reports_.now; }
  /// Once all loads are constant, the energy (kinetic, of elements, gravity and node forces) less the work of tools and of
  /// blades that press can only decrease. This checks it and records the result in RunReport::energy; call it between
  /// batches, as often as practical. Follower pressures and host forces are not accounted for. Scenes with shape matching,
  /// which has no energy, are skipped, and so are states with inverted elements, whose oscillation is too fast to know the
  /// kinetic energy between two steps.
  void watch_energy();
  [[nodiscard]] const ToolContact& contact() const { return contact_; }
  /// The forces on blades that cut by force.
  [[nodiscard]] const BladePress& press() const { return press_; }
  [[nodiscard]] bool at_equilibrium() const { return state_.relaxation.equilibrium; }
  /// |R - F| over the larger of external and reaction force, at the last update of dynamic relaxation.
  [[nodiscard]] double residual() const { return state_.relaxation.residual; }

  /// Returns true if the current state is final. With an automatic step, a batch may be rolled back to the last kept state
  /// until the next grid step is reached; do not output its state before that (see moment()).
  [[nodiscard]] bool settled() const { return !settings_.automatic || step_.on_grid(step()); }
  /// For the last state of a run: continues to the next settled state, then returns to this one. Returns false if a rollback
  /// went behind it.
  bool confirm();
  /// Returns true if nothing moves so fast that the step may prove too long in the next settled state: a cheap reason not to
  /// confirm().
  [[nodiscard]] bool quiet() const { return recovery_.quiet(); }
  /// Returns a copy of the current state, for output once it is settled.
  [[nodiscard]] Moment moment() const;
  /// Calls `look` with an earlier state of the same model, then restores the current one.
  void look_at(const Moment& moment, const std::function<void()>& look);

  [[nodiscard]] std::int64_t step() const { return state_.clock.step; }
  [[nodiscard]] double time() const { return state_.clock.time(); }
  [[nodiscard]] double dt() const { return state_.clock.dt; }
  /// 2 / omega_max of the configuration at the last estimate [s]; 0: no estimate was made.
  [[nodiscard]] double stable_dt() const { return state_.limit.stable_dt; }
  /// Estimates the stable step now. More iterations give a tighter value; errors are on the safe side.
  double estimate_stable_dt(int iterations = 48) { return step_.estimate(iterations); }

  /// Displacements of a body's nodes [m], in the order of its mesh or lattice.
  [[nodiscard]] std::vector<Vec3d> displacements(std::size_t body) const { return loaded_.pick(run_.u(), body, 1); }
  /// Velocities of a body's nodes [m/s], as the integrator defines them: backward differences (u_n - u_(n-1)) / h by default.
  [[nodiscard]] std::vector<Vec3d> velocities(std::size_t body) const;
  /// R - F of the current configuration, without gravity [N]; at fixed nodes this is minus the reaction.
  [[nodiscard]] std::vector<Vec3d> residual_forces(std::size_t body) { return loaded_.pick(run_.forces_now(), body, 1); }
  /// Vertices of the embedded surface of all bodies [m].
  [[nodiscard]] std::vector<Vec3d> surface_positions();
  /// Number of bytes that read_surface_into() writes: the same vertices in the backend's format, four reals each (the fourth
  /// is 0), padded to a multiple of 16 vertices. 0 without a surface.
  [[nodiscard]] std::size_t surface_bytes() const;
  void read_surface_into(void* out);

  /// Cuts everything that these triangles [m] intersect in the current configuration. Call between two batches; with substeps
  /// of shape matching, the cut is deferred to the next batch that begins with a shape-matching step. Throws Error for
  /// non-finite triangles, a body that cannot be cut, or a model that does not fit the device, and then changes nothing.
  CutReport cut(std::span<const SweepTriangle> triangles) { return edits_.cut(triangles); }
  /// Does the one-time work of the first cut now, such as filling the bodies with elements. Throws like cut().
  void prepare_cuts() { edits_.prepare_cuts(); }
  /// Moves blades, which cut the tissue they sweep. The first call for a blade only places it. Throws like cut().
  CutReport move_blades(std::span<const BladePose> poses) { return edits_.move_blades(poses); }
  CutReport move_blade(const std::string& blade, const BladeSegment& segment);
  /// Removes a blade's position, if any: its next move_blade() places it without cutting.
  void lift_blade(const std::string& blade) { edits_.lift_blade(blade); }
  /// TopologyEdits::drive_blade(), drive_speed(), lift_blade_by_force().
  void drive_blade(const std::string& blade, const BladeSegment& to, double seconds) { edits_.drive_blade(blade, to, seconds); }
  [[nodiscard]] double blade_drive_speed() const { return edits_.drive_speed(); }
  void lift_blade_by_force(const std::string& blade) { edits_.lift_blade_by_force(blade); }
  [[nodiscard]] TopologyEdits& edits() { return edits_; }  ///< for edits that are built beside the steps
  /// Number of edits that changed elements.
  [[nodiscard]] std::int64_t topology_version() const { return state_.topology_version; }
  /// Returns where the last cut or tear was, in the current configuration [m]; empty if there was none since the start.
  [[nodiscard]] std::optional<Vec3d> edited_at() const { return edits_.edited_at(); }
  /// Returns the cut topology of a body; nullptr if nothing was prepared for cutting.
  [[nodiscard]] const CutTopology* cut_topology(std::size_t body) const { return edits_.cut_topology(body); }
  /// Elements of a body that are cut in part and still hold together.
  [[nodiscard]] std::int64_t cut_in_part(std::size_t body) const { return edits_.cut_in_part(body); }
  /// TopologyEdits::element_at().
  [[nodiscard]] std::optional<std::int32_t> element_at(std::size_t body, std::int32_t element, const Vec3d& rest) const {
    return edits_.element_at(body, element, rest);
  }

  /// Replaces the forces of the host on nodes; see HostLoads::set.
  void set_forces(std::vector<HostForce> forces) { loads_.set(std::move(forces)); }
  /// For adding, removing, parking, placing and driving tools between two batches.
  [[nodiscard]] ToolEdits& tools() { return tools_; }
  /// Changes parameters of the scene between two batches; see ParameterEdits::change.
  void change(const std::string& change) { parameters_.change(change); }
  /// Sets the motion of a body's nodes between two batches; see set_nodes(). No rollback goes behind it.
  void set_nodes(std::size_t body, const std::vector<Vec3d>& displacements, const std::vector<Vec3d>& velocities);
  /// Moves the focus of the scene to a point [m], where it stays.
  void set_focus(const Vec3d& position) { state_.focus = position; }

  /// Remarks before the first step (remarks.h).
  [[nodiscard]] std::vector<std::string> remarks() const;

  /// The displacements of all nodes and then their increments (node_u, node_w), as the backend stores them.
  [[nodiscard]] std::vector<std::uint8_t> motion() const;
  /// XXH3 of motion().
  [[nodiscard]] std::uint64_t hash() const;
  /// Hash over everything that determines the next steps: model, state buffers and run state.
  [[nodiscard]] std::uint64_t deep_hash() const { return pliant::deep_hash(snapshot()); }
  /// Hash of the model and settings that a snapshot belongs to.
  [[nodiscard]] std::uint64_t model_hash() const;

  [[nodiscard]] Snapshot snapshot() const { return take_snapshot(run_, reports_); }
  /// Continues from a snapshot. Throws Error for a snapshot of another scene, backend or size, or with edits that do not
  /// belong to the scene, and then changes nothing.
  void restore(const Snapshot& snapshot);

  [[nodiscard]] const RunState& state() const { return state_; }
  /// The scene with its present parameters.
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Model& model() const { return loaded_.model(); }
  [[nodiscard]] std::shared_ptr<const Model> shared_model() const { return loaded_.shared_model(); }
  [[nodiscard]] const Program& program() const { return loaded_.program(); }
  /// The Program that computes the embedded surface, an extension of program().
  [[nodiscard]] const Program& surface_program() const { return loaded_.surface(); }
  [[nodiscard]] Backend& backend() const { return loaded_.backend(); }

 private:
  void start(std::shared_ptr<const Model> model, const SimulationOptions& options);
  void load(std::shared_ptr<const Model> model);
  /// Continues from a snapshot whose parameters scene_ has.
  void take_over(const Snapshot& snapshot);

  Scene scene_;           ///< with the present parameters
  RunSettings settings_;  ///< constant once the constructor has returned
  RunState state_;
  RunReports reports_;
  LoadedModel loaded_;
  RunContext run_{scene_, settings_, loaded_, state_};
  StepControl step_{run_};
  Drift drift_{run_};
  HostLoads loads_{run_};
  ToolContact contact_{run_, reports_.now};
  TopologyEdits edits_{run_, step_, loads_, reports_.now};
  BladePress press_{run_, edits_, contact_};
  ToolEdits tools_{run_, contact_};
  ParameterEdits parameters_{scene_, run_, step_, edits_, reports_};
  Recovery recovery_{run_, step_, edits_, reports_};
  std::optional<Divergence> divergence_;  ///< set: no further step is possible
};

}  // namespace pliant
