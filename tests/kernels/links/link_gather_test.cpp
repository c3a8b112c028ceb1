// link_gather: kernel and twin give the same bits; in double, forces of links add up at the nodes, and to what other passes
// wrote.
#include "kernels/links/random_nodes.h"

namespace pliant::kernel_test {
namespace {

class LinkGather : public TwinTest {};

KernelCase link_gather_case(std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr int texels = 160;
  Ints offset{0};
  for (std::size_t tile = 0; tile < count / PLIANT_TILE; ++tile) offset.push_back(offset.back() + random.integer(0, 9));
  const std::size_t entries = (static_cast<std::size_t>(offset.back()) + 1) * PLIANT_TILE;
  KernelCase test("link_gather", {}, Shape::lanes, count);
  test.reals("node_load", random.reals(4 * (count + 20), data, 1))
      .ints("link_node", random_nodes(random, count))
      .ints("link_offset", offset);
  test.ints("link_index", random.ints(entries, 0, texels - 1))
      .reals("link_weight", random.reals(entries, data_for_constants(data), 1));
  test.reals("link_force", random.reals(4 * texels, data, 1));
  return test;
}

TEST_F(LinkGather, TwinGivesTheSameBits) {
  std::uint32_t seed = 4300;
  for (const std::size_t count : {16U, 80U, 2064U}) {
    for (const Data data : all_data) expect_same_bits(link_gather_case(count, data, seed++), name_of(data));
  }
}

TEST(LinkGatherOracle, AddsToLoadsOrReplacesThem) {
  Reals force(64, 0.0), weight(32, 0.0);
  force[4 * 3] = 1, force[4 * 3 + 1] = 2, force[4 * 3 + 2] = 4;
  Ints node(32, 0), index(32, 15);
  for (std::size_t l = 3; l < 16; ++l) node[16 + l] = -1;
  node[0] = 1, node[16] = 1;
  node[1] = 2, node[2] = 0;
  index[0] = 3, weight[0] = 1;
  index[1] = 3, weight[1] = -1;
  index[16 + 1] = 3, weight[16 + 1] = 0.25;
  KernelCase test("link_gather", {}, Shape::lanes, 16);
  test.exact("node_load", {9, 9, 9, 9, 10, 20, 30, 9, 9, 9, 9, 9, 9, 9, 9, 9}).ints("link_node", node);
  test.ints("link_offset", {0, 2}).ints("link_index", index).exact("link_weight", weight).exact("link_force", force);
  EXPECT_EQ(run_in_double(test, "node_load"), (Reals{0, 0, 0, 9, 11, 22, 34, 9, -0.75, -1.5, -3, 9, 9, 9, 9, 9}));
}

}  // namespace
}  // namespace pliant::kernel_test
