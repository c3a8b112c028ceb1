// Pieces of a body that is cut several times: a later cut moves no former one, so each keeps the mass of what it encloses.
#include <gtest/gtest.h>

#include <map>

#include "cutting/cut_bodies.h"

namespace pliant::cut_pieces_test {
namespace {

using namespace cut_test;

/// The volume of each part of a cell, by the points at which its tetrahedra are divided.
std::map<int, double> part_volumes(const CutTopology& body, std::int32_t cell, const CellCut& cut) {
  std::map<int, double> out;
  for (std::size_t t = 0; t < body.mesh().shape->tets.size(); ++t) {
    const TetDivision division = body.division(cell, static_cast<int>(t));
    const std::array<double, 4> share = corner_shares(division);
    for (std::size_t a = 0; a < 4; ++a) {
      out[cut.label[static_cast<std::size_t>(body.mesh().shape->tets[t][a])]] +=
          share[a] / static_cast<double>(body.mesh().shape->tets.size());
    }
  }
  return out;
}

TEST(CutPieces, EveryPartOfACellHoldsTheMaterialOfItsPlaceHoweverOftenItIsCut) {
  for (const bool tets : {false, true}) {
    CutTopology body(box_mesh(2, 2, 2, tets));
    const std::array<Vec3d, 4> normals{{{1, 0.2, -0.1}, {-0.15, 1, 0.3}, {0.1, -0.2, 1}, {1, -0.8, 0.5}}};
    for (const Vec3d& normal : normals) {
      cut_at_rest(body, plane_cut({1.04, 0.93, 0.97}, normal));
      int parts = 0;
      for (const auto& [cell, cut] : body.cells()) {
        if (cut.components < 2) continue;
        for (const auto& [label, volume] : part_volumes(body, cell, cut)) {
          EXPECT_NEAR(cut.share[static_cast<std::size_t>(label)], volume, 4e-3) << "beyond the least share of a part";
          ++parts;
        }
      }
      EXPECT_GT(parts, 10);
    }
  }
}

TEST(CutPieces, ALaterCutMovesNoFormerOne) {
  for (const bool tets : {false, true}) {
    CutTopology body(box_mesh(3, 3, 3, tets));
    std::map<std::array<std::int32_t, 3>, Vec3d> faces;
    std::map<std::array<std::int32_t, 2>, Vec3d> centres;
    for (const Vec3d& normal : {Vec3d{1, 0.31, -0.45}, Vec3d{0.2, 1, 0.45}, Vec3d{-0.3, 0.2, 1}}) {
      cut_at_rest(body, plane_cut({1.37, 1.41, 1.53}, normal));
      for (const auto& [cell, cut] : body.cells()) {
        for (int t = 0; t < static_cast<int>(body.mesh().shape->tets.size()); ++t) {
          const CutTet tet = body.tet(cell, t);
          if (!tet.mixed()) continue;
          const auto [centre, fresh] = centres.emplace(std::array<std::int32_t, 2>{cell, t}, tet.centre);
          EXPECT_EQ(centre->second, tet.centre);
          for (std::size_t f = 0; f < 4; ++f) {
            const auto& [a, b, c] = kTetFaces[f];
            if (tet.cut[kTetEdgeOf[a][b]] + tet.cut[kTetEdgeOf[b][c]] + tet.cut[kTetEdgeOf[c][a]] < 2) continue;
            std::array<std::int32_t, 3> key{tet.node[a], tet.node[b], tet.node[c]};
            std::sort(key.begin(), key.end());
            EXPECT_EQ(faces.emplace(key, tet.face[f]).first->second, tet.face[f]);
          }
        }
      }
    }
    EXPECT_GT(faces.size(), 40U);
    EXPECT_GT(centres.size(), 20U);
  }
}

}  // namespace
}  // namespace pliant::cut_pieces_test
