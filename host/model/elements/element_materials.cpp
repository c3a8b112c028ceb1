#include "model/elements/element_materials.h"

#include <fmt/format.h>

#include <span>

#include "model/elements/body_mesh.h"
#include "model/nodes/whereabouts.h"
#include "pliant/error.h"

namespace pliant {
namespace {

Vec3d centroid(const BodyElements& solid, std::span<const std::int32_t> corners) {
  Vec3d sum{};
  for (const std::int32_t n : corners) {
    for (int c = 0; c < 3; ++c) sum[c] += solid.nodes[n][c] / static_cast<double>(corners.size());
  }
  return sum;
}

/// The element of the uncut mesh that element e equals or is a copy of.
std::size_t uncut(const BodyElements& solid, std::size_t e) {
  if (solid.copy_of.empty()) return e;
  const std::size_t parts = solid.size() / solid.copy_of.size();  // a lattice cell may have six tetrahedra
  return parts * static_cast<std::size_t>(solid.copy_of[e / parts]) + e % parts;
}

double share_of(const YoungField& field, std::size_t element, const std::string& where) {
  const double young = element < field.values.size() ? field.values[element] : 0;
  if (young >= least_modulus && young <= field.largest) return young / field.largest;
  throw Error(ErrorCode::bad_input,
              fmt::format("{}/young: got {:g} Pa of element {} in the field \"{}\", expected a modulus > 0 "
                          "of every element",
                          where, young, element, field.name));
}

}  // namespace

const Material& material_of(const Body& body, std::int32_t index) {
  return index == 0 ? body.material : body.inclusions[index - 1].material;
}

Material material_of(const Body& body, const ElementMaterials& materials, std::size_t e) {
  const Material& material = material_of(body, materials.index[e]);
  return materials.modulus.empty() ? material : material.scaled(materials.modulus[e]);
}

namespace {

ElementMaterials whole_materials(const Body& body, const BodyElements& solid) {
  ElementMaterials out;
  out.index.assign(solid.size(), 0);
  std::vector<char> hit(body.inclusions.size(), false);
  for (std::size_t e = 0; e < solid.size() && !body.inclusions.empty(); ++e) {
    const Vec3d x = centroid(solid, solid.corners(e));
    for (std::size_t i = 0; i < body.inclusions.size(); ++i) {
      if (body.inclusions[i].where.contains(x, static_cast<std::int64_t>(e))) {
        out.index[e] = static_cast<std::int32_t>(i) + 1;
        hit[i] = true;
      }
    }
  }
  for (std::size_t i = 0; i < hit.size(); ++i) {
    if (hit[i]) continue;
    NearestPoint nearest(body.inclusions[i].where);
    for (std::size_t e = 0; e < solid.size(); ++e) nearest.add(centroid(solid, solid.corners(e)));
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: no element has its centre in this inclusion; the body lies between {}{}",
                            body.inclusions[i].where.pointer, corners_text(bounds_of(solid.nodes)), nearest.text("centre")));
  }
  for (std::size_t e = 0; e < solid.size(); ++e) {
    const std::int32_t index = out.index[e];
    const YoungField* field = material_of(body, index).young_field.get();
    if (field == nullptr) continue;
    if (out.modulus.empty()) out.modulus.assign(solid.size(), 1);
    out.modulus[e] =
        share_of(*field, uncut(solid, e),
                 index == 0 ? body.pointer + "/material" : fmt::format("{}/inclusions/{}/material", body.pointer, index - 1));
  }
  return out;
}

}  // namespace

ElementMaterials element_materials(const Body& body, const BodyElements& solid) {
  if (solid.parts.whole == nullptr) return whole_materials(body, solid);
  const ElementMaterials whole = whole_materials(body, *solid.parts.whole);
  ElementMaterials out;
  for (const std::int32_t e : solid.parts.of) {
    out.index.push_back(whole.index[static_cast<std::size_t>(e)]);
    if (!whole.modulus.empty()) out.modulus.push_back(whole.modulus[static_cast<std::size_t>(e)]);
  }
  return out;
}

}  // namespace pliant
