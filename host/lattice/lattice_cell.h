// What one cell of a lattice holds: its material by line sampling, split into the parts that do not touch inside the cell.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/distance.h"

namespace pliant {

/// A cell is probed at 4 x 4 x 4 samples ((x + 0.5) / 4, ...), bit x + 4 y + 16 z, and along the 48 lines through them.
inline constexpr std::uint64_t kAllSamples = ~std::uint64_t{0};

/// Parts with less material than this share of a cell are dropped: they carry no load, and their nodes would have next to no
/// mass. It is also the floor on Cell::fill.
inline constexpr double kFillFloor = 1e-3;

/// One connected piece of material in one cell.
struct CellPart {
  std::array<std::int32_t, 3> index{};
  std::int32_t shell = -1;  ///< a shell of the surface that bounds it inside this cell; -1 if none does
  std::uint64_t mask = 0;   ///< its samples
  /// Per face (2 axis + (1 on the upper side)): the samples of the outer layer from which material reaches the face, bit u + 4
  /// v with u the lower of the two other axes.
  std::array<std::uint16_t, 6> open{};
  bool thin = false;  ///< thinner than the samples are apart: found by its lines only, `mask` holds the nearest samples
  double fill = 1;

  /// A cell that lies entirely inside.
  static CellPart full(const std::array<std::int32_t, 3>& index) {
    return {index, -1, kAllSamples, {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF}, false, 1};
  }
};

/// Position of a sample in its cell, in units of the spacing.
inline Vec3d sample_point(int bit) { return {((bit & 3) + 0.5) / 4, (((bit >> 2) & 3) + 0.5) / 4, ((bit >> 4) + 0.5) / 4}; }

/// Finds the parts of a cell. Two neighbouring samples belong to the same part if no void lies between them, so that even a gap
/// far thinner than a cell separates. Sheets of material thinner than the samples are apart are found by the lines; below about
/// an eighth of the spacing an oblique sheet may lose its connection from cell to cell. Fill is the mean inside length of the
/// 16 lines along the axis that crosses the surface most often: exact for faces along the axes, second order in a quarter of
/// the spacing for smooth ones.
class CellSampler {
 public:
  CellSampler(const SurfaceDistance& surface, const Vec3d& origin, double spacing)
      : surface_(surface), origin_(origin), spacing_(spacing) {}

  /// Append the parts of cell `index` to `parts`.
  void sample(const std::array<std::int32_t, 3>& index, std::vector<CellPart>& parts);
  /// Number of winding-number evaluations, which dominate the cost of cells.
  [[nodiscard]] std::int64_t work() const { return work_; }

 private:
  struct Crossing {
    double at;   // along the line, in units of the spacing
    int jump;    // of the winding number in the direction of the axis
    int merged;  // crossings at the same place (an edge of two triangles)
    std::int32_t shell;
  };

  void cross(std::int32_t triangle);
  void sort_lines();
  void mark_free();
  void classify();
  void walk(int axis, int line);
  bool segment(int axis, int line, int first, int last, int step, double end, int from, int to);
  void collect(const std::array<std::int32_t, 3>& index, std::vector<CellPart>& parts);
  void add_part(const std::array<std::int32_t, 3>& index, std::uint64_t mask, bool thin, int axis,
                std::vector<CellPart>& parts);
  [[nodiscard]] double winding(const Vec3d& local);

  const SurfaceDistance& surface_;
  Vec3d origin_;
  double spacing_;
  Vec3d lower_{};
  std::int64_t work_ = 0;
  bool near_rim_ = false;
  std::vector<std::int32_t> triangles_;
  std::array<std::array<std::vector<Crossing>, 16>, 3> lines_;
  std::array<int, 3> crossings_{};
  std::array<std::uint64_t, 3> free_{};    // bit s: no crossing between s and its upper neighbour along the axis
  std::array<std::uint64_t, 3> linked_{};  // bit s: no void between s and its upper neighbour
  std::array<double, 64> winding_{};
  std::uint64_t inside_ = 0;
  std::array<std::array<double, 64>, 3> length_{};  // inside length around each sample along each axis
  std::array<std::int32_t, 64> shell_{};
  std::array<std::uint16_t, 6> open_{};
};

}  // namespace pliant
