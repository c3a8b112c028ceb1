// Virtual nodes: known cuts, and the definition of the algorithm over random ones.
#include "cutting/topology/cut_topology.h"

#include <numeric>

#include "cutting/cut_bodies.h"
#include "lattice/lattice_cell.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace cut_test;

class BothShapes : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(CutTopology, BothShapes, ::testing::Bool(),
                         [](const auto& shape) { return shape.param ? "tetrahedra" : "lattice"; });

TEST_P(BothShapes, AnUncutBodyIsItself) {
  const auto mesh = box_mesh(2, 2, 2, GetParam());
  const CutTopology body(mesh);
  EXPECT_EQ(body.elements().nodes, mesh->cells);
  EXPECT_EQ(body.pieces(), 1);
  check_body(body);
}

TEST_P(BothShapes, APlaneGivesTwoPiecesOfTheRightVolume) {
  for (const Vec3d& normal : {Vec3d{1, 0, 0}, Vec3d{0.3, 1, 0}, Vec3d{1, 1, 1}, Vec3d{-0.2, 0.7, 0.4}}) {
    const auto mesh = box_mesh(4, 3, 3, GetParam());
    CutTopology body(mesh);
    // The box is symmetric about its middle: every plane through it halves the volume, wherever it crosses the cells.
    const CutEdit edit = cut_at_rest(body, plane_cut({2, 1.5, 1.5}, normal));
    EXPECT_TRUE(edit.changed_elements());
    check_body(body);
    const std::vector<double> volume = piece_volumes(body);
    ASSERT_EQ(volume.size(), 2U);
    EXPECT_NEAR(volume[0] + volume[1], 36, 1e-11);
    if (normal[0] != 1) {
      EXPECT_NEAR(volume[0], 18, 1e-9);
    }
  }
}

TEST_P(BothShapes, AnObliquePlaneDividesTheFillExactly) {
  CutTopology body(box_mesh(4, 2, 2, GetParam()));
  // x + y / 4 = 2.3: the mean of x over the section is 2.3 - 1 / 4.
  cut_at_rest(body, plane_cut({2.3, 0, 0}, {1, 0.25, 0}));
  const std::vector<double> volume = piece_volumes(body);
  ASSERT_EQ(volume.size(), 2U);
  // Copies of tetrahedra with next to nothing are raised to the least fill; no cell of the lattice is cut that close to a
  // corner.
  const double bound = GetParam() ? 1e-3 : 1e-11;
  EXPECT_NEAR(volume[0], 4 * 2.05, bound);
  EXPECT_NEAR(volume[0] + volume[1], 16, 1e-11);
}

TEST_P(BothShapes, PlanesThroughNodesEdgesAndFacesCutOnce) {
  for (const Vec3d& normal :
       {Vec3d{1, 0, 0}, Vec3d{1, -1, 0}, Vec3d{1, 1, 0}, Vec3d{1, 1, 1}, Vec3d{1, -1, 2}, Vec3d{0, 0, -1}}) {
    CutTopology body(box_mesh(4, 4, 4, GetParam()));
    cut_at_rest(body, plane_cut({2, 2, 2}, normal));
    check_body(body);
    const std::vector<double> volume = piece_volumes(body);
    ASSERT_EQ(volume.size(), 2U) << normal[0] << normal[1] << normal[2];
    EXPECT_NEAR(volume[0] + volume[1], 64, 1e-11);
    EXPECT_NEAR(volume[0], 32, 0.1);  // at most kLeastCrossing of the section's edges away
  }
}

TEST_P(BothShapes, CrossingPlanesGiveFourAndEightPieces) {
  const auto mesh = box_mesh(4, 4, 4, GetParam());
  CutTopology body(mesh);
  int pieces = 1;
  for (const Vec3d& normal : {Vec3d{1, 0.1, 0}, Vec3d{0, 1, 0.1}, Vec3d{0.1, 0, 1}}) {
    cut_at_rest(body, plane_cut({2.01, 1.97, 2.03}, normal));
    check_body(body);
    check_from_scratch(body, mesh);
    EXPECT_EQ(body.pieces(), pieces *= 2);
  }
}

