// Where the material at a point is, and where it has carried a point.
#include "cutting/blade/inverse_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cutting/cut_bodies.h"
#include "cutting/cut_body.h"
#include "cutting/cut_scenes.h"

namespace pliant {
namespace {

using namespace cut_test;

vec::Box everywhere() { return {{-1, -1, -1}, {1, 1, 1}}; }

TEST(InverseMap, APointGoesWithTheMaterialAroundItAndLiesBetweenTheSidesOfACut) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
    const BodyMesh uncut = make_body_mesh(box_body("box", {0.03, 0.03, 0.03}, element));
    CutTopology topology(cut_mesh(uncut, "box"));
    const Vec3d on_cut{0.0155, 0.0142, 0.0133}, beside{0.0235, 0.0142, 0.0133};
    InverseMap map(topology, topology.mesh().rest, everywhere(), 0.01, 0.015);
    const MaterialPoint first = map.find(on_cut), second = map.find(beside);
    ASSERT_GE(first.cell, 0);
    EXPECT_LT(vec::norm(vec::sub(first.rest, on_cut)), 1e-12);
    EXPECT_LT(vec::norm(vec::sub(present_position(topology, topology.mesh().rest, first), on_cut)), 1e-12);

    cut_at_rest(topology, wall(0.0155));
    std::vector<std::int32_t> piece;
    ASSERT_EQ(topology.pieces(&piece), 2);
    // Both sides go, unequally; `beside` goes with its own.
    const CutElements& e = topology.elements();
    std::vector<Vec3d> x(e.origin.size());
    const Vec3d left{-0.004, 0.001, 0}, right{0.002, 0, 0.003};
    double left_most = 1;
    std::int32_t left_piece = -1;
    for (std::size_t i = 0; i < e.nodes.size(); ++i) {
      for (int a = 0; a < topology.mesh().shape->corners; ++a) {
        const double at = topology.mesh().rest[e.origin[e.nodes[i][a]]][0];
        if ((e.real[i] >> a & 1) == 0 || at >= left_most) continue;
        left_most = at;
        left_piece = piece[i];
      }
    }
    for (std::size_t i = 0; i < e.nodes.size(); ++i) {
      for (int a = 0; a < topology.mesh().shape->corners; ++a) {
        const std::int32_t n = e.nodes[i][a];
        x[n] = vec::add(topology.mesh().rest[e.origin[n]], piece[i] == left_piece ? left : right);
      }
    }
    const Vec3d middle = vec::add(on_cut, vec::mul(vec::add(left, right), 0.5));
    EXPECT_LT(vec::norm(vec::sub(present_position(topology, x, first), middle)), 1e-12);
    EXPECT_LT(vec::norm(vec::sub(present_position(topology, x, second), vec::add(beside, right))), 1e-12);

    // A place in the gap belongs to the nearest side, at the cut.
    InverseMap moved(topology, x, everywhere(), 0.01, 0.015);
    const MaterialPoint in_gap = moved.find(middle);
    ASSERT_GE(in_gap.cell, 0);
    EXPECT_NEAR(in_gap.rest[0], 0.0155, 2e-5);
    const MaterialPoint inside = moved.find(vec::add(beside, right));
    EXPECT_LT(vec::norm(vec::sub(inside.rest, beside)), 1e-12);
    EXPECT_LT(moved.find({0.5, 0, 0}).cell, 0) << "no material is near";
  }
}

// A node that is not finite takes its elements out of the map, no others.
TEST(InverseMap, ElementsWithoutAPlaceHoldNothing) {
  const BodyMesh uncut = make_body_mesh(box_body("box", {0.03, 0.03, 0.03}));
  const CutTopology topology(cut_mesh(uncut, "box"));
  const Vec3d inside{0.0165, 0.0142, 0.0133};
  const MaterialPoint before = InverseMap(topology, topology.mesh().rest, everywhere(), 0.01, 0.015).find(inside);
  ASSERT_GE(before.cell, 0);
  // A corner of the cell that its tetrahedron around the point does not have.
  const auto& tet = topology.mesh().shape->tets[before.tet];
  int corner = 0;
  while (std::find(tet.begin(), tet.end(), corner) != tet.end()) ++corner;
  std::vector<Vec3d> x = topology.mesh().rest;
  x[topology.mesh().cells[before.cell][corner]][1] = NAN;
  InverseMap map(topology, x, everywhere(), 0.01, 0.015);
  const MaterialPoint after = map.find(inside);
  EXPECT_NE(after.cell, before.cell);
  EXPECT_TRUE(after.cell < 0 || vec::finite(after.rest));
  EXPECT_GE(map.find({0.025, 0.025, 0.025}).cell, 0);
  InverseMap part(topology, topology.mesh().rest, {{0.028, 0.028, 0.028}, {0.029, 0.029, 0.029}}, 0.01, 0.002);
  EXPECT_GE(part.find({0.0285, 0.0285, 0.0285}).cell, 0);
  EXPECT_LT(part.find({0.005, 0.005, 0.005}).cell, 0) << "outside of the region of the map";
}

}  // namespace
}  // namespace pliant
