// The step of shape matching: what its stiffness allows, and how many steps of the finite elements it spans.
#pragma once
#include "model/model.h"

namespace pliant {

/// Returns E b / alpha [Pa s^2], to which the modulus of a batch is proportional.
[[nodiscard]] double stiffness_unit(const FlsmBatch& batch);

/// Returns b of a step `h` [s] for the damping rate `damping` [1/s]: the displacement per acceleration in a step [s^2].
[[nodiscard]] double step_square(double h, double damping);

/// Returns the largest alpha for which shape matching is stable, with a margin: omega^2 H^2 = alpha times its highest mode,
/// below 4.
[[nodiscard]] double largest_alpha(const FlsmBatch& batch);

/// Returns the step of shape matching H at which alpha reaches that limit, the longest that a "stiffness" allows [s]; infinity
/// without one.
[[nodiscard]] double longest_matching_step(const FlsmBatch& batch, double damping);

/// Returns true if goals at the interface of a batch are extrapolated between steps of shape matching.
[[nodiscard]] bool extrapolates(const FlsmBatch& batch);

/// Returns the step of shape matching that an automatic step allows [s]: less than the longest one where goals are
/// extrapolated, which feed energy to an interface near it (docs/stability.md).
[[nodiscard]] double automatic_matching_step(const FlsmBatch& batch, double damping, bool extrapolated);

/// Returns the least damping of the material [1/s] that keeps extrapolated goals quiet at a step `h` of shape matching [s].
[[nodiscard]] double least_damping(double h);

/// Chooses the substeps of hybrids with `"substeps": "auto"`, the same for all, and extrapolated goals: those of 1 to 8 with
/// which a second of the scene takes the least time by the numbers of elements and regions, the bound of the elements and
/// the automatic step of shape matching. 1 where something acts on shape matching in every step: tools, contact, joins,
/// membranes, vessels and blades that cut by force; where the
/// material is damped less than least_damping(), and with a given beta.
void choose_substeps(const Scene& scene, Model& model);
/// Replaces `"auto"` in the scene by what was chosen for its model.
void take_substeps(const Model& model, Scene& scene);

}  // namespace pliant
