#include "geometry/node_grid.h"

#include <algorithm>

namespace pliant {

GridSample interpolate(const NodeGrid& grid, const double* values, const Vec3d& point) {
  GridSample out;
  std::array<std::int32_t, 3> cell{};
  Vec3d s{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double x = (point[a] - grid.origin[a]) / grid.spacing, most = grid.size[a] - 1.0;
    const double inside = std::clamp(x, 0.0, most);
    cell[a] = std::min(static_cast<std::int32_t>(inside), grid.size[a] - 2);
    s[a] = inside - cell[a];
    out.beyond[a] = (x - inside) * grid.spacing;
  }
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Vec3d weight{};
    std::int64_t at = 0, stride = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const bool up = (corner >> a & 1) != 0;
      weight[a] = up ? s[a] : 1 - s[a];
      at += (cell[a] + (up ? 1 : 0)) * stride;
      stride *= grid.size[a];
    }
    const double value = values[at];
    out.value += weight[0] * weight[1] * weight[2] * value;
    for (std::size_t a = 0; a < 3; ++a)
      out.slope[a] += ((corner >> a & 1) != 0 ? value : -value) * weight[(a + 1) % 3] * weight[(a + 2) % 3];
  }
  return out;
}

}  // namespace pliant
