// What the parts of a Simulation share: the scene, what follows from it once, the loaded model, and the state of the run.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "simulation/state/loaded_model.h"
#include "simulation/state/run_state.h"

namespace pliant {

/// Follows from the scene, the options and the backend when a simulation starts, and never changes.
struct RunSettings {
  std::int32_t batch_steps = 64;  ///< most steps between two reads of the fault flag
  bool automatic = false;         ///< the step is Pliant's to choose
  bool tears = false;             ///< a material of the scene has a toughness
  double first_dt = 0;            ///< the step that a run begins with [s]
  std::int64_t blade_steps = 0;   ///< steps between two updates of the scene's blades; 0: it has none
  double curves_end = 0;          ///< from here on all loads are constant [s]
  double increment_floor = 0;     ///< increments below this are none [m]
  double displacement_grid = 0;   ///< displacements below this are rounded to multiples of 2^-22 of it [m], a power of two
};

inline constexpr std::int64_t kTearSteps = 16;   ///< steps between two looks for faces that break
inline constexpr std::int64_t kRelaxEvery = 32;  ///< steps between two changes of dynamic relaxation

/// Steps of the elements per step of shape matching at a slot.
[[nodiscard]] std::int32_t substeps_of(const Model& model, std::size_t slot);

struct RunContext {
  const Scene& scene;
  RunSettings& settings;
  LoadedModel& loaded;
  RunState& state;

  [[nodiscard]] const Model& model() const { return loaded.model(); }
  [[nodiscard]] Backend& backend() const { return loaded.backend(); }

  /// Steps after which all subcycles begin together.
  [[nodiscard]] std::int64_t period() const;
  [[nodiscard]] std::int64_t phase() const { return state.clock.step % period(); }
  /// Whether all subcycles begin in this step, the first such step since a multiple of `every`.
  [[nodiscard]] bool begins_after(std::int64_t step, std::int64_t every) const;

  /// What node_w holds of the damping (IntegratorInfo::decay) for k = c h / 2, c the damping rate of the material at a slot of
  /// `of` plus that of dynamic relaxation.
  [[nodiscard]] double decay(const Model& of, std::size_t slot) const;
  /// h v of every node [m], in texels, v the velocity that the integrator says.
  [[nodiscard]] std::vector<double> increments() const;
  /// Velocities of a body's nodes [m/s] from increments().
  [[nodiscard]] std::vector<Vec3d> velocities(const std::vector<double>& increments, std::size_t body) const;

  /// node_u with what RunState::offset holds: displacements [m], and in the fourth number what node_u has there.
  [[nodiscard]] std::vector<double> u() const;
  /// The reverse: write node_u.
  void write_u(std::vector<double> u) const;
  /// Let the embedded surface and the points of contact begin where RunState::offset says. To be called when that changes, and
  /// when a model was loaded.
  void place_surface() const;
  /// The same for what tools can touch; place_surface() calls it.
  void place_contact() const;

  void upload_params() const;
  /// The curves at the next `steps` steps.
  void upload_curves(std::int32_t steps) const;
  /// Write the decay of every node anew.
  void upload_decay() const;
  /// R - F of the present configuration, without gravity [N], per texel of node_force.
  [[nodiscard]] std::vector<double> forces_now() const;
};

}  // namespace pliant
