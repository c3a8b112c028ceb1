// What a scene with materials that tear must and must not have.
#include "scene/parts.h"

namespace pliant {

void check_tearing(const Reader& top, const Scene& scene) {
  if (scene.solver.enabled) return;  // the static solver ignores it
  const std::vector<Reader> bodies = top.at("bodies").items("a list of bodies");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    std::vector<Reader> materials{bodies[i].at("material")};
    if (bodies[i].has("inclusions")) {
      for (const Reader& entry : bodies[i].at("inclusions").items("a list of objects"))
        materials.push_back(entry.at("material"));
    }
    for (const Reader& material : materials) {
      if (!material.has("toughness")) continue;
      const Reader field = material.at("toughness");
      if (cuts_by_force(scene)) continue;  // it is that of the blades, and nothing tears by itself
      const bool splits = element_info(body.element).splits;
      if (body.has_lattice() || !splits)
        field.fail("no toughness here: only tetrahedra of a volume mesh (\"mesh\") or of a sheet (\"thickness\") tear");
      require_integrator(top, scene, &IntegratorInfo::edits, "a material has a toughness");
      if (scene.relaxation.enabled) top.at("relaxation").fail("false, because a material has a toughness");
      if (!scene.blades.empty() && !parts_along_faces(scene))
        top.at("blades").fail(
            "no blades, or blades that cut \"by-force\" or with the method \"separation\", because a material has a toughness");
    }
  }
}

}  // namespace pliant
