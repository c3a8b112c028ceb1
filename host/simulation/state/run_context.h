// State shared by the parts of a Simulation: scene, settings, loaded model and run state.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "schedule/build_program.h"
#include "simulation/state/loaded_model.h"
#include "simulation/state/run_state.h"

namespace pliant {

/// Derived from the scene, the options and the backend at the start; constant afterwards.
struct RunSettings {
  std::int32_t batch_steps = 64;   ///< maximum number of steps between two reads of the fault flags
  bool automatic = false;          ///< Pliant chooses the step size
  bool tears = false;              ///< a material of the scene has a toughness
  bool breaks = false;             ///< a join of the scene can break
  double first_dt = 0;             ///< initial step size [s]
  std::int32_t force_blades = 0;   ///< blades that cut by force
  std::int32_t blade_samples = 0;  ///< samples of their edges
  double blade_edge = 0;           ///< with such blades: mean edge of an element [m]
  std::int64_t blade_steps = 0;    ///< steps between two updates of the scene's blades; 0: no blades
  double curves_end = 0;           ///< time after which all loads are constant [s]
  double increment_floor = 0;      ///< smaller increments are set to 0 [m]
  double displacement_grid = 0;    ///< smaller displacements are rounded to multiples of 2^-22 of this [m]; a power of two
};

inline constexpr std::int64_t kTearSteps = 16;   ///< steps between two checks for breaking faces and joins
inline constexpr std::int64_t kRelaxEvery = 32;  ///< steps between two updates of dynamic relaxation

/// Returns the number of finite-element steps per shape-matching step at a slot.
[[nodiscard]] std::int32_t substeps_of(const Model& model, std::size_t slot);

struct RunContext {
  const Scene& scene;
  RunSettings& settings;
  LoadedModel& loaded;
  RunState& state;

  [[nodiscard]] const Model& model() const { return loaded.model(); }
  [[nodiscard]] Backend& backend() const { return loaded.backend(); }
  [[nodiscard]] ProgramOptions program_options() const {
    return {scene.integrator, settings.batch_steps, settings.force_blades, settings.blade_samples};
  }

  /// Number of steps after which all subcycles start together.
  [[nodiscard]] std::int64_t period() const;
  [[nodiscard]] std::int64_t phase() const { return state.clock.step % period(); }
  /// Returns true if all subcycles start in this step, and it is the first such step since a multiple of `every`.
  [[nodiscard]] bool begins_after(std::int64_t step, std::int64_t every) const;

  /// Returns true if the time of a step has reached `time` [s], with the present step size.
  [[nodiscard]] bool reached(double time, std::int64_t step) const;
  [[nodiscard]] bool reached(double time) const { return reached(time, state.clock.step); }

  /// Returns the value of node_w for the damping (IntegratorInfo::decay) with k = c h / 2. c is the damping rate of the
  /// material at a slot of `of` plus that of dynamic relaxation.
  [[nodiscard]] double decay(const Model& of, std::size_t slot) const;
  /// Returns h v of every node [m], as texels, with the velocity v as the integrator defines it.
  [[nodiscard]] std::vector<double> increments() const;
  /// Returns the velocities of a body's nodes [m/s] from increments().
  [[nodiscard]] std::vector<Vec3d> velocities(const std::vector<double>& increments, std::size_t body) const;

  /// Returns the displacements [m]: node_u plus RunState::offset. The fourth number of each texel is that of node_u.
  [[nodiscard]] std::vector<double> u() const;
  /// Writes displacements: subtracts RunState::offset and writes node_u.
  void write_u(std::vector<double> u) const;
  /// Uploads the rest positions of the surface and of the contact points, shifted by RunState::offset. Call after the offset
  /// changes or a model is loaded.
  void place_surface() const;
  /// The same for contact points only; place_surface() calls it.
  void place_contact() const;
  void place_held_nodes() const;

  void upload_params() const;
  /// Uploads the curve values of the next `steps` steps.
  void upload_curves(std::int32_t steps) const;
  /// Uploads the decay of every node.
  void upload_decay() const;
  /// Returns R - F of the current configuration, without gravity [N], per texel of node_force.
  [[nodiscard]] std::vector<double> forces_now() const;
};

}  // namespace pliant