TEST_P(BothShapes, ABladeThatStopsLeavesOnePieceAndGoesOnLater) {
  const auto mesh = box_mesh(4, 4, 4, GetParam());
  CutTopology body(mesh);
  const auto blade = [](double y) { return BladeSegment{{{2.3, y, -1}, {2.3, y, 5}}}; };
  std::size_t nodes = body.elements().origin.size();
  double y = -0.5;
  for (const double next : {0.4, 0.9, 1.6, 2.2, 2.25, 3.5}) {
    cut_at_rest(body, sweep(blade(y), blade(next)));
    check_body(body);
    check_from_scratch(body, mesh);
    EXPECT_EQ(body.pieces(), 1) << next;
    EXPECT_GE(body.elements().origin.size(), nodes) << "the front moves forward";
    nodes = body.elements().origin.size();
    y = next;
  }
  EXPECT_GT(nodes, mesh->rest.size());
  cut_at_rest(body, sweep(blade(y), blade(4.5)));
  check_body(body);
  EXPECT_EQ(body.pieces(), 2);
}

TEST_P(BothShapes, CuttingTheSamePlaceAgainChangesNothing) {
  CutTopology body(box_mesh(3, 3, 3, GetParam()));
  cut_at_rest(body, plane_cut({1.4, 1.5, 1.5}, {1, 0.2, 0.1}));
  const CutElements before = body.elements();
  const CutEdit edit = cut_at_rest(body, plane_cut({1.4, 1.5, 1.5}, {1, 0.2, 0.1}));
  EXPECT_FALSE(edit.changed_elements());
  expect_same(before, body.elements());
}

TEST_P(BothShapes, ATubeCutsOutACore) {
  const auto mesh = box_mesh(5, 5, 3, GetParam());
  CutTopology body(mesh);
  constexpr int kSides = 24;
  const auto blade = [](int k) {
    const double angle = 2 * std::numbers::pi * (k % kSides) / kSides;
    const double x = 2.5 + 1.4 * std::cos(angle), y = 2.5 + 1.4 * std::sin(angle);
    return BladeSegment{{{x, y, -1}, {x, y, 4}}};
  };
  for (int k = 0; k < kSides; ++k) {
    cut_at_rest(body, sweep(blade(k), blade(k + 1)));
    if (k == kSides / 2) {
      EXPECT_EQ(body.pieces(), 1);
    }
  }
  check_body(body);
  check_from_scratch(body, mesh);
  const std::vector<double> volume = piece_volumes(body);
  ASSERT_EQ(volume.size(), 2U);
  EXPECT_NEAR(volume[1] / 3, 1.4 * 1.4 * std::numbers::pi, 0.6);  // of the curve inside a cell only the crossings are left
}

TEST_P(BothShapes, ABladeThatCrossesItsOwnPath) {
  const auto mesh = box_mesh(6, 6, 1, GetParam());
  CutTopology body(mesh);
  // In through the lower side, round a loop and out again: the loop falls out.
  const std::vector<std::array<double, 2>> path{{3.3, -1},  {3.1, 2.2}, {4.6, 4.1}, {3.2, 4.9},
                                                {1.3, 4.2}, {2.6, 2.5}, {4.9, 1.4}};
  for (std::size_t k = 1; k < path.size(); ++k) {
    const auto blade = [&](std::size_t i) { return BladeSegment{{{path[i][0], path[i][1], -1}, {path[i][0], path[i][1], 2}}}; };
    cut_at_rest(body, sweep(blade(k - 1), blade(k)));
  }
  check_body(body);
  check_from_scratch(body, mesh);
  EXPECT_EQ(body.pieces(), 2);
}

