// Check for bodies that overlap at the start.
#pragma once
#include "model/model.h"

namespace pliant {

/// Throws Error (bad_input) if a body starts more than `allowed` [m] inside another one, or coincides with it.
void refuse_overlap(const Model& model, double allowed);

}  // namespace pliant
