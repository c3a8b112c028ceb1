// Thin cells, and thin copies of cut ones: how stiff they are.
#pragma once
#include <vector>

#include "model/elements/body_mesh.h"

namespace pliant {

/// The share of a full element that each element is as stiff as: [elements], its own fill if `least` is 0. A cell that is not
/// divided is as stiff as max(fill, least). The copies of a divided one share what it was, each getting `least` of it at least
/// (or equal parts, if that is too little), the rest by their material: where a cut is made all copies are deformed alike, so
/// it changes no elastic energy.
std::vector<double> stiff_fills(const BodyElements& solid, double least);

}  // namespace pliant
