// The surface of a body whose vertices are nodes, after an edit that gave it other faces.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <span>

#include "model/elements/body_mesh.h"

namespace pliant {

/// The nodes of a face in an order that does not depend on the side from which it is seen.
std::array<std::int32_t, 3> face_key(std::array<std::int32_t, 3> nodes);

/// The triangles of a surface whose vertices are nodes, by these.
class SurfaceSources {
 public:
  explicit SurfaceSources(const BodyMesh& whole);
  /// -1: the surface has none there. Elements in a lattice of which one cell is two may share a face with both of them.
  [[nodiscard]] std::int32_t at(const std::array<std::int32_t, 3>& nodes) const {
    const auto found = at_.find(face_key(nodes));
    return found == at_.end() ? -1 : found->second;
  }

 private:
  std::map<std::array<std::int32_t, 3>, std::int32_t> at_;
};

/// A triangle of the surface.
struct OuterFace {
  std::array<std::int32_t, 3> nodes{};  ///< counter-clockwise from outside
  std::int32_t source = -1;             ///< triangle of the whole body's surface that it is part of; -1: it lies on a cut
};

/// Gives `solid` the surface of these faces. The vertices of the whole body's surface keep their numbers, also where no
/// triangle has them any more; nodes that come to the surface follow in the order of the faces.
void surface_of_faces(const BodyMesh& whole, std::span<const OuterFace> faces, BodyMesh& solid);

}  // namespace pliant
