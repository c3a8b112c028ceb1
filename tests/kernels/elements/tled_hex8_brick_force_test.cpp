// tled_hex8_brick_force: kernel and twin give the same bits; in double it gives the forces of tled_hex8_force on the same
// cells.
#include "kernels/elements/element_case.h"
#include "kernels/nodes/update_case.h"

namespace pliant::kernel_test {
namespace {

class TledHex8BrickForce : public TwinTest {};

TEST_F(TledHex8BrickForce, TwinGivesTheSameBits) {
  std::uint32_t seed = 500;
  for (const Law law : all_laws()) {
    for (const std::size_t bricks : {1U, 9U}) {
      for (const Data data : all_data) expect_same_bits(brick_force_case(law, bricks, data, seed++), name_of(data));
    }
  }
}

using Grid = BrickGrid;

struct Cells {
  Reals u = Reals(4 * Grid::slots, 0.0), fill = Reals(Grid::slots, 0.0);
};

/// Three of four cells hold material; the last layers have no cell, for their upper nodes lie outside.
Cells random_cells(std::uint32_t seed) {
  Random random(seed);
  Cells cells;
  for (int z = 0; z < Grid::nz; ++z) {
    for (int y = 0; y < Grid::ny; ++y) {
      for (int x = 0; x < Grid::nx; ++x) {
        const auto slot = static_cast<std::size_t>(Grid::slot(x, y, z));
        for (std::size_t c = 0; c < 3; ++c) cells.u[4 * slot + c] = random.uniform(-0.1, 0.1) * edge;
        const bool cell = x + 1 < Grid::nx && y + 1 < Grid::ny && z + 1 < Grid::nz && random.chance(0.75);
        if (cell) cells.fill[slot] = random.uniform(0.1, 1);
      }
    }
  }
  return cells;
}

constexpr double stiffness = 12;

/// All rows of cells and of nodes.
Ints all_rows() { return Ints(18, 0xFFFF); }

/// Nodal forces through the brick kernel and brick_update.
Reals brick_forces(const Cells& cells, Law law, const Ints& rows = all_rows()) {
  KernelCase force("tled_hex8_brick_force", with_law(law), Shape::bricks, 8);
  force.exact("node_u", cells.u)
      .ints("brick_neighbor", Grid::neighbors())
      .ints("brick_rows", rows)
      .exact("brick_fill", cells.fill);
  force.exact("brick_force", Reals(9 * PLIANT_BRICK_FORCE))
      .ints("fault", Ints(Grid::slots))
      .exact("law_parameters", law_data(law));
  force.exact(1 / (4 * edge)).exact(edge * edge / 4).exact(stiffness).integer(1).integer(0).step();
  KernelCase update("brick_update", update_defines(0, 1), Shape::lanes, Grid::slots);
  update.exact("node_u", cells.u).exact("node_w", Reals(4 * Grid::slots)).ints("brick_neighbor", Grid::neighbors());
  update.ints("brick_rows", rows);
  update.exact("brick_force", run_in_double(force, "brick_force")).exact("node_load", Reals(4));
  update.exact("node_force", Reals(4 * Grid::slots)).exact("step_params", step_parameters(0));
  return run_in_double(update, "node_force");
}

/// The same through tled_hex8_force and a plain loop over corners.
Reals element_forces(const Cells& cells, Law law) {
  Reals record;
  const auto sign = [](int a, int axes) {
    double s = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if ((axes >> axis & 1) != 0) s *= (a >> axis & 1) != 0 ? 1 : -1;
    }
    return s;
  };
  for (int a = 0; a < 8; ++a) {
    for (const int axis : {1, 2, 4}) record.push_back(sign(a, axis) / (4 * edge));
  }
  for (const int axes : {3, 5, 6, 7}) {
    for (int a = 0; a < 8; ++a) record.push_back(sign(a, axes));
  }
  record.insert(record.end(), {edge * edge * edge, stiffness});

