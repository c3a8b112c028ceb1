// Stiffness and stability of shape matching and of its interface with finite elements.
#pragma once
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Whether finite elements move anything.
[[nodiscard]] bool has_elements(const Model& model);

/// The longest step of the scene that the "stiffness" of its shape matching allows [s]; infinite without one.
[[nodiscard]] double longest_step(const Model& model, const Scene& scene);

/// The stable step with the springs of the interface [s], from that of the elements alone; a bound without an iteration: the
/// spring beta between an interface node and its goal adds beta / m to omega^2 at most. With beta = alpha m / H^2, H = n h:
/// h^2 (omega^2 + alpha / (n h)^2) <= 4. Held goals pull n times as hard in one substep of n, and resonate.
[[nodiscard]] double coupled_step(const Model& model, double elements_alone);

/// The longest step that held goals stand [s]; infinite without any.
[[nodiscard]] double held_goals_step(const Model& model, double elements_alone);

/// What the springs between interface nodes and their goals add to omega^2 at most, at the step `dt` [s], per slot [1/s^2];
/// empty without an interface.
[[nodiscard]] std::vector<double> interface_springs(const Model& model, double dt);

/// Throws Error (bad_input) with what is allowed for a beta that a given step does not stand. `elements_dt`: the stable step of
/// the elements alone [s].
void check_beta(const RunContext& run, double dt, double elements_dt);

/// Young's modulus that shape matching has at small strain [Pa], at the step `dt` of the scene [s]; `damping` [1/s].
[[nodiscard]] double matching_modulus(const FlsmBatch& batch, double dt, double damping);

/// Write alpha and beta of the present step to the backend. Throws Error (bad_input) for a "stiffness" that no alpha reaches.
void upload_coupling(const RunContext& run);

}  // namespace pliant
