// What the program gets of the points of contact, from a body that is held in part.
#include <gtest/gtest.h>

#include <array>

#include "solver/loaded.h"
#include "solver/scenes.h"

namespace pliant {
namespace {

/// Held nodes give their part to the others, so that a point near them is as hard as any other; points on held nodes alone have
/// none to give it to.
TEST(ContactPoints, SharesOfHeldNodesGoToTheOthers) {
  const Loaded loaded(
      testing::pressed_cube(0.01, R"("tools": [{"name": "wall", "shape": {"half_space": [[0, -0.06, 0], [0, 1, 0]]}}],)"));
  const Program& program = loaded.loaded.program();
  const auto& weight = program.at(program.find("contact_weight")).reals;
  const auto& share = program.at(program.find("contact_share")).reals;
  const auto& rest = program.at(program.find("contact_rest")).reals;
  const auto& node = program.at(program.find("contact_node")).ints;
  const Model& model = loaded.loaded.model();
  const std::size_t points = model.contact->size();
  const auto base = [](std::size_t i, std::size_t planes) { return i / 16 * planes * 16 + i % 16; };
  std::vector<double> area(static_cast<std::size_t>(model.slots), 0.0);
  std::vector<char> held(area.size(), 0);
  for (const Constraint& c : model.constraints) held[static_cast<std::size_t>(c.slot)] = static_cast<char>(c.axes == 7);
  const auto each = [&](std::size_t i, const auto& visit) {
    for (std::size_t a = 0; a < 8; ++a) visit(base(i, 8) + 16 * a, static_cast<std::size_t>(node[base(i, 8) + 16 * a]));
  };
  for (std::size_t i = 0; i < points; ++i) {
    each(i, [&](std::size_t at, std::size_t slot) { area[slot] += rest[base(i, 4) + 48] * weight[at]; });
  }
  std::array<int, 3> kinds{};  // no node held, some, all
  for (std::size_t i = 0; i < points; ++i) {
    double whole = 0, given = 0, free = 0, on_held = 0;
    each(i, [&](std::size_t at, std::size_t slot) {
      whole += weight[at] * area[slot];
      given += share[at];
      free += held[slot] != 0 ? 0 : weight[at] * area[slot];
      on_held += held[slot] != 0 ? share[at] : 0;
    });
    EXPECT_EQ(on_held, 0);
    EXPECT_NEAR(given, free > 0 ? whole : 0, 1e-12 * whole) << "point " << i;
    ++kinds[free == whole ? 0 : free > 0 ? 1 : 2];
  }
  for (const int count : kinds) EXPECT_GT(count, 10);
}

}  // namespace
}  // namespace pliant
