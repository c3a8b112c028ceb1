// What the program gets of the points of contact, from a body that is held in part.
#include <gtest/gtest.h>

#include <array>

#include "geometry/vec.h"
#include "layout.h"
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

/// A linear field turns the tangents of a point as it turns space: exactly, in lattices and meshes.
TEST(ContactPoints, TangentsFollowALinearField) {
  const std::array<Vec3d, 3> gradient{{{0.1, 0.3, -0.2}, {-0.25, 0.05, 0.15}, {0.2, -0.1, -0.3}}};
  for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
    Scene scene = testing::pressed_cube(0.01, R"("contact": true,)");
    scene.bodies[0].element = element;
    const Loaded loaded(scene);
    const Model& model = loaded.loaded.model();
    for (std::size_t i = 0; i < model.contact->size(); ++i) {
      const ContactTangents t = contact_tangents(*model.contact, i, model.rest);
      Vec3d one = t.t1, two = t.t2, exact_one = t.t1, exact_two = t.t2;
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 3; ++k) {
          exact_one[c] += gradient[c][k] * t.t1[k];
          exact_two[c] += gradient[c][k] * t.t2[k];
        }
        for (std::size_t a = 0; a < 8; ++a) {
          const Vec3d& x = model.rest[static_cast<std::size_t>(model.contact->nodes[i][a])];
          const double u = gradient[c][0] * x[0] + gradient[c][1] * x[1] + gradient[c][2] * x[2];
          one[c] += t.first[a] * u;
          two[c] += t.second[a] * u;
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(one[c], exact_one[c], 1e-9) << "point " << i;
        EXPECT_NEAR(two[c], exact_two[c], 1e-9);
        EXPECT_NEAR(vec::cross(t.t1, t.t2)[c], model.contact->normal[i][c], 1e-9);
      }
    }
  }
}

/// Every tile is in the tree once, below groups that hold it, and a node that is left out leaves out what is below it.
TEST(ContactPoints, TheTreeHoldsEveryTileOnce) {
  for (const double spacing : {0.05, 0.01, 0.0025}) {
    Scene scene = testing::pressed_cube(0.01, R"("contact": true,)");
    scene.bodies[0].lattice.spacing = spacing;
    const Loaded loaded(scene);
    const Program& program = loaded.loaded.program();
    const auto& tree = program.at(program.find("touch_node")).ints;
    const auto tiles = static_cast<std::int32_t>((loaded.loaded.model().contact->size() + 15) / 16);
    const auto nodes = static_cast<std::int32_t>(tree.size() / 4);
    std::vector<int> seen(static_cast<std::size_t>(tiles), 0);
    std::vector<int> boxes(program.at(program.find("touch_box")).count / PLIANT_TOUCH_BOX, 0);
    for (std::int32_t k = 0; k < nodes; ++k) {
      const std::int32_t* node = &tree[static_cast<std::size_t>(4 * k)];
      ASSERT_LT(static_cast<std::size_t>(node[0]), boxes.size());
      ++boxes[static_cast<std::size_t>(node[0])];
      ASSERT_GT(node[1], k);
      ASSERT_LE(node[1], nodes);
      if (node[3] - node[2] == 1) {
        EXPECT_EQ(node[0], node[2]);
        EXPECT_EQ(node[1], k + 1);
        ++seen[static_cast<std::size_t>(node[2])];
        continue;
      }
      std::int32_t next = node[2];  // what is below it covers its tiles, one after the other
      for (std::int32_t below = k + 1; below < node[1]; below = tree[static_cast<std::size_t>(4 * below + 1)]) {
        EXPECT_EQ(tree[static_cast<std::size_t>(4 * below + 2)], next);
        next = tree[static_cast<std::size_t>(4 * below + 3)];
      }
      EXPECT_EQ(next, node[3]);
    }
    for (const int count : seen) EXPECT_EQ(count, 1);
    for (const int count : boxes) EXPECT_LE(count, 1);
  }
}

}  // namespace
}  // namespace pliant
