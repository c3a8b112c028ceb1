#include "model/elements/each_element.h"

namespace pliant {

std::array<std::int32_t, 8> brick_cell_corners(const Model& model, std::int32_t slot) {
  const std::int32_t brick = slot / PLIANT_BRICK_NODES, place = slot % PLIANT_BRICK_NODES;
  std::array<std::int32_t, 8> corners{};
  for (int a = 0; a < 8; ++a) {
    const int x = place % 16 + (a & 1), y = place / 16 % 4 + (a >> 1 & 1), z = place / 64 + (a >> 2 & 1);
    const int side = (x == 16 ? 1 : 0) + (y == 4 ? 2 : 0) + (z == 4 ? 4 : 0);
    const std::int32_t owner = model.brick_neighbor[PLIANT_BRICK_NEIGHBORS * brick + side];
    corners[a] = owner * PLIANT_BRICK_NODES + x % 16 + 16 * (y % 4) + 64 * (z % 4);
  }
  return corners;
}

std::vector<double> BrickBatch::record() const { return element_cube_record(kind(), spacing, material, "lattice cell"); }

}  // namespace pliant
