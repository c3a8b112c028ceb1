// A scene on a backend: advance it, look at it, save and restore it.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backend/backend.h"
#include "model/model.h"
#include "program/program.h"
#include "schedule/build_program.h"
#include "simulation/simulation_state.h"

namespace pliant {

struct Solid;
struct CutState;
struct CutEdit;
struct BladeMove;
class CutTopology;

struct SimulationOptions {
  double dt = 0;                  ///< [s]; 0: what the scene says
  std::int32_t batch_steps = 64;  ///< steps between two looks at the fault flag
  bool stable_step = true;        ///< estimate it at the start (needed when the step is automatic)
};

class Simulation {
 public:
  /// Builds the model, loads the backend and sets the initial state. Throws Error.
  Simulation(Scene scene, std::unique_ptr<Backend> backend, const SimulationOptions& options = {});
  /// The same for a model built already (several backends can share one).
  Simulation(Scene scene, std::shared_ptr<const Model> model, std::unique_ptr<Backend> backend,
             const SimulationOptions& options = {});

  /// Advance by at most `steps`; stops early when diverged or, with dynamic relaxation, at equilibrium. Returns the steps done.
  std::int64_t advance(std::int64_t steps);

  /// One batch in parts, for lockstep: how many steps the next batch may hold, what comes before it and what comes after it.
  [[nodiscard]] std::int32_t next_batch(std::int64_t wanted) const;
  void begin_batch(std::int32_t steps);
  void end_batch(std::int32_t steps);

  [[nodiscard]] const std::optional<Divergence>& divergence() const { return divergence_; }
  [[nodiscard]] bool at_equilibrium() const { return equilibrium_; }
  /// |R - F| over the largest of external and reaction force, at the last look of dynamic relaxation.
  [[nodiscard]] double residual() const { return residual_; }

  [[nodiscard]] std::int64_t step() const { return state_.step; }
  [[nodiscard]] double time() const { return time_at(state_.step); }
  [[nodiscard]] double dt() const { return state_.dt; }
  /// 2 / omega_max of the present configuration, as of the last estimate [s]; 0: none.
  [[nodiscard]] double stable_dt() const { return state_.stable_dt; }
  /// Estimate it now. More iterations make it tighter; it errs on the safe side.
  double estimate_stable_dt(int iterations = 48);

  /// Displacements of a body's nodes in the order of its mesh or lattice [m].
  [[nodiscard]] std::vector<Vec3d> displacements(std::size_t body) const;
  /// Backward-difference velocities (u_n - u_(n-1)) / h [m/s].
  [[nodiscard]] std::vector<Vec3d> velocities(std::size_t body) const;
  /// R - F of the present configuration, without gravity [N]; at fixed nodes minus the reaction.
  [[nodiscard]] std::vector<Vec3d> residual_forces(std::size_t body);
  /// Vertices of the embedded surface of all bodies [m].
  [[nodiscard]] std::vector<Vec3d> surface_positions();

  /// Cut everything that these triangles [m] cross, in present positions. Between two batches of a run (with substeps of shape
  /// matching at the next batch that begins with one of its steps). Throws Error, with nothing changed, for triangles that are
  /// not finite, a body that cannot be cut, or a model that does not fit the device.
  CutReport cut(std::span<const std::array<Vec3d, 3>> triangles);
  /// Do now what the first cut would do once, such as filling the bodies. Throws like cut().
  void prepare_cuts();
  /// Move blades; they cut what they sweep over. A blade's first call only puts it there. Throws like cut().
  CutReport move_blades(std::span<const BladePlace> places);
  CutReport move_blade(const std::string& blade, const std::array<Vec3d, 2>& segment);
  /// Forget where a blade of move_blade is, if there is one: its next call puts it somewhere else.
  void lift_blade(const std::string& blade);
  /// Grows with each edit that changed elements.
  [[nodiscard]] std::int64_t topology_version() const { return topology_version_; }
  /// How a body is cut; nullptr if nothing was prepared to cut it.
  [[nodiscard]] const CutTopology* cut_topology(std::size_t body) const;

  /// Vertices of the embedded surface as the backend holds them, four reals each (the fourth is 0), padded to a multiple of 16
  /// vertices: bytes that read_surface wants. 0 without a surface.
  [[nodiscard]] std::size_t surface_bytes() const;
  void read_surface_into(void* out);

  /// Forces [N] that the host puts on nodes from now on, beside those of the scene; they replace those set before. Only nodes
  /// for which the Model reserved a force (Scene::interactive) can have one: throws Error (state) for others.
  struct HostForce {
    std::size_t body = 0;
    std::int64_t node = 0;
    Vec3d force{};
  };
  void set_forces(std::vector<HostForce> forces);
  /// Put the scene's tool at a point [m] from now on.
  void set_tool(const Vec3d& position) { scene_.tool.path = {{0, position[0], position[1], position[2]}}; }

  /// Hash over the state buffers.
  [[nodiscard]] std::uint64_t hash() const;
  /// Hash over the model as the backend sees it and the scene's solver settings: a checkpoint belongs to one of these.
  [[nodiscard]] std::uint64_t model_hash() const;

