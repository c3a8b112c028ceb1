// Stiffness of thin cells and of thin copies of cut cells.
#pragma once
#include <vector>

#include "model/elements/body_mesh.h"

namespace pliant {

/// Returns each element's stiffness as a fraction of a full element [elements]; its own fill if `least` is 0. An undivided
/// cell has max(fill, least). The copies of a divided cell share its stiffness: each gets at least `least` of it (or equal
/// parts if that is not enough), the rest in proportion to material. All copies are deformed alike at the time of a cut, so
/// the elastic energy does not change.
std::vector<double> stiff_fills(const BodyElements& solid, double least);

}  // namespace pliant
