// Random springs between nodes of the body of a random scene.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/common/dice.h"

namespace pliant::bench {

/// Adds `springs` to the body of one mesh in five: some 10 to 200 of one law between nodes that are within 0.3 `extent` [m] of
/// each other, some of them shorter at rest. `young`: of the tissue [Pa].
void add_random_springs(Dice dice, const std::filesystem::path& mesh, double young, double extent,
                        nlohmann::ordered_json& body);

}  // namespace pliant::bench
