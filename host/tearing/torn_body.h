// A body that comes apart along the faces of its elements: tetrahedra, which tear by a stress criterion and a limit on the
// stretch of edges, or hexahedra, which only a blade parts.
#pragma once
#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/elements/body_mesh.h"
#include "tearing/breaking.h"
#include "tearing/method.h"

namespace pliant {

class TornBody {
 public:
  /// `whole` is a volume mesh; `material` of each element, of which those without toughness do not tear.
  TornBody(std::shared_ptr<const BodyMesh> whole, std::vector<Material> material);

  /// Replaces the material of each element.
  void set_materials(std::vector<Material> material) { material_ = std::move(material); }

  struct Breaks {
    std::vector<TetFace> faces;
    std::int64_t edges = 0;  ///< number of overstretched edges that part with these faces
  };
  /// Returns the faces that break with the nodes of solid() at `x` [m]. The criterion uses the volume-weighted mean stress of
  /// the tetrahedra at a node. If its cutting stress reaches the least toughness there, the node's tetrahedra are divided by
  /// the plane normal to the largest principal stress, and faces at the node between both sides break if their toughness (the
  /// lesser of both sides') is reached. Nodes are processed by decreasing excess over their toughness; nodes that share a
  /// tetrahedron with a processed one wait for the next check.
  ///
  /// Before that, edges part that are longer than `stretch` times their length at rest (0: none do) and have an end on a broken
  /// face, and others at kWholeStretch times that, whatever the toughness: the tetrahedra of one end are divided by the plane
  /// across the edge, and all faces between both sides break. It is the end with the larger mean stress along the edge. An edge
  /// that has nothing behind one of its ends is free to spring back there; it parts at its other end at kFreedStretch times.
  [[nodiscard]] Breaks breaking_faces(const std::vector<Vec3d>& x, double stretch = 0) const;

  /// Break faces. Returns, for each node now, the node before.
  std::vector<std::int32_t> tear(const std::vector<TetFace>& faces);
  /// The same where a blade has passed: a face at the end of the cut that cannot come apart yet waits (part_at_faces), until
  /// faces next to it break.
  std::vector<std::int32_t> part(const std::vector<TetFace>& faces);
  /// Faces that wait, [elements] bit f.
  [[nodiscard]] const std::vector<std::uint8_t>& waiting() const { return waiting_; }
  void set_waiting(const std::vector<TetFace>& faces);

  /// The body now. Elements keep their numbers, and so do nodes and vertices of the surface that were there at first; triangles
  /// of tears follow those of the surface and count as cut.
  [[nodiscard]] const BodyMesh& solid() const { return torn_; }
  /// Faces of an element.
  [[nodiscard]] std::size_t faces() const { return whole_->tets.empty() ? 6 : 4; }
  [[nodiscard]] std::span<const int> face_corners(std::size_t face) const;
  /// The face across which another element of the whole body lies; tet -1: none.
  [[nodiscard]] TetFace neighbor(std::int32_t element, std::size_t face) const {
    const auto e = static_cast<std::size_t>(element);
    return whole_->tets.empty() ? hexes_.neighbors[e][face] : tets_.neighbors[e][face];
  }
  /// The whole body, whose nodes keep their numbers.
  [[nodiscard]] const BodyMesh& whole() const { return *whole_; }
  /// All broken faces, [elements] bit f.
  [[nodiscard]] const std::vector<std::uint8_t>& broken() const { return broken_; }

 private:
  /// The mean of the tetrahedra of a node.
  struct NodeStress {
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();  ///< [Pa]
    double volume = 0;                               ///< 0: all are inverted or not finite [m^3]
    double strength = 0;                             ///< the least of them [Pa]
  };
  struct Peak {
    double excess;  ///< cutting stress over toughness
    std::int32_t node;
    Eigen::Vector3d normal;
    double stress;  ///< largest principal [Pa]
  };
  /// Tetrahedra of the smallest piece that a tear makes: those of two triangles of a sheet, or of one cell of a grid.
  static constexpr std::size_t kLeastPiece = 6;
  struct LongEdge {
    double excess;  ///< length over that at rest
    std::array<std::int32_t, 2> ends;
  };
  /// The faces at a node that break on a plane through it. A tetrahedron that has the node `beyond` is on its side.
  struct Plane {
    std::int32_t node, beyond;
    Eigen::Vector3d normal;
    double stress;  ///< infinite: whatever the toughness [Pa]
  };
  using Around = std::vector<std::vector<std::int32_t>>;  ///< tetrahedra of each node

  [[nodiscard]] double strength(std::int32_t tet) const;
  [[nodiscard]] std::vector<NodeStress> node_stresses(const std::vector<Vec3d>& x) const;
  [[nodiscard]] static std::vector<Peak> peaks(const std::vector<NodeStress>& at);
  [[nodiscard]] std::vector<LongEdge> long_edges(const std::vector<Vec3d>& x, double stretch) const;
  [[nodiscard]] std::vector<TetFace> faces_on(const Plane& plane, const std::vector<Vec3d>& x, const Around& around) const;
  /// Tetrahedra that whole faces connect with `tet`, itself first, no more than about kLeastPiece.
  [[nodiscard]] std::vector<std::int32_t> piece_at(std::int32_t tet, const std::vector<std::uint8_t>& broken) const;
  /// The faces without those that would cut off fewer than kLeastPiece tetrahedra: a crumb carries no load, and a
  /// tear goes around it. Marks those that remain in `broken`.
  [[nodiscard]] std::vector<TetFace> without_crumbs(std::vector<TetFace> faces, std::vector<std::uint8_t>& broken) const;
  [[nodiscard]] std::vector<TetFace> parting_faces(const LongEdge& edge, double stretch, const std::vector<Vec3d>& x,
                                                   const std::vector<NodeStress>& at, const Around& around) const;
  std::vector<std::int32_t> open(std::vector<TetFace>* wait);
  /// Sets or clears the bits of both sides of a face.
  void mark(std::vector<std::uint8_t>& bits, const TetFace& face, bool on = true) const;
  void make_surface();

  std::shared_ptr<const BodyMesh> whole_;
  std::vector<Material> material_;
  /// A triangle of the surface as corners of an element.
  struct Corners {
    std::int32_t element = 0;
    std::array<std::int8_t, 3> corner{};
  };
  [[nodiscard]] std::vector<Corners> triangles_of(const TetFace& face) const;

  ElementAdjacency<4> tets_;  ///< of the whole body; one of the two is empty
  ElementAdjacency<8> hexes_;
  std::vector<Corners> outside_;  ///< of each triangle of the whole surface
  std::vector<std::uint8_t> broken_, waiting_;
  BodyMesh torn_;
};

}  // namespace pliant
