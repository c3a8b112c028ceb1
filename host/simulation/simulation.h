// A scene on a backend: advance it, look at it, save and restore it.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulation/contact/tool_contact.h"
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
  double dt = 0;                  ///< [s]; 0: what the scene says
  std::int32_t batch_steps = 64;  ///< most steps between two reads of the fault flag
  bool stable_step = true;        ///< estimate it at the start (needed when the step is automatic)
};

class Simulation {
 public:
  /// Builds the model, loads the backend and sets the initial state. Throws Error.
  Simulation(Scene scene, std::unique_ptr<Backend> backend, const SimulationOptions& options = {});
  /// The same for a model built already (several backends can share one).
  Simulation(Scene scene, std::shared_ptr<const Model> model, std::unique_ptr<Backend> backend,
             const SimulationOptions& options = {});
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Advance by at most `steps`; stops early when diverged or, with dynamic relaxation, at equilibrium. Returns the steps done.
  std::int64_t advance(std::int64_t steps);

  /// One batch in parts, for lockstep: how many steps the next batch may hold, what comes before it and what comes after it.
  [[nodiscard]] std::int32_t next_batch(std::int64_t wanted) const { return step_.next_batch(wanted); }
  void begin_batch(std::int32_t steps);
  void end_batch(std::int32_t steps);
  /// The steps of a batch in between: `count` from step `first` of the batch on.
  void run_steps(std::int32_t first, std::int32_t count);
  /// What the host does before a step of the batch whose passes are run one by one.
  void before_step(std::int32_t step_in_batch) { contact_.before_step(step_in_batch, 1); }

  [[nodiscard]] const std::optional<Divergence>& divergence() const { return divergence_; }
  /// What became of the run so far.
  [[nodiscard]] const RunReport& report() const { return reports_.now; }
  /// Once all loads of a scene are constant, its energy (kinetic, of the elements, of gravity and of node forces) less the work
  /// of its tools can only fall. Notes where it stands in RunReport::energy, to be called between two batches, the more often
  /// the better. Follower pressures and forces of the host are not accounted for; shape matching has no energy, and states with
  /// inverted elements are passed over: they swing too fast for what is kinetic between two steps to be known.
  void watch_energy();
  [[nodiscard]] const ToolContact& contact() const { return contact_; }
  [[nodiscard]] bool at_equilibrium() const { return state_.relaxation.equilibrium; }
  /// |R - F| over the largest of external and reaction force, as of the last change of dynamic relaxation.
  [[nodiscard]] double residual() const { return state_.relaxation.residual; }

  /// Whether the present state stays what it is. Batches that end between two looks at an automatic step may be made again from
  /// the state before them that was kept: until then their states are not to leave as results (moment()).
  [[nodiscard]] bool settled() const { return !settings_.automatic || step_.on_grid(step()); }
  /// For the last state of a run: goes on to where it is settled, and comes back if nothing takes it back. False: the run went
  /// back, to a state before it.
  bool confirm();
  /// The present state, to be looked at when it is settled.
  [[nodiscard]] Moment moment() const;
  /// Call `look` with the simulation in a state of before, of the same model, then go back to the present one.
  void look_at(const Moment& moment, const std::function<void()>& look);

  [[nodiscard]] std::int64_t step() const { return state_.clock.step; }
  [[nodiscard]] double time() const { return state_.clock.time(); }
  [[nodiscard]] double dt() const { return state_.clock.dt; }
  /// 2 / omega_max of the present configuration, as of the last estimate [s]; 0: none.
  [[nodiscard]] double stable_dt() const { return state_.limit.stable_dt; }
  /// Estimate it now. More iterations make it tighter; it errs on the safe side.
  double estimate_stable_dt(int iterations = 48) { return step_.estimate(iterations); }

  /// Displacements of a body's nodes in the order of its mesh or lattice [m].
  [[nodiscard]] std::vector<Vec3d> displacements(std::size_t body) const { return loaded_.pick(run_.u(), body, 1); }
  /// Backward-difference velocities (u_n - u_(n-1)) / h [m/s].
  [[nodiscard]] std::vector<Vec3d> velocities(std::size_t body) const;
  /// R - F of the present configuration, without gravity [N]; at fixed nodes minus the reaction.
  [[nodiscard]] std::vector<Vec3d> residual_forces(std::size_t body) { return loaded_.pick(run_.forces_now(), body, 1); }
  /// Vertices of the embedded surface of all bodies [m].
  [[nodiscard]] std::vector<Vec3d> surface_positions();
  /// The same as the backend holds them, four reals each (the fourth is 0), padded to a multiple of 16 vertices: bytes that
  /// read_surface wants. 0 without a surface.
  [[nodiscard]] std::size_t surface_bytes() const;
  void read_surface_into(void* out);

