// What a user should know before the first step.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"

namespace pliant {

/// A sentence each, at the step `dt` [s]: shape matching whose stiffness is far from that of the material, or too little for
/// the body's own weight; hex8 elements that are far from parallelepipeds. Empty: nothing.
[[nodiscard]] std::vector<std::string> remarks_on(const Model& model, const Scene& scene, double dt);

}  // namespace pliant