TEST_P(BothShapes, AllEdgesCutLeavesSingleCorners) {
  const auto mesh = box_mesh(2, 1, 1, GetParam());
  CutTopology body(mesh);
  CutEdges all;
  for (const auto& cell : mesh->cells) {
    for (const auto& [a, b] : mesh->shape->edges) all[node_pair(cell[a], cell[b])] = 0.4;
  }
  body.cut(all);
  check_body(body);
  EXPECT_EQ(body.pieces(), 12);  // one around each node
}

/// A blade that crosses an edge twice cuts it where it came first, however far it goes on.
TEST_P(BothShapes, TheFirstCrossingOfAnEdgeCounts) {
  const CutTopology body(box_mesh(2, 1, 1, GetParam()));
  std::vector<SweepTriangle> way = plane_cut({0.3, 0, 0}, {1, 0, 0});
  const std::vector<SweepTriangle> further = plane_cut({0.6, 0, 0}, {1, 0, 0});
  way.insert(way.end(), further.begin(), further.end());
  const std::vector<Vec3d>& x = body.mesh().rest;
  const CutEdges edges = crossed_edges(body, x, way);
  EXPECT_GE(edges.size(), 4U);
  for (const auto& [pair, at] : edges) {
    const double from = x[pair[0]][0], to = x[pair[1]][0];
    EXPECT_NEAR(from + at * (to - from), 0.3, 1e-6);
  }
}

TEST_P(BothShapes, NoCopyIsLighterThanTheFloor) {
  CutTopology body(box_mesh(2, 2, 2, GetParam()));
  // A corner of the body and the node in its middle lose next to nothing.
  cut_at_rest(body, plane_cut({0.01, 0.01, 0.01}, {1, 1, 1}));
  cut_at_rest(body, plane_cut({1.005, 1.005, 1.005}, {1, 1, 1}));
  const CutElements& e = body.elements();
  ASSERT_GT(e.fill.size(), body.mesh().cells.size());
  double least = 1;
  for (const double fill : e.fill) least = std::min(least, fill);
  EXPECT_GE(least, kFillFloor / (1 + 8 * kFillFloor));
  EXPECT_LE(least, kFillFloor) << "the floor had something to raise";
  const std::vector<double> volume = piece_volumes(body);
  EXPECT_NEAR(std::accumulate(volume.begin(), volume.end(), 0.0), 8, 1e-11);
}

TEST(CutTopology, APartWithoutASampleHasSomeMaterial) {
  const auto mesh = box_mesh(1, 1, 1);
  mesh->fill[0] = 0.25;
  mesh->material = {0};
  for (int s = 0; s < 64; ++s) mesh->material[0] |= (s & 3) == 0 ? std::uint64_t{1} << s : 0;  // the quarter x < 1 / 4
  CutTopology body(mesh);
  cut_at_rest(body, plane_cut({0.5, 0.5, 0.5}, {1, 0, 0}));
  const CutElements& e = body.elements();
  ASSERT_EQ(e.fill.size(), 2U) << "there is surface on either side";
  EXPECT_GT(e.fill[1], 0);
  EXPECT_NEAR(e.fill[0], 0.25, 0.25 * 2e-3);
  EXPECT_NEAR(e.fill[0] + e.fill[1], 0.25, 1e-15);
  check_body(body, false);
}

TEST(CutTopology, OneLatticeCellInTwo) {
  const auto mesh = box_mesh(1, 1, 1);
  CutTopology body(mesh);
  const CutEdit edit = cut_at_rest(body, plane_cut({0.25, 0, 0}, {1, 0, 0}));
  const CutElements& e = body.elements();
  ASSERT_EQ(e.nodes.size(), 2U);
  ASSERT_EQ(e.origin.size(), 16U);
  EXPECT_EQ(e.real[0], 0b01010101);
  EXPECT_EQ(e.real[1], 0b10101010);
  EXPECT_NEAR(e.fill[0], 0.25, 1e-14);
  EXPECT_NEAR(e.fill[1], 0.75, 1e-14);
  EXPECT_EQ(e.nodes[0], (std::array<std::int32_t, 8>{0, 9, 2, 11, 4, 13, 6, 15}));
  EXPECT_EQ(e.nodes[1], (std::array<std::int32_t, 8>{8, 1, 10, 3, 12, 5, 14, 7}));
  EXPECT_EQ(edit.element_from, (std::vector<std::int32_t>{0, 0}));
  for (std::size_t n = 0; n < 16; ++n) EXPECT_EQ(edit.node_from[n], static_cast<std::int32_t>(n % 8));
  EXPECT_EQ(body.element_of(0, 1), 1);
  EXPECT_EQ(body.label_at(0, {0.2, 0.5, 0.9}), 0);
  EXPECT_EQ(body.label_at(0, {0.3, 0.5, 0.1}), 1);
}