  /// Cut everything that these triangles [m] cross, in present positions. Between two batches of a run (with substeps of shape
  /// matching at the next batch that begins with one of its steps). Throws Error, with nothing changed, for triangles that are
  /// not finite, a body that cannot be cut, or a model that does not fit the device.
  CutReport cut(std::span<const SweepTriangle> triangles) { return edits_.cut(triangles); }
  /// Do now what the first cut would do once, such as filling the bodies. Throws like cut().
  void prepare_cuts() { edits_.prepare_cuts(); }
  /// Move blades; they cut what they sweep over. A blade's first call only puts it there. Throws like cut().
  CutReport move_blades(std::span<const BladePose> poses) { return edits_.move_blades(poses); }
  CutReport move_blade(const std::string& blade, const BladeSegment& segment);
  /// Forget where a blade of move_blade is, if there is one: its next call puts it somewhere else.
  void lift_blade(const std::string& blade) { edits_.lift_blade(blade); }
  /// Grows with each edit that changed elements.
  [[nodiscard]] std::int64_t topology_version() const { return state_.topology_version; }
  /// How a body is cut; nullptr if nothing was prepared to cut it.
  [[nodiscard]] const CutTopology* cut_topology(std::size_t body) const { return edits_.cut_topology(body); }

  /// Forces that the host puts on nodes from now on: HostLoads::set.
  void set_forces(std::vector<HostForce> forces) { loads_.set(std::move(forces)); }
  /// Add, remove, park, place and drive tools, between two batches.
  [[nodiscard]] ToolEdits& tools() { return tools_; }
  /// Put the scene's tool at a point [m] from now on.
  void set_tool(const Vec3d& position) { state_.tool = position; }

  /// What a user should know before the first step (remarks.h).
  [[nodiscard]] std::vector<std::string> remarks() const;

  /// Hash over node_u and node_w.
  [[nodiscard]] std::uint64_t hash() const;
  /// Hash over everything that decides what comes: model, state buffers and run state.
  [[nodiscard]] std::uint64_t deep_hash() const { return pliant::deep_hash(snapshot()); }
  /// What a snapshot belongs to.
  [[nodiscard]] std::uint64_t model_hash() const;

  [[nodiscard]] Snapshot snapshot() const { return take_snapshot(run_, reports_); }
  /// Go on from there. Throws Error, with nothing changed, for one of another scene, backend or size, or with edits that do not
  /// belong to the scene.
  void restore(const Snapshot& snapshot);

  [[nodiscard]] const RunState& state() const { return state_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Model& model() const { return loaded_.model(); }
  [[nodiscard]] std::shared_ptr<const Model> shared_model() const { return loaded_.shared_model(); }
  [[nodiscard]] const Program& program() const { return loaded_.program(); }
  /// The Program that places the embedded surface, an extension of program().
  [[nodiscard]] const Program& surface_program() const { return loaded_.surface(); }
  [[nodiscard]] Backend& backend() const { return loaded_.backend(); }

 private:
  void start(std::shared_ptr<const Model> model, const SimulationOptions& options);
  void load(std::shared_ptr<const Model> model);
  void set_initial_motion();

  const Scene scene_;
  RunSettings settings_;  ///< fixed when the constructor is done
  RunState state_;
  RunReports reports_;
  LoadedModel loaded_;
  RunContext run_{scene_, settings_, loaded_, state_};
  StepControl step_{run_};
  Drift drift_{run_};
  HostLoads loads_{run_};
  ToolContact contact_{run_, reports_.now};
  TopologyEdits edits_{run_, step_, loads_};
  ToolEdits tools_{run_, contact_};
  Recovery recovery_{run_, step_, edits_, reports_};
  std::optional<Divergence> divergence_;  ///< a run that has diverged has no next step
};

}  // namespace pliant
