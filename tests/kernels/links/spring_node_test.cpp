// spring_node: kernel and twin give the same bits; in double, its sums are those of spring_force for every law, at both ends.
#include <cmath>

#include "kernels/links/random_nodes.h"

namespace pliant::kernel_test {
namespace {

class SpringNode : public TwinTest {};

struct Law {
  int law, slack, viscous;
  [[nodiscard]] Defines defines() const { return {{"LAW", law}, {"SLACK", slack}, {"VISCOUS", viscous}}; }
  [[nodiscard]] bool has_first() const { return law == 1 || law == 2; }
  [[nodiscard]] std::size_t planes() const { return 6 + (has_first() ? 1 : 0) + static_cast<std::size_t>(viscous); }
};

const Reals curve{-0.5, -3, 4, -0.1, -1.4, 14, 0.2, 2.8, 30};

KernelCase spring_node_case(const Law& law, std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  Ints offset{0};
  for (std::size_t tile = 0; tile < count / PLIANT_TILE; ++tile) offset.push_back(offset.back() + random.integer(0, 9));
  const std::size_t entries = (static_cast<std::size_t>(offset.back()) + 1) * PLIANT_TILE, slots = count + 20;
  KernelCase test("spring_node", law.defines(), Shape::lanes, count);
  test.reals("node_load", random.reals(4 * slots, data, 1)).reals("node_u", random.reals(4 * slots, data, 0.1));
  test.reals("node_w", random.reals(4 * slots, data, 1e-4)).ints("spring_node", random_nodes(random, count));
  test.ints("spring_offset", offset).ints("spring_end", random.ints(entries, 0, static_cast<int>(slots) - 1));
  test.reals("spring_data", random.reals(law.planes() * entries, data_for_constants(data), 1)).reals("spring_curve", curve);
  return test.reals("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0}).integer(3).integer(static_cast<int>(law.planes()));
}

TEST_F(SpringNode, TwinGivesTheSameBits) {
  std::uint32_t seed = 4700;
  for (int kind = 0; kind < 8; ++kind) {  // of each law the least and the most
    const Law law{kind / 2, kind & 1, kind & 1};
    for (const std::size_t count : {16U, 80U, 1040U}) {
      for (const Data data : all_data) expect_same_bits(spring_node_case(law, count, data, seed++), name_of(data));
    }
  }
}

/// Numbers of 16 springs from node 0 to the nodes 1 to 16.
struct Star {
  Reals u, w, record[8];  ///< records in the order of spring_force
};

Star random_star(std::uint32_t seed) {
  Random random(seed);
  Star s;
  for (int i = 0; i < 4 * 17; ++i) {
    s.u.push_back(random.uniform(-0.4, 0.4));
    s.w.push_back(random.uniform(-1e-3, 1e-3));
  }
  for (int i = 0; i < 16; ++i) {
    const double d[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.2, 1)}, l = random.uniform(0.5, 1.5);
    const double numbers[] = {d[0],
                              d[1],
                              d[2],
                              l,
                              d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - l * l,
                              random.uniform(-0.3, 0.3),
                              random.uniform(1, 2),
                              random.uniform(0, 3)};
    for (std::size_t k = 0; k < 8; ++k) s.record[k].push_back(numbers[k]);
  }
  return s;
}

/// Forces on the first ends, by spring_force [16][3].
std::vector<Reals> forces_of(const Law& law, const Star& s) {
  Ints ends(32, 0);
  Reals data;
  for (int i = 0; i < 16; ++i) ends[16 + static_cast<std::size_t>(i)] = 1 + i;
  for (const Reals& plane : s.record) data.insert(data.end(), plane.begin(), plane.end());
  KernelCase test("spring_force", law.defines(), Shape::lanes, 16);
  test.exact("link_u", s.u).exact("link_w", s.w).ints("spring_points", ends).exact("spring_data", data);
  test.exact("spring_curve", curve).exact("link_force", Reals(64)).exact("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0});
  const Reals out = run_in_double(test.integer(3).integer(0), "link_force");
  std::vector<Reals> force;
  for (std::size_t i = 0; i < 16; ++i) force.push_back({out[4 * i], out[4 * i + 1], out[4 * i + 2]});
  return force;
}

/// node_load after a step in which node 0 has the 16 springs and each other node has its one; all hold 1 before.
Reals loads_of(const Law& law, const Star& s) {
  // Two tiles of nodes: the first has 16 rows, in which only node 0 has springs from the second row on.
  constexpr std::size_t rows = 17;
  Ints node(64, 0), end(rows * 16, 0);
  Reals data(rows * law.planes() * 16, 0.0);
  const auto put = [&](std::size_t row, std::size_t lane, std::size_t spring, double sign) {
    Reals r;
    for (std::size_t k = 0; k < 5; ++k) r.push_back((k < 3 ? sign : 1) * s.record[k][spring]);
    r.push_back(s.record[6][spring]);
    if (law.has_first()) r.push_back(s.record[5][spring]);
    if (law.viscous > 0) r.push_back(s.record[7][spring]);
    for (std::size_t k = 0; k < r.size(); ++k) data[(row * law.planes() + k) * 16 + lane] = r[k];
    end[row * 16 + lane] = sign > 0 ? static_cast<std::int32_t>(spring) + 1 : 0;
  };
  for (std::size_t lane = 0; lane < 16; ++lane) {
    node[lane] = static_cast<std::int32_t>(lane), node[16 + lane] = 1;
    node[32 + lane] = 16, node[48 + lane] = lane == 0 ? 1 : -1;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t lane = 0; lane < 16; ++lane) {  // padding
      data[(row * law.planes() + 5) * 16 + lane] = 1;
      end[row * 16 + lane] = node[(row < 16 ? 0 : 32) + lane];
    }
  }
  for (std::size_t i = 0; i < 16; ++i) {
    put(i, 0, i, 1);
    if (i < 15) put(0, i + 1, i, -1);
  }
  put(16, 0, 15, -1);
  KernelCase test("spring_node", law.defines(), Shape::lanes, 32);
  test.exact("node_load", Reals(4 * 17, 1.0)).exact("node_u", s.u).exact("node_w", s.w).ints("spring_node", node);
  test.ints("spring_offset", {0, 16, 17}).ints("spring_end", end).exact("spring_data", data).exact("spring_curve", curve);
  return run_in_double(
      test.exact("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0}).integer(3).integer(static_cast<int>(law.planes())), "node_load");
}

TEST(SpringNodeOracle, SumsWhatSpringForceGives) {
  std::uint32_t seed = 4790;
  for (int kind = 0; kind < 16; ++kind) {
    const Law law{kind / 4, kind & 1, kind / 2 & 1};
    const Star star = random_star(seed++);
    const std::vector<Reals> force = forces_of(law, star);
    const Reals load = loads_of(law, star);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 1;
      for (std::size_t i = 0; i < 16; ++i) {
        sum += force[i][c];
        EXPECT_NEAR(load[4 * (i + 1) + c], 1 - force[i][c], 1e-13 * (1 + std::fabs(force[i][c]))) << kind << " spring " << i;
      }
      EXPECT_NEAR(load[c], sum, 1e-12 * (1 + std::fabs(sum))) << kind;
    }
    EXPECT_EQ(load[3], 1);
  }
}

}  // namespace
}  // namespace pliant::kernel_test
