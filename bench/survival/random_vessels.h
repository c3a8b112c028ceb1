// Random vessels in the body of a random scene.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/common/dice.h"
#include "geometry/vec.h"

namespace pliant::bench {

/// Whether places in the middle of the box of a shape are inside it.
inline bool has_no_hollows(std::string_view file) { return file == "beam.obj" || file == "cube.obj" || file == "cylinder.obj"; }

/// A row of bars between the centroids of random elements of a `mesh` of tetrahedra, as far as they stay in it, or, without
/// one, between places in the middle of the `box` of a shape without hollows. `young`: of the tissue [Pa].
nlohmann::ordered_json random_vessels(Dice& dice, const std::filesystem::path& mesh, const vec::Box& box, double young);

}  // namespace pliant::bench
