// A block of tetrahedra in any direction, to be cut by a blade that is turned with it.
#pragma once
#include <array>

#include "physics/harness.h"

namespace pliant::physics {

/// Cells of 1 cm, held at its lower side, of E = 20 kPa and this toughness [Pa]; `turn` is applied to all.
inline Scene turned_tetrahedra(const Matrix3d& turn, const std::array<int, 3>& cells, double toughness) {
  const auto turned = [&](const Vec3d& x) { return plain(turn * eigen(x)); };
  Scene scene;
  VolumeMesh mesh = make_mesh({cells, 0.01}, true);
  for (Vec3d& x : mesh.vertices) x = turned(x);
  Body body;
  body.name = "block";
  body.element = ElementKind::tet4;
  body.mesh = save(mesh);
  body.material = material_young(Law::neo_hookean, 2e4, 0.4);
  body.material.toughness = toughness;
  body.material.damping = 60;
  Fixed bottom;
  bottom.where.kind = Selection::Kind::plane;
  bottom.where.a = turned({0, 1e-4, 0});
  bottom.where.b = turned({0, -1, 0});
  body.fixed = {bottom};
  scene.bodies = {body};
  return scene;
}

}  // namespace pliant::physics
