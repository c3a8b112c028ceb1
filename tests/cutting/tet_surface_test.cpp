// Surfaces of cut meshes of tetrahedra.
#include "cutting/surface/tet_surface.h"

#include <gtest/gtest.h>

#include "cutting/cut_bodies.h"
#include "cutting/cut_body.h"
#include "geometry/mesh.h"

namespace pliant {
namespace {

using namespace cut_test;

BodyMesh solid_of(const CutMesh& mesh) {
  BodyMesh solid;
  solid.nodes = mesh.rest;
  solid.fill = mesh.fill;
  VolumeMesh volume;
  volume.vertices = mesh.rest;
  for (const auto& c : mesh.cells) volume.tets.push_back({c[0], c[1], c[2], c[3]});
  solid.tets = volume.tets;
  solid.triangles = boundary_triangles(volume);
  for (std::size_t n = 0; n < mesh.rest.size(); ++n) {
    const auto v = static_cast<std::int32_t>(n);
    solid.surface.push_back(mesh.rest[n]);
    solid.surface_nodes.push_back({v, v, v, v, v, v, v, v});
    solid.surface_weights.push_back({1, 0, 0, 0, 0, 0, 0, 0});
  }
  return solid;
}

/// tolerance: of a piece's volume. A cut through cells that are cut already moves their older faces a little, and the copies
/// keep what they hold.
void check_surface(const CutTopology& body, const BodyMesh& uncut, const BodyMesh& solid, double tolerance) {
  std::map<std::array<std::int32_t, 2>, int> used;
  for (const auto& t : solid.triangles) {
    for (int i = 0; i < 3; ++i) {
      ASSERT_NE(t[i], t[(i + 1) % 3]);
      const std::array<std::int32_t, 2> edge{t[i], t[(i + 1) % 3]};
      EXPECT_EQ(++used[edge], 1) << "an edge is used twice in one direction";
    }
  }
  for (const auto& [edge, count] : used) {
    const std::array<std::int32_t, 2> back{edge[1], edge[0]};
    ASSERT_TRUE(used.contains(back)) << "an open edge";
  }
  // The volume of each piece is that of its elements.
  std::vector<std::int32_t> piece;
  const std::int32_t pieces = body.pieces(&piece);
  std::vector<std::int32_t> piece_of_node(body.elements().origin.size(), -1);
  std::vector<double> volume(static_cast<std::size_t>(pieces)), enclosed(static_cast<std::size_t>(pieces));
  for (std::size_t e = 0; e < piece.size(); ++e) {
    for (int a = 0; a < 4; ++a) piece_of_node[body.elements().nodes[e][a]] = piece[e];
    volume[piece[e]] += body.elements().fill[e] / 6;
  }
  for (const auto& t : solid.triangles) {
    const std::int32_t own = piece_of_node[solid.surface_nodes[t[0]][0]];
    for (const std::int32_t v : t) ASSERT_EQ(piece_of_node[solid.surface_nodes[v][0]], own) << "a triangle joins two pieces";
    const Vec3d &a = solid.surface[t[0]], &b = solid.surface[t[1]], &c = solid.surface[t[2]];
    enclosed[own] += vec::dot(a, vec::cross(b, c)) / 6;
  }
  double sum = 0;
  for (std::int32_t p = 0; p < pieces; ++p) {
    sum += enclosed[p];
    EXPECT_NEAR(enclosed[p], volume[p], tolerance) << "a copy's fill has a floor";
  }
  EXPECT_NEAR(sum, 8, 1e-9);
  // Vertices are embedded where they are.
  for (std::size_t v = uncut.surface.size(); v < solid.surface.size(); ++v) {
    Vec3d x{};
    for (std::size_t a = 0; a < 8; ++a) {
      x = vec::add(x,
                   vec::mul(body.mesh().rest[body.elements().origin[solid.surface_nodes[v][a]]], solid.surface_weights[v][a]));
    }
    EXPECT_LT(vec::norm(vec::sub(x, solid.surface[v])), 1e-12);
  }
}

TEST(TetSurface, EveryCutLeavesClosedPiecesOfTheRightVolume) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> real(-1, 1);
  int split = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto mesh = box_mesh(2, 2, 2, true);
    const BodyMesh uncut = solid_of(*mesh);
    CutTopology body(mesh);
    for (int k = 0; k < 4; ++k) {
      const Vec3d point{1 + real(random), 1 + real(random), 1 + real(random)};
      Vec3d normal{real(random), real(random), real(random)};
      if (trial % 5 == 0) normal = {1, 0, 0};
      const double reach = trial % 3 == 0 ? 0.9 : 20;  // a third of the cuts end inside
      cut_at_rest(body, plane_cut(trial % 5 == 0 ? Vec3d{1, 1, 1} : point, normal, reach));
      const BodyMesh solid = cut_body_mesh(uncut, body);
      split += body.pieces() > 1;
      check_surface(body, uncut, solid, k == 0 ? 0.02 : 0.3);
      if (HasFailure()) FAIL() << "trial " << trial << ", cut " << k;
    }
  }
  EXPECT_GT(split, 100);
}

}  // namespace
}  // namespace pliant