  [[nodiscard]] const SimulationState& state() const { return state_; }
  void restore(const SimulationState& state);  // in shape_matching.cpp

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] std::shared_ptr<const Model> shared_model() const { return model_; }
  /// Build the model of a state whose operational regions had moved, before its buffers are written.
  void prepare_restore(const SimulationState& state);
  [[nodiscard]] const Program& program() const { return program_; }
  [[nodiscard]] Backend& backend() const { return *backend_; }

 private:
  void start(const SimulationOptions& options);
  void load_program();
  void install(Program program, const std::function<void()>& complete);
  /// Defined in follow_tool.cpp.
  void follow_tool();
  void move_region(const std::vector<double>& seeds);
  void set_seeds(const std::vector<double>& seeds);
  /// Defined in blades.cpp and cut_model.cpp.
  void prepare_blades(), move_blades();
  CutState& cut_state();
  CutReport run_blades(const std::vector<BladeMove>& moves, std::span<const std::array<Vec3d, 3>> triangles);
  void cut_now(const std::vector<std::map<std::array<std::int32_t, 2>, double>>& edges, std::vector<double> u,
               CutReport& report);
  [[nodiscard]] bool reached(std::size_t body, const std::vector<Vec3d>& x, const std::vector<BladeMove>& moves,
                             std::span<const std::array<Vec3d, 3>> triangles) const;
  [[nodiscard]] std::vector<Vec3d> positions(const std::vector<double>& u, std::size_t body) const;
  friend class ModelSwap;
  void keep_solids();
  void replay_cuts(const std::vector<double>& cuts);
  void limit_to_element_bound();
  void prepare_tears(), tear();  // these and the next two in tear.cpp
  void install_torn(const std::vector<std::vector<std::int32_t>>& from, const std::vector<double>& u);
  void replay_tears(const std::vector<double>& list);
  /// Defined in shape_matching.cpp.
  void choose_dt(double wanted, bool estimate);
  [[nodiscard]] bool has_elements() const;
  [[nodiscard]] double coupled_step(double elements_alone) const;
  [[nodiscard]] double held_goals_step(double elements_alone) const;
  [[nodiscard]] std::vector<double> interface_springs(double dt) const;
  double largest_omega2(const std::vector<double>& spring, int iterations = 48);  // in stable_step.cpp
  double largest_beta(const FlsmBatch& batch, double dt, double bound);
  [[nodiscard]] std::int32_t substeps_of(std::size_t slot) const;
  [[nodiscard]] std::int64_t period() const;  ///< steps of the elements after which all subcycles begin together
  [[nodiscard]] std::int64_t phase() const { return state_.step % period(); }
  /// Whether all subcycles begin in this step, the first such step since a multiple of `every`.
  [[nodiscard]] bool begins_after(std::int64_t step, std::int64_t every) const;
  void upload_shape_matching();
  void set_initial_increment(), upload_params(), upload_decay(), upload_host_forces();
  [[nodiscard]] double decay(std::size_t slot) const;
  void upload_curves(std::int32_t steps);
  void change_dt(double dt);
  [[nodiscard]] bool adapts_at(std::int64_t step) const;
  [[nodiscard]] bool on_grid(std::int64_t step) const;
  void keep_state(), return_to_kept();
  void adapt_dt(), relax();
  [[nodiscard]] double time_at(std::int64_t step) const {
    return state_.origin_time + static_cast<double>(step - state_.origin_step) * state_.dt;
  }
  [[nodiscard]] std::vector<double> forces_now();
  void look_for_fault(std::int64_t batch_start);
  [[nodiscard]] bool retry_smaller();
  [[nodiscard]] std::vector<Vec3d> velocities_from(const std::vector<double>& w, std::size_t body) const;
  [[nodiscard]] std::vector<Vec3d> pick(const std::vector<double>& texels, std::size_t body, double factor) const;

  Scene scene_;
  std::shared_ptr<const std::vector<Solid>> solids_;  ///< the bodies as loaded, once an operational region has moved
  std::shared_ptr<const Model> model_;
  Program program_;
  std::unique_ptr<Backend> backend_;
  SimulationState state_;
  std::int32_t batch_steps_ = 64;
  BufferId u_ = -1, w_ = -1, force_ = -1;
  std::vector<std::pair<BufferId, BufferId>> kept_;  ///< state buffers and their copies at the last good step
  std::vector<char> free_;                           ///< [slots][3] component moves freely
  double elements_dt_ = 0;  ///< the stable step without the springs of an interface [s], as of the last estimate; 0: none
  double first_dt_ = 0;
  bool automatic_ = false;  ///< the step is Pliant's to choose
  double still_ = 0;        ///< increments below this are none [m]
  double fine_ = 0;         ///< displacements below this are rounded to multiples of 2^-22 of it [m], a power of two
  double curves_end_ = 0;
  std::optional<Divergence> divergence_;
  bool equilibrium_ = false;
  double residual_ = 0;
  std::vector<HostForce> host_forces_;
  std::shared_ptr<CutState> cuts_;           ///< once something was prepared to be cut
  std::shared_ptr<struct TearState> tears_;  ///< if a material tears
  std::int64_t topology_version_ = 0;
  std::int64_t blade_steps_ = 0;  ///< steps between two looks at the scene's blades; 0: it has none
};

}  // namespace pliant
