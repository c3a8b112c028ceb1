// The material of each element of a body.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace pliant {

struct BodyElements;

struct ElementMaterials {
  std::vector<std::int32_t> index;  ///< [elements] 0: the body's own, i + 1: of inclusion i
  std::vector<double> modulus;      ///< [elements] relative to this material, in (0, 1]; empty: 1
  [[nodiscard]] double modulus_of(std::size_t e) const { return modulus.empty() ? 1 : modulus[e]; }
};

/// Assigns materials. If several inclusions contain the centroid of an element, the last one applies; Material::young_field
/// provides moduli. Copies of a cut element keep its material. Throws Error (bad_input) for an inclusion without elements and
/// for an invalid modulus.
ElementMaterials element_materials(const Body& body, const BodyElements& solid);

/// Returns the material with this index.
const Material& material_of(const Body& body, std::int32_t index);
/// Returns the material of element e with the element's modulus.
Material material_of(const Body& body, const ElementMaterials& materials, std::size_t e);

}  // namespace pliant