TEST(CutTopology, PointsOfFacesHaveTheSameBitsOnBothSides) {
  CutTopology body(box_mesh(3, 3, 3));
  cut_at_rest(body, plane_cut({1.37, 1.41, 1.53}, {1, 0.31, -0.45}));
  cut_at_rest(body, plane_cut({1.6, 1.41, 1.53}, {0.2, 1, 0.45}));
  std::map<std::array<std::int32_t, 3>, Vec3d> face;
  int twice = 0;
  for (const auto& [cell, cut] : body.cells()) {
    for (int t = 0; t < 6; ++t) {
      const CutTet tet = body.tet(cell, t);
      for (int f = 0; f < 4; ++f) {
        std::array<std::int32_t, 3> key{tet.node[kTetFaces[f][0]], tet.node[kTetFaces[f][1]], tet.node[kTetFaces[f][2]]};
        std::sort(key.begin(), key.end());
        const auto [at, added] = face.emplace(key, tet.face[f]);
        if (added) continue;
        ++twice;
        EXPECT_EQ(at->second, tet.face[f]);
      }
    }
  }
  EXPECT_GT(twice, 100);
}

TEST(CutTopology, MaterialIsSharedWhereItLies) {
  const auto mesh = box_mesh(1, 1, 1);
  mesh->fill[0] = 0.25;
  mesh->material = {0};
  for (int s = 0; s < 64; ++s) mesh->material[0] |= (s & 3) == 0 ? std::uint64_t{1} << s : 0;  // the quarter x < 1 / 4
  CutTopology body(mesh);
  cut_at_rest(body, plane_cut({0.5, 0.4, 0.5}, {0, 1, 0}));
  const CutElements& e = body.elements();
  ASSERT_EQ(e.fill.size(), 2U);
  EXPECT_NEAR(e.fill[0], 0.125, 1e-3);
  check_body(body, false);
}

TEST(CutTopology, BadEdgesAreRefusedAndChangeNothing) {
  CutTopology body(box_mesh(2, 1, 1));
  const CutElements before = body.elements();
  EXPECT_THROW(body.cut({{{0, 2}, 0.5}}), Error) << "two cells apart";
  EXPECT_THROW(body.cut({{{0, 1}, 0.5}, {{1, 99}, 0.5}}), Error);
  EXPECT_THROW(body.cut({{{1, 0}, 0.5}}), Error) << "in the wrong order";
  EXPECT_THROW(body.cut({{{0, 1}, 0.0}}), Error);
  EXPECT_THROW(body.cut({{{0, 1}, std::nan("")}}), Error);
  EXPECT_TRUE(body.edges().empty());
  expect_same(before, body.elements());
  EXPECT_THROW(crossed_edges(body, body.mesh().rest, std::vector<SweepTriangle>{{Vec3d{0, 0, NAN}, {}, {}}}), Error);
}

TEST(CutTopology, AnEditTakenBackIsAsIfItHadNotBeen) {
  const auto mesh = box_mesh(3, 3, 3);
  CutTopology body(mesh);
  cut_at_rest(body, plane_cut({1.3, 1.5, 1.5}, {1, 0.3, 0}));
  const CutElements before = body.elements();
  const CutEdges edges = body.edges();
  cut_at_rest(body, plane_cut({1.5, 1.5, 1.5}, {0, 1, 0.3}));
  body.reset(edges);
  expect_same(before, body.elements());
}

}  // namespace
}  // namespace pliant
