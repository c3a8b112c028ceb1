// Stiffness and stability of shape matching and of its interface with finite elements.
#pragma once
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Returns true if the model has finite elements.
[[nodiscard]] bool has_finite_elements(const Model& model);
/// Returns true if it has forces that limit the step: elements, springs, vessels or membranes.
[[nodiscard]] bool has_elements(const Model& model);

/// Returns the longest automatic step that the "stiffness" of shape matching allows [s]; infinity without one.
[[nodiscard]] double longest_step(const Model& model, const Scene& scene);

/// Returns the stable step including the interface springs [s], given that of the elements alone. This is a bound without an
/// iteration: the spring beta between an interface node and its goal adds at most beta / m to omega^2. With beta = alpha m /
/// H^2 and H = n h: h^2 (omega^2 + alpha / (n h)^2) <= 4. Held goals pull n times as hard in one substep of n, and resonate.
[[nodiscard]] double coupled_step(const Model& model, double elements_alone);

/// Returns the longest stable step with held goals [s]; infinity if no goals are held.
[[nodiscard]] double held_goals_step(const Model& model, double elements_alone);

/// Returns per slot the most that the interface springs add to omega^2 at the step `dt` [s] [1/s^2]; empty without an
/// interface.
[[nodiscard]] std::vector<double> interface_springs(const Model& model, double dt);

/// Throws Error (bad_input), with the allowed values, if a given beta is unstable at the step `dt`. `elements_dt`: stable
/// step of the elements alone [s].
void check_beta(const RunContext& run, double dt, double elements_dt);

/// Returns Young's modulus of shape matching at small strain [Pa] for a step `dt` [s] and a damping rate `damping` [1/s].
[[nodiscard]] double matching_modulus(const FlsmBatch& batch, double dt, double damping);

/// Uploads alpha and beta for the current step. Throws Error (bad_input) for a "stiffness" that no alpha can reach.
void upload_coupling(const RunContext& run);

/// Gives extrapolated goals a past where none was computed: that the nodes were where they are now, `u` [slots][4] [m]. Without
/// it the first line would go through the origin, and pull by a share of the displacement.
void start_goals(const Model& model, const std::vector<double>& u, Program& program);
/// The same for the loaded Program.
void start_goals(const RunContext& run);

}  // namespace pliant
