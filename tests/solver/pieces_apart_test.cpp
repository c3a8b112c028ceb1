// Pieces and bodies of the shipped scenes with contact of tissue at their end: no vertex of one is deep in another. Measured on
// the surfaces that a run writes, with the overlap of closed meshes, which knows nothing of contact.
#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <vector>

#include "geometry/disjoint_sets.h"
#include "geometry/mesh_overlap.h"
#include "solver/scenes.h"

namespace pliant::testing {
namespace {

/// The present surfaces of all bodies, a mesh per part that hangs together.
std::vector<TriangleMesh> pieces_of(Simulation& sim) {
  const std::vector<Vec3d> x = sim.surface_positions();
  const auto& triangles = sim.model().surface.triangles;
  DisjointSets sets(x.size());
  for (const auto& t : triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::map<std::int32_t, TriangleMesh> by_root;
  std::vector<std::int32_t> number(x.size(), -1);
  for (const auto& t : triangles) {
    TriangleMesh& mesh = by_root[sets.find(t[0])];
    std::array<std::int32_t, 3> corners{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto v = static_cast<std::size_t>(t[a]);
      if (number[v] < 0) {
        number[v] = static_cast<std::int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(x[v]);
      }
      corners[a] = number[v];
    }
    mesh.triangles.push_back(corners);
  }
  std::vector<TriangleMesh> pieces;
  for (auto& [root, mesh] : by_root) pieces.push_back(std::move(mesh));
  return pieces;
}

class PiecesApart : public ::testing::TestWithParam<const char*> {};

TEST_P(PiecesApart, NoVertexIsATenthOfACellDeepInAnotherPiece) {
  Simulation sim(load_scene(test::source_dir() + "/scenes/" + GetParam() + ".json"), open_backend("cpu"));
  while (sim.time() < sim.scene().duration && !sim.divergence()) sim.advance(sim.next_batch(64));
  ASSERT_FALSE(sim.divergence());
  const std::vector<TriangleMesh> pieces = pieces_of(sim);
  ASSERT_GT(pieces.size(), 1U);
  double deepest = 0, volume = 0;
  for (std::size_t a = 0; a < pieces.size(); ++a) {
    for (std::size_t b = a + 1; b < pieces.size(); ++b) {
      const MeshOverlap overlap = mesh_overlap(pieces[a], pieces[b]);
      deepest = std::max(deepest, overlap.depth);
      volume += overlap.volume;
    }
  }
  const double cell = sim.model().contact->spacing;
  std::cout << "             " << pieces.size() << " pieces, at most " << deepest / cell << " cells deep, " << volume
            << " m^3 in common\n";
  EXPECT_LT(deepest, 0.1 * cell);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PiecesApart, ::testing::Values("stack", "press_cut", "liver_on_table"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace pliant::testing