  std::vector<std::array<std::int32_t, 8>> corners;
  Reals fill;
  for (int z = 0; z + 1 < Grid::nz; ++z) {
    for (int y = 0; y + 1 < Grid::ny; ++y) {
      for (int x = 0; x + 1 < Grid::nx; ++x) {
        const double f = cells.fill[static_cast<std::size_t>(Grid::slot(x, y, z))];
        if (f <= 0) continue;
        fill.push_back(f);
        corners.emplace_back();
        for (int a = 0; a < 8; ++a) {
          corners.back()[static_cast<std::size_t>(a)] = Grid::slot(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2 & 1));
        }
      }
    }
  }
  while (fill.size() % 16 != 0) {
    fill.push_back(0);
    corners.push_back({});
  }
  Ints nodes(8 * fill.size());
  const auto place = [](std::size_t e, std::size_t planes, std::size_t plane) {
    return (e / 16 * planes + plane) * 16 + e % 16;
  };
  for (std::size_t e = 0; e < fill.size(); ++e) {
    for (std::size_t a = 0; a < 8; ++a) nodes[place(e, 8, a)] = corners[e][a];
  }
  KernelCase force("tled_hex8_force", with_law(law, {{"UNIFORM", 1}, {"VISCOUS", 0}}), Shape::lanes, fill.size());
  force.exact("node_u", cells.u).ints("hex_nodes", nodes).exact("hex_data", record).exact("hex_fill", fill);
  force.exact("corner_force", Reals(24 * fill.size())).ints("fault", Ints(fill.size())).exact("law_parameters", law_data(law));
  force.exact("viscosity", Reals(2)).exact("node_w", Reals(4)).exact("step_params", Reals(8, 1));
  force.integer(0).integer(0).step();
  const Reals corner_force = run_in_double(force, "corner_force");
  Reals result(4 * Grid::slots, 0.0);
  for (std::size_t e = 0; e < fill.size(); ++e) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t c = 0; c < 3; ++c) {
        result[4 * static_cast<std::size_t>(corners[e][a]) + c] -= corner_force[place(e, 24, 3 * a + c)];
      }
    }
  }
  return result;
}

TEST(TledHex8BrickForceOracle, GivesTheForcesOfTheHexahedronKernel) {
  const Cells cells = random_cells(11);
  for (const Law law : all_laws()) {
    const Reals bricks = brick_forces(cells, law), elements = element_forces(cells, law);
    double scale = 0, difference = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      scale = std::max(scale, std::fabs(elements[i]));
      difference = std::max(difference, std::fabs(bricks[i] - elements[i]));
    }
    ASSERT_GT(scale, 0);
    EXPECT_LE(difference, 1e-12 * scale) << to_string(law);
  }
}

/// Rows that brick_rows names hold cells, all others do not, whatever their fill.
TEST(TledHex8BrickForceOracle, LeavesOutTheRowsThatHoldNoCell) {
  Random random(12);
  const Cells cells = random_cells(13);
  Cells without = cells;
  Ints rows = all_rows();
  for (int brick = 1; brick < 9; ++brick) {
    const auto b = static_cast<std::size_t>(brick);
    for (std::size_t row = 0; row < 16; ++row) {
      if (random.chance(0.5)) continue;
      rows[2 * b] &= ~(1 << row);
      for (std::size_t x = 0; x < 16; ++x) without.fill[b * PLIANT_BRICK_NODES + 16 * row + x] = 0;
    }
  }
  const Law law = Law::neo_hookean;
  const Reals skipped = brick_forces(cells, law, rows), empty = element_forces(without, law), all = element_forces(cells, law);
  double scale = 0, difference = 0, missing = 0;
  for (std::size_t i = 0; i < empty.size(); ++i) {
    scale = std::max(scale, std::fabs(empty[i]));
    difference = std::max(difference, std::fabs(skipped[i] - empty[i]));
    missing = std::max(missing, std::fabs(all[i] - empty[i]));
  }
  EXPECT_GT(missing, 0.1 * scale);
  EXPECT_LE(difference, 1e-12 * scale);
}

}  // namespace
}  // namespace pliant::kernel_test
