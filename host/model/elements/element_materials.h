// Which material each element of a body has.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace pliant {

struct BodyElements;

struct ElementMaterials {
  std::vector<std::int32_t> index;  ///< [elements] 0: the body's own, i + 1: that of inclusion i
  std::vector<double> modulus;      ///< [elements] over that of this material, in (0, 1]; empty: 1 everywhere
  [[nodiscard]] double modulus_of(std::size_t e) const { return modulus.empty() ? 1 : modulus[e]; }
};

/// The last inclusion that has the centroid of an element wins; Material::young_field says its modulus. Copies of a cut element
/// have the material of the whole one. Throws Error (bad_input) for an inclusion without an element, and for a value that is
/// no modulus.
ElementMaterials element_materials(const Body& body, const BodyElements& solid);

/// The material of that index.
const Material& material_of(const Body& body, std::int32_t index);
/// That of element e, with its own modulus.
Material material_of(const Body& body, const ElementMaterials& materials, std::size_t e);

}  // namespace pliant
