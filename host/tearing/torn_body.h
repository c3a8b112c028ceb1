// A body of tetrahedra that tears along its faces where its stress breaks it, without a blade: the physical criterion alone.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "model/body_mesh.h"
#include "tearing/breaking.h"
#include "tearing/method.h"

namespace pliant {

class TornBody {
 public:
  /// `whole` is a volume mesh of tetrahedra; `material` of each, of which those without toughness do not tear.
  TornBody(std::shared_ptr<const BodyMesh> whole, std::vector<Material> material);

  /// Faces that break with the nodes of solid() at `x` [m]. At a node the mean stress of its tetrahedra, weighted by volume, is
  /// looked at. Where its cutting stress reaches the least toughness there, the node's tetrahedra are divided by the plane
  /// across the largest principal stress, and the faces at the node between both sides break whose toughness (the lesser of
  /// both sides') is reached. Nodes are taken by how far they are beyond their toughness; those that share a tetrahedron with
  /// one that has just been taken wait for the next look.
  [[nodiscard]] std::vector<TetFace> breaking_faces(const std::vector<Vec3d>& x) const;

  /// Break faces. Returns, for each node now, the node before.
  std::vector<std::int32_t> tear(const std::vector<TetFace>& faces);

  /// The body now. Elements keep their numbers, and so do nodes and vertices of the surface that were there at first; triangles
  /// of tears follow those of the surface and count as cut.
  [[nodiscard]] const BodyMesh& solid() const { return torn_; }
  /// All broken faces, [tetrahedra] bit f.
  [[nodiscard]] const std::vector<std::uint8_t>& broken() const { return broken_; }

 private:
  struct Peak {
    double excess;  ///< cutting stress over toughness
    std::int32_t node;
    Eigen::Vector3d normal;
    double stress;  ///< largest principal [Pa]
  };
  [[nodiscard]] double strength(std::int32_t tet) const;
  [[nodiscard]] std::vector<Peak> peaks(const std::vector<Vec3d>& x) const;
  void make_surface();

  std::shared_ptr<const BodyMesh> whole_;
  std::vector<Material> material_;
  std::vector<std::array<TetFace, 4>> neighbors_;
  std::vector<TetFace> outside_;  ///< of each triangle of the whole surface
  std::vector<std::uint8_t> broken_;
  BodyMesh torn_;
};

}  // namespace pliant
