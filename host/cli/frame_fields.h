// Values of elements and vertices in the files of frames, as `run --fields` selects them.
#pragma once
#include <string>
#include <vector>

#include "io/vtu.h"
#include "scene/keys.h"
#include "simulation/simulation.h"

namespace pliant::cli {

enum class FrameField { mises, stress, green_strain, almansi_strain, energy, pressure, model };
const Words<FrameField>& field_words();

/// Words of --fields, each once. Throws Error that lists the fields there are.
std::vector<FrameField> parse_fields(const std::vector<std::string>& words);

/// Of every element at its centre, in double, tetrahedra of all bodies first, as the cells of a file come. Nothing for a field
/// that only the surface has.
std::vector<VtuArray> element_fields(const Simulation& simulation, const std::vector<FrameField>& fields);

/// Of every vertex of the surface (vertex_values, vertex_kinds). Nothing for a field that only elements have.
std::vector<VtuArray> vertex_fields(const Simulation& simulation, const std::vector<FrameField>& fields);

}  // namespace pliant::cli
