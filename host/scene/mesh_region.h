// A selection by tags in the body's mesh file: materials, tissues, faces.
#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

/// Kind of objects that an entry of a scene selects.
enum class Selected {
  nodes,      ///< by their places, or by number
  elements,   ///< by their centroids
  triangles,  ///< of the surface, by their centroids
};

/// A region as a scene names it.
struct RegionName {
  std::string name;         ///< of a physical group; empty: the number counts
  std::int64_t number = 0;  ///< the tag
  std::string data;         ///< array of the file; empty: the first of MeshTags::usual_arrays() that it has
  int dimension = 0;        ///< 2: faces, 3: elements, 0: whichever has the tag
};

/// A body's mesh with its tags, shared by all selections of the body. Opened on first use.
class TaggedMesh {
 public:
  /// `scale`, `translate`: those of the body.
  TaggedMesh(std::filesystem::path file, double scale, const Vec3d& translate);
  ~TaggedMesh();
  TaggedMesh(const TaggedMesh&) = delete;
  TaggedMesh& operator=(const TaggedMesh&) = delete;

  struct Content;
  /// Throws Error where the file cannot be read.
  [[nodiscard]] const Content& content() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Returns the indices of its elements with this name, tetrahedra first. Throws Error, which begins with `pointer` and
  /// lists the available names, if there are none.
  [[nodiscard]] const std::vector<double>& values(const std::string& name, const std::string& pointer) const;

 private:
  std::filesystem::path file_;
  double scale_;
  Vec3d translate_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const Content> content_;
};

class MeshRegion {
 public:
  /// `pointer`: of the key, for messages.
  MeshRegion(std::shared_ptr<const TaggedMesh> mesh, RegionName name, Selected of, std::string pointer);
  ~MeshRegion();
  MeshRegion(const MeshRegion&) = delete;
  MeshRegion& operator=(const MeshRegion&) = delete;

  [[nodiscard]] const RegionName& name() const { return name_; }
  /// Returns whether the node, element or triangle with this number at this position [m] (its own or its centroid) is in the
  /// region. For an element region these are the nodes of its elements and their faces on the surface; for a face region the
  /// faces and their nodes. Entities that cuts have renumbered are found by position. Thread-safe. Throws Error if the mesh
  /// has no such region, with the available ones.
  [[nodiscard]] bool contains(const Vec3d& x, std::int64_t index) const;

 private:
  struct Members;
  void find() const;

  std::shared_ptr<const TaggedMesh> mesh_;
  RegionName name_;
  Selected of_;
  std::string pointer_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const Members> members_;
};

}  // namespace pliant
