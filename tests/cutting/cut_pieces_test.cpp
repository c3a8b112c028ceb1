// Pieces of a body that is cut several times: a later cut moves no former one, so each keeps the mass of what it encloses.
#include <gtest/gtest.h>

#include <map>

#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "geometry/polygon.h"
#include "model/pieces.h"

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

/// The largest difference between a piece's mass and that of the volume its surface encloses, in masses of a cell.
double worst_piece(const Model& model, double cell) {
  const ModelBody& body = model.bodies[0];
  const std::vector<std::int32_t> at = pieces_of_slots(body, model.slots);
  std::map<std::int32_t, double> wrong;
  for (const std::int32_t slot : body.slot) {
    const auto n = static_cast<std::size_t>(slot);
    if (at[n] >= 0) wrong[at[n]] += model.own_mass(n) / cell;
  }
  for (const auto& t : model.surface.triangles) {
    std::array<Vec3d, 3> x;
    for (std::size_t i = 0; i < 3; ++i) x[i] = model.surface.rest[static_cast<std::size_t>(t[i])];
    wrong[at[static_cast<std::size_t>(model.surface.nodes[static_cast<std::size_t>(t[0])][0])]] -=
        vec::dot(x[0], vec::cross(x[1], x[2])) / 6 * 1e6;
  }
  EXPECT_GT(wrong.size(), 5U);
  double worst = 0;
  for (const auto& [piece, difference] : wrong) worst = std::max(worst, std::abs(difference));
  return worst;
}

/// A strip to and fro across an axis, with sharp bends inside of cells, that leans.
std::vector<SweepTriangle> zigzag(int axis, double at, double lean) {
  const auto place = [&](int k) {
    BladeSegment blade{};
    const auto across = static_cast<std::size_t>(axis), along = (across + 1) % 3, down = (across + 2) % 3;
    for (std::size_t end = 0; end < 2; ++end) {
      const double depth = end == 0 ? -0.1 : 0.1;
      blade[end][across] = at + (k % 2 == 0 ? 0.004 : -0.004) + lean * depth;
      blade[end][along] = 0.007 * k;
      blade[end][down] = 0.015 + depth;
    }
    return blade;
  };
  std::vector<SweepTriangle> all;
  for (int k = -8; k < 14; ++k) {
    const auto part = sweep(place(k), place(k + 1));
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

TEST(CutPieces, TheMassOfAPieceIsThatOfWhatItsSurfaceEncloses) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
    for (const bool plain : {false, true}) {
      if (plain && element == ElementKind::hex8) continue;  // a blade cannot divide plain hexahedra
      Body body = box_body("box", {0.04, 0.03, 0.03}, element);
      body.plain = plain;
      Simulation s(scene_with(body), open_backend("cpu"));
      s.cut(zigzag(0, 0.0183, 0.2));
      s.cut(zigzag(1, 0.0141, -0.3));
      s.cut(zigzag(2, 0.0162, 0.1));
      s.cut(zigzag(0, 0.0229, -0.1));
      EXPECT_LT(worst_piece(s.model(), 1000 * 1e-6), 2e-3) << to_string(element) << (plain ? ", plain" : "");
    }
  }
}

TEST(CutPieces, AHoleThatTouchesTheBorderBelongsToThePieceAroundIt) {
  using overlay::FlatPoint;
  const std::vector<FlatPoint> at{{0, 0}, {1, 0}, {1, 4}, {0, 4}, {1, 0}, {4, 0}, {4, 4}, {1, 4}, {0.5, 4}, {0.7, 2}, {0.3, 2}};
  const std::vector<overlay::Loop> loops{{{0, 1, 2, 3}}, {{4, 5, 6, 7}}, {{8, 9, 10}, true}};  // beside it lies a larger piece
  double area = 0;
  for (const auto& [a, b, c] : overlay::triangulate(at, loops)) {
    std::array<double, 3> x{};
    for (std::size_t i = 0; i < 3; ++i) x[i] = at[static_cast<std::size_t>(std::array{a, b, c}[i])].x;
    EXPECT_FALSE(*std::min_element(x.begin(), x.end()) < 1 && *std::max_element(x.begin(), x.end()) > 1)
        << "across both pieces";
    area += std::abs(overlay::loop_area(at, {a, b, c})) / 2;
  }
  EXPECT_NEAR(area, 16 - 0.4, 1e-12);
}

}  // namespace
}  // namespace pliant::cut_pieces_test
