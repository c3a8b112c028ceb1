// Stiffness of thin cells and of thin copies of cut cells.
#pragma once
#include <vector>

#include "model/elements/body_mesh.h"

namespace pliant {

/// Returns each element's stiffness as a fraction of a full element [elements]; its own fill if `least` is 0. An undivided
/// cell has max(fill, least). The copies of a divided cell share its stiffness: each gets at least `least` of it (or equal
/// parts if that is not enough), the rest in proportion to material. At the first cut of a cell all are
/// deformed alike, and the elastic energy does not change; at a later one copies take stiffness from others that are not.
std::vector<double> stiff_fills(const BodyElements& solid, double least);

}  // namespace pliant
