// Selection of a part of a body.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

class ClosedSurface;
class MeshRegion;

/// A set of nodes selected by rest position [m], by index, or by tags of the mesh file.
struct Selection {
  enum class Kind { all, box, sphere, plane, nodes, surface, region };
  Kind kind = Kind::all;
  Vec3d a{};                                       ///< box: lower corner; sphere: centre; plane: point
  Vec3d b{};                                       ///< box: upper corner; plane: normal (nodes with (X - a).b >= 0 are chosen)
  double radius = 0;                               ///< sphere [m]
  std::vector<std::int64_t> nodes;                 ///< nodes: indices into the body's nodes, ascending (the loader sorts them)
  std::string pointer;                             ///< JSON pointer, for messages ("/bodies/0/fixed/1")
  std::shared_ptr<const ClosedSurface> surface{};  ///< surface: its inside
  std::shared_ptr<const MeshRegion> region{};      ///< region: a tag of the body's mesh file (scene/mesh_region.h)
  /// True if a node with this rest position [m] and body-local index belongs to the set. Bounds are inclusive, with a slack
  /// of 1e-9 of the selection's largest coordinate or radius. Throws Error where a surface cannot be read or is not closed,
  /// and where the mesh has no such region.
  [[nodiscard]] bool contains(const Vec3d& x, std::int64_t index) const;
};

}  // namespace pliant
