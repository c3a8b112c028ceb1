// brick_update: kernel and twin give the same bits. (tled_hex8_brick_force_test checks its sums against element forces.)
#include "update_case.h"

namespace pliant::kernel_test {
namespace {

class BrickUpdate : public TwinTest {};

TEST_F(BrickUpdate, TwinGivesTheSameBits) {
  std::uint32_t seed = 700;
  for (int kind = 0; kind < 8; ++kind) {
    const Defines defines = update_defines(kind & 1, kind >> 1 & 1, kind >> 2 & 1);
    for (const std::size_t bricks : {1U, 5U}) {
      for (const Data data : all_data) expect_same_bits(brick_update_case(defines, bricks, data, seed++), name_of(data));
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
