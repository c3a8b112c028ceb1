// Random launches of the element kernels.
#pragma once
#include "kernels/random_data.h"
#include "layout.h"
#include "material/material.h"

namespace pliant::kernel_test {

/// Rest edge [m] of the elements that the random data imitate.
constexpr double edge = 0.01;

struct ElementSizes {
  std::size_t elements, nodes;
};
inline constexpr ElementSizes element_sizes[] = {{16, 16}, {48, 80}, {2064, 528}};

/// Node texels of displacements [m] that suit elements of edge `edge`.
inline Reals displacements(Random& random, std::size_t nodes, Data data) {
  return random.reals(4 * nodes, data, data == Data::large ? 0.6 * edge : edge);
}

/// The define LAW and others.
inline Defines with_law(Law law, Defines others = {}) {
  others.insert(others.begin(), {"LAW", static_cast<int>(law)});
  return others;
}

/// The parameters of a law with moduli of tissue at rest; `low` as in Material.
inline Reals law_data(Law law, double low = low_volume) {
  Material m = make_material(law, Moduli::from_bulk(1000, 50000));
  m.low = low;
  return law_constants(m);
}

/// What the list kernels take last: corner forces from value 32 on, faults from 16 on, the law, and what is viscous.
inline void results(KernelCase& test, Random& random, Law law, std::size_t force_planes, std::size_t elements, Reals node_w,
                    double low = low_volume) {
  test.reals("corner_force", random.reals(32 + force_planes * elements, Data::large, 1))
      .ints("fault", random.faults(elements + 16))
      .reals("law_parameters", law_data(law, low))
      .reals("viscosity", {random.uniform(0, 200), random.uniform(-100, 200)})
      .reals("node_w", std::move(node_w))
      .reals("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0})
      .integer(32)
      .integer(16)
      .step();
}

inline KernelCase tet4_force_case(Law law, int averaged, ElementSizes size, Data data, std::uint32_t seed,
                                  double low = low_volume, int viscous = 0) {
  Random random(seed);
  const Data constants = data_for_constants(data);
  KernelCase test("tled_tet4_force", with_law(law, {{"AVERAGED", averaged}, {"VISCOUS", viscous}}), Shape::lanes,
                  size.elements);
  test.reals("node_u", displacements(random, size.nodes, data))
      .ints("tet_nodes", random.ints(4 * size.elements, 0, static_cast<int>(size.nodes) - 1))
      .reals("tet_data", random.reals(PLIANT_TET_DATA_PLANES * size.elements, constants, 1 / edge))
      .reals("anp_pressure", random.reals(size.nodes, data, 5000));
  results(test, random, law, PLIANT_TET_FORCE_PLANES, size.elements, displacements(random, size.nodes, data), low);
  return test;
}

inline KernelCase tet4_dilation_case(ElementSizes size, Data data, std::uint32_t seed) {
  Random random(seed);
  KernelCase test("tled_tet4_dilation", {}, Shape::lanes, size.elements);
  test.reals("node_u", displacements(random, size.nodes, data))
      .ints("tet_nodes", random.ints(4 * size.elements, 0, static_cast<int>(size.nodes) - 1))
      .reals("tet_data", random.reals(PLIANT_TET_DATA_PLANES * size.elements, data_for_constants(data), 1 / edge))
      .reals("anp_dilation", random.reals(size.elements, Data::large, 1));
  return test;
}

/// `planes`: PLIANT_HEX_DATA_PLANES or PLIANT_HEXFULL_DATA_PLANES.
inline KernelCase hex8_case(const std::string& stem, std::size_t planes, Law law, int uniform, ElementSizes size, Data data,
                            std::uint32_t seed, int viscous = 0) {
  Random random(seed);
  KernelCase test(stem, with_law(law, {{"UNIFORM", uniform}, {"VISCOUS", viscous}}), Shape::lanes, size.elements);
  Reals fill = random.positive(size.elements, 0.01, 1);
  for (double& f : fill) f = random.chance(0.1) ? 0 : f;
  if (data == Data::bits) fill = random.reals(size.elements, data, 1);
  test.reals("node_u", displacements(random, size.nodes, data))
      .ints("hex_nodes", random.ints(8 * size.elements, 0, static_cast<int>(size.nodes) - 1))
      .reals("hex_data", random.reals(planes * (uniform != 0 ? 1 : size.elements), data_for_constants(data), 0.5 / edge))
      .reals("hex_fill", std::move(fill));
  results(test, random, law, PLIANT_HEX_FORCE_PLANES, size.elements, displacements(random, size.nodes, data));
  return test;
}

/// Brick 0 is empty, first_brick is 1; neighbours at random.
inline KernelCase brick_force_case(Law law, std::size_t bricks, Data data, std::uint32_t seed) {
  Random random(seed);
  const std::size_t all = bricks + 1, nodes = all * PLIANT_BRICK_NODES;
  Reals u = displacements(random, nodes, data);
  std::fill_n(u.begin(), 4 * PLIANT_BRICK_NODES, 0.0);
  Reals fill = random.positive(nodes, 0.01, 1);
  for (double& f : fill) f = random.chance(0.2) ? 0 : f;
  if (data == Data::bits) fill = random.reals(nodes, data, 1);
  Ints neighbor = random.ints(all * PLIANT_BRICK_NEIGHBORS, 0, static_cast<int>(bricks));
  for (std::size_t b = 0; b < all; ++b)
    neighbor[b * PLIANT_BRICK_NEIGHBORS] = neighbor[b * PLIANT_BRICK_NEIGHBORS + 8] = static_cast<int>(b);
  KernelCase test("tled_hex8_brick_force", with_law(law), Shape::bricks, bricks);
  test.reals("node_u", std::move(u))
      .ints("brick_neighbor", std::move(neighbor))
      .ints("brick_rows", random.ints(2 * all, 0, 0xFFFF))
      .reals("brick_fill", std::move(fill))
      .reals("brick_force", random.reals(all * PLIANT_BRICK_FORCE, Data::large, 1))
      .ints("fault", random.faults(nodes + 32))
      .reals("law_parameters", law_data(law))
      .real(1 / (4 * edge))
      .real(edge * edge / 4)
      .real(12)
      .integer(1)
      .integer(32)
      .step();
  return test;
}

}  // namespace pliant::kernel_test
