// Remarks on a scene before its first step.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"

namespace pliant {

/// Returns one sentence for each finding at the step `dt` [s]: shape matching whose stiffness is far from the material's or
/// too low for the body's own weight, and elements with hourglass control far from parallelepipeds. Empty: none.
[[nodiscard]] std::vector<std::string> remarks_on(const Model& model, const Scene& scene, double dt);

}  // namespace pliant
