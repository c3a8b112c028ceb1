// The tags of a body's mesh file, listed by `pliant info`.
#pragma once
#include <nlohmann/json.hpp>

#include "cli/cli.h"
#include "scene/scene.h"

namespace pliant::cli {

/// The arrays of numbers that the file of a volume mesh has for its cells: a line each, and the same as JSON; null for a
/// lattice. What a selection takes without "data" is marked. An array of more than a thousand different numbers (cells that are
/// numbered one by one) is only counted.
nlohmann::ordered_json tell_mesh_regions(const Body& body, const Common& common);

}  // namespace pliant::cli
