// brick_update: kernel and twin give the same bits; in double, the sum of what all bricks give to each node of a grid.
#include "kernels/nodes/update_case.h"

namespace pliant::kernel_test {
namespace {

class BrickUpdate : public TwinTest {};

TEST_F(BrickUpdate, TwinGivesTheSameBits) {
  std::uint32_t seed = 700;
  for (int kind = 0; kind < 4 * integrator_count; ++kind) {
    const Defines defines = update_defines(kind & 1, kind >> 1 & 1, all_integrators()[static_cast<std::size_t>(kind / 4)]);
    for (const std::size_t bricks : {1U, 5U}) {
      for (const Data data : all_data) expect_same_bits(brick_update_case(defines, bricks, data, seed++), name_of(data));
    }
  }
}

/// Every brick gives a force to the 17 x 5 x 5 nodes of its cells, of which the last ones of each row, the last rows and the
/// last planes are nodes of the bricks above. Only rows that hold a node take anything.
TEST(BrickUpdateOracle, SumsWhatTheBricksAroundGive) {
  Random random(17);
  Reals force(9 * PLIANT_BRICK_FORCE, 0.0);  // brick 0 is the empty one
  for (std::size_t i = PLIANT_BRICK_FORCE; i < force.size(); ++i) force[i] = random.uniform(-1, 1);
  Ints rows(18, 0);
  for (std::size_t b = 1; b < 9; ++b) rows[2 * b + 1] = random.integer(0, 0xFFFF);
  constexpr double untouched = 99;
  Reals expected(4 * BrickGrid::slots, untouched), sum(4 * BrickGrid::slots, 0.0);
  for (int b = 1; b < 9; ++b) {
    const int bx = (b - 1) % 2, by = (b - 1) / 2 % 2, bz = (b - 1) / 4;
    for (int z = 0; z < 5; ++z) {
      for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 17; ++x) {
          const int gx = 16 * bx + x, gy = 4 * by + y, gz = 4 * bz + z, row = 5 * z + y;
          if (gx >= BrickGrid::nx || gy >= BrickGrid::ny || gz >= BrickGrid::nz) continue;
          for (int c = 0; c < 3; ++c) {
            const int place = x < 16 ? (3 * row + c) * 16 + x : PLIANT_BRICK_FORCE_X16 + 3 * row + c;
            sum[static_cast<std::size_t>(4 * BrickGrid::slot(gx, gy, gz) + c)] +=
                force[static_cast<std::size_t>(b * PLIANT_BRICK_FORCE + place)];
          }
        }
      }
    }
  }
  int taken = 0;
  for (std::size_t slot = 0; slot < BrickGrid::slots; ++slot) {
    const std::size_t brick = slot / PLIANT_BRICK_NODES, row = slot % PLIANT_BRICK_NODES / 16;
    if ((rows[2 * brick + 1] >> row & 1) == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) expected[4 * slot + c] = -sum[4 * slot + c];
    expected[4 * slot + 3] = 0;
    ++taken;
  }
  EXPECT_GT(taken, 500);
  EXPECT_LT(taken, 1500);
  KernelCase test("brick_update", update_defines(0, 1), Shape::lanes, BrickGrid::slots);
  test.exact("node_u", Reals(4 * BrickGrid::slots)).exact("node_w", Reals(4 * BrickGrid::slots));
  test.ints("brick_neighbor", BrickGrid::neighbors()).ints("brick_rows", rows).exact("brick_force", force);
  test.exact("node_load", Reals(4)).exact("node_force", Reals(4 * BrickGrid::slots, untouched));
  test.exact("step_params", step_parameters(0));
  const Reals got = run_in_double(test, "node_force");
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_NEAR(got[i], expected[i], 1e-14) << "slot " << i / 4;
}

}  // namespace
}  // namespace pliant::kernel_test
