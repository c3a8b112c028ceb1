// VTK XML output: one unstructured grid per frame (.vtu) and the series over time (.pvd).
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace pliant {

/// A named array with 1, 3 or 6 components for every point or cell: values[i * components + c]. Six are those of a symmetric
/// tensor in the order of VTK: xx, yy, zz, xy, yz, xz.
struct VtuArray {
  std::string name;
  int components = 1;
  std::vector<float> values;
};

/// Content of a .vtu file. Its cells are in the order tetrahedra, quadratic tetrahedra, hexahedra, triangles; `cells` arrays
/// use that order.
struct VtuMesh {
  std::vector<Vec3d> points;  ///< [m]; written as Float32
  std::vector<std::array<std::int32_t, 4>> tets;
  std::vector<std::array<std::int32_t, 10>> quadratic_tets;  ///< corners, then the middles of the edges 01, 12, 02, 03, 13, 23
  std::vector<std::array<std::int32_t, 8>> hexes;            ///< VTK order: bottom face counter-clockwise, then top
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<VtuArray> point_arrays;
  std::vector<VtuArray> cell_arrays;
};

/// Write appended raw binary (little-endian, UInt64 block headers, not compressed); the file appears only when complete.
/// Throws Error when it cannot be written, or (internal) when an array's length or an index does not fit the mesh.
void write_vtu(const std::filesystem::path& file, const VtuMesh& mesh);

/// A .pvd file that grows by one frame at a time. Every append replaces it atomically, so a viewer may open it during the run.
class PvdSeries {
 public:
  explicit PvdSeries(std::filesystem::path file) : file_(std::move(file)) {}
  /// Add a frame [s]; `frame` is written relative to the folder of the .pvd file where possible. Throws Error like AtomicFile.
  void append(double time, const std::filesystem::path& frame);
  [[nodiscard]] std::size_t size() const { return frames_.size(); }

 private:
  std::filesystem::path file_;
  std::vector<std::pair<double, std::string>> frames_;
};

}  // namespace pliant
