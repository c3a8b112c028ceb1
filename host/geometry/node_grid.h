// Regular grids of nodes, and values on them.
#pragma once
#include <array>
#include <cstdint>

#include "geometry/vec3.h"

namespace pliant {

/// A regular grid of nodes, x fastest.
struct NodeGrid {
  Vec3d origin{};                      ///< position of the first node [m]
  double spacing = 0;                  ///< [m]
  std::array<std::int32_t, 3> size{};  ///< number of nodes
  bool operator==(const NodeGrid&) const = default;
  [[nodiscard]] std::int64_t nodes() const { return std::int64_t{size[0]} * size[1] * size[2]; }
};

/// A value between nodes.
struct GridSample {
  double value = 0;
  Vec3d slope{};   ///< change of the value per cell
  Vec3d beyond{};  ///< from the nearest point of the grid, where the sample is taken [m]
};

/// Interpolates the values of the nodes at a point [m], trilinearly.
GridSample interpolate(const NodeGrid& grid, const double* values, const Vec3d& point);

}  // namespace pliant
