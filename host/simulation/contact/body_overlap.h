// Bodies that begin inside each other.
#pragma once
#include "model/model.h"

namespace pliant {

/// Throws Error (bad_input) where a body begins more than `allowed` [m] inside another one, or in the same place.
void refuse_overlap(const Model& model, double allowed);

}  // namespace pliant
