// Warnings about probable unit errors: millimetres, kilopascals or grams per cubic centimetre instead of SI.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"
#include "model/surface_check.h"

namespace pliant {

/// Returns a sentence for each implausible value: bodies larger than 10 m, moduli below 50 Pa, densities outside 100 to 25000
/// kg/m^3, finite elements that their own weight would crush, displacements of several times the body's size. Empty: none.
[[nodiscard]] std::vector<std::string> unit_remarks(const Model& model, const Scene& scene);

/// Returns these and the warnings about the surfaces of all bodies.
[[nodiscard]] std::vector<std::string> model_remarks(const std::vector<SurfaceCheck>& checks, const Model& model,
                                                     const Scene& scene);

}  // namespace pliant
