// Random springs between nodes of the body of a random scene.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/common/dice.h"
#include "geometry/vec3.h"

namespace pliant::bench {

/// Adds `springs` to the body of one mesh in five: some 10 to 200 of one law between nodes that are within 0.3 `extent` [m] of
/// each other, some of them shorter at rest. `young`: of the tissue [Pa].
void add_random_springs(Dice dice, const std::filesystem::path& mesh, double young, double extent,
                        nlohmann::ordered_json& body);

/// Joins the two bodies of one such scene in three, the second a copy of the first that `offset` [m] moves, by springs between
/// the nodes that are nearest to each other, which may break.
void add_random_joins(Dice dice, const std::filesystem::path& shape, const Vec3d& offset, double young, double extent,
                      nlohmann::ordered_json& scene);

}  // namespace pliant::bench
