// Blades in bodies that move and deform while they are cut.
#include <gtest/gtest.h>

#include "cutting/blade/blade_trace.h"
#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "scene/scene.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using namespace cut_test;

int pieces_of(const Simulation& s) { return s.cut_topology(0) == nullptr ? 1 : s.cut_topology(0)->pieces(); }

TEST(CutMoving, TissueIsCutWhereTheBladeStandsInIt) {
  for (const double speed : {0.0, 0.3, -0.11}) {
    // The body moves along y at 0.4 m/s and turns, a long blade along z stays, follows, or comes towards it.
    Body body = box_body("box", {0.05, 0.06, 0.02});
    body.velocity = {0.02, 0.4, 0};
    body.angular_velocity = {0, 0, 0.4};
    Scene scene = scene_with(body);
    scene.blades.push_back(blade(
        "b", {{0, 0.024, 0.09, -0.1, 0.026, 0.09, 0.1}, {2, 0.024, 0.09 + 2 * speed, -0.1, 0.026, 0.09 + 2 * speed, 0.1}}));
    Simulation s(scene, open_backend("cpu"));
    while (s.time() < 1.9 && pieces_of(s) == 1) {
      s.advance(8);
      ASSERT_FALSE(s.divergence());
    }
    EXPECT_EQ(pieces_of(s), 2) << speed;
  }
}

/// Where a point of a block of edge 3 is when sheared, twisted, bent and moved by `t`.
Vec3d deformed(const Vec3d& p, double t, int kind) {
  const Vec3d q = vec::sub(p, {1.5, 1.5, 1.5});
  if (kind == 0) return {p[0] + 0.9 * t * q[1], p[1] + 0.3 * t * q[2], p[2]};
  if (kind == 1) {
    const double a = 0.35 * t * q[1], c = std::cos(a), s = std::sin(a);
    return {c * q[0] - s * q[2], q[1] * (1 + 0.3 * t), s * q[0] + c * q[2]};
  }
  if (kind == 2) {
    const double r = 5 / (0.2 + t), a = q[0] / r;  // bent around z
    return {(r + q[1]) * std::sin(a), (r + q[1]) * std::cos(a) - r, q[2]};
  }
  const double c = std::cos(2 * t), s = std::sin(2 * t);
  return {c * q[0] - s * q[1] + 3 * t, s * q[0] + c * q[1], q[2] * (1 - 0.4 * t)};
}

TEST(CutMoving, ADeformingBlockFallsIntoTwoPieces) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> real(-1, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const bool tets = trial % 3 == 2;
    const int looks = 3 + trial % 17, kind = trial % 4;
    const auto mesh = box_mesh(3, 3, 3, tets);
    CutTopology body(mesh);
    RestEdges edges(*mesh, 1.2);
    // The blade lies along z and goes down in y, in deformed space, while the block deforms.
    const double lean = 0.2 * real(random), side = 0.3 * real(random);
    std::vector<Vec3d> rest = mesh->rest;
    BladeTrace front;
    for (int look = 0; look <= looks; ++look) {
      const double t = static_cast<double>(look) / looks;
      std::vector<Vec3d> x;
      for (std::size_t n = 0; n < body.elements().origin.size(); ++n) {
        x.push_back(deformed(rest[body.elements().origin[n]], t, kind));
      }
      const Vec3d middle = deformed({1.5, 1.5, 1.5}, t, kind);
      const double y = middle[1] + 6 - 12 * t;
      const BladeSegment blade{Vec3d{middle[0] + side - lean, y, -8}, Vec3d{middle[0] + side + lean, y, 8}};
      if (look == 0) {
        front = {blade, 0, {}};
        continue;
      }
      BladeSweep sweep(body, x, edges, 1.2);
      sweep.move(front, blade);
      body.cut(sweep.crossed());
    }
    EXPECT_EQ(body.pieces(), 2) << "trial " << trial << ", deformation " << kind << ", " << looks << " looks";
    check_body(body, false);
  }
}

TEST(CutMoving, ALiverThatAToolIndentsFallsIntoTwoPieces) {
  for (const double lean : {0.0, 0.02}) {
    Scene scene = load_scene(test::source_dir() + "/scenes/liver.json");
    scene.blades.push_back(
        blade("scalpel", {{0, 0.005, 0.1, -0.09, 0.005 + lean, 0.1, 0.09}, {0.6, 0.015, -0.1, -0.09, 0.015, -0.1, 0.09}}));
    Simulation s(scene, open_backend("cpu"));
    while (s.time() < 0.61) {
      s.advance(32);
      ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    }
    EXPECT_EQ(pieces_of(s), 2);
  }
}

TEST(CutMoving, TissuePulledAcrossARestingBladeIsCut) {
  const auto mesh = box_mesh(4, 3, 3);
  CutTopology body(mesh);
  RestEdges edges(*mesh, 1.2);
  const BladeSegment blade{Vec3d{2.3, 5, -4}, Vec3d{2.4, 5, 8}};
  BladeTrace front{blade, 0, {}};
  for (int look = 1; look <= 9; ++look) {
    std::vector<Vec3d> x;
    for (const std::int32_t n : body.elements().origin) x.push_back(vec::add(mesh->rest[n], {0, look * 0.8, 0}));
    BladeSweep sweep(body, x, edges, 1.2);
    sweep.move(front, blade);
    body.cut(sweep.crossed());
  }
  EXPECT_EQ(body.pieces(), 2);
}

/// A box that is pulled to 1.4 times its length and springs open as it is cut: batches in between are made again with a smaller
/// step, and the blade goes on from where it stood.
TEST(CutMoving, AStretchedBlockThatSpringsOpenFallsIntoTwoPieces) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
    Body body = box_body("box", {0.1, 0.1, 0.1}, element);
    body.lattice.spacing = 0.0125;
    body.material.set_moduli(Law::neo_hookean, Moduli::from_young(5000, 0.45));
    body.material.damping = 10;
    hold(body, {0, 0, 0.02}, {0, 0, -1});
    pull(body, {0, 0, 0.08}, {0, 0, 1}, {0, 0, 0.04}, 0.5);
    Scene scene = scene_with(body);
    const double lean = element == ElementKind::hex8 ? 0.002 : 0.0214, z = element == ElementKind::hex8 ? 0.0681 : 0.0733;
    scene.blades.push_back(
        blade("b", {{0.6, -0.1, 0.25, z - lean, 0.2, 0.25, z + lean}, {1.1, -0.1, -0.15, z - lean, 0.2, -0.15, z + lean}}));
    Simulation s(scene, open_backend("cpu"));
    while (s.time() < 1.2) {
      s.advance(64);
      ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    }
    EXPECT_EQ(pieces_of(s), 2) << static_cast<int>(element);
  }
}

TEST(CutMoving, ABladeMayStopLeaveReturnAndCrossAnOlderCut) {
  const auto mesh = box_mesh(4, 4, 4);
  CutTopology body(mesh);
  RestEdges edges(*mesh, 1.2);
  const auto go = [&](const std::vector<BladeSegment>& places) {
    BladeTrace front{places.front(), 0, {}};
    for (std::size_t k = 1; k < places.size(); ++k) {
      std::vector<Vec3d> x;
      for (const std::int32_t n : body.elements().origin) x.push_back(mesh->rest[n]);
      BladeSweep sweep(body, x, edges, 1.2);
      sweep.move(front, places[k]);
      body.cut(sweep.crossed());
    }
  };
  const auto at = [](double x, double y) { return BladeSegment{Vec3d{x, y, -3}, Vec3d{x, y, 7}}; };
  go({at(2.4, 7), at(2.4, 2.2), at(2.4, 2.2), at(2.4, 2.2), at(2.4, 7)});
  EXPECT_EQ(body.pieces(), 1) << "half cut";
  go({at(2.4, 7), at(2.4, 3), at(2.4, -3)});
  EXPECT_EQ(body.pieces(), 2);
  go({at(-3, 1.6), at(1.1, 1.6), at(2.9, 1.7), at(8, 1.7)});
  EXPECT_EQ(body.pieces(), 4);
  std::vector<double> volume = piece_volumes(body);
  std::sort(volume.begin(), volume.end());
  EXPECT_GT(volume.front(), 8) << "no slivers";
  check_body(body);
}

TEST(CutMoving, ABladeFarAwayOrOfAbsurdSizeDoesNothingOrCuts) {
  const auto mesh = box_mesh(2, 2, 2);
  CutTopology body(mesh);
  RestEdges edges(*mesh, 1.2);
  const auto crossed = [&](const BladeSegment& from, const BladeSegment& to) {
    BladeSweep sweep(body, mesh->rest, edges, 1.2);
    BladeTrace front{from, 0, {}};
    sweep.move(front, to);
    return sweep.crossed().size();
  };
  EXPECT_EQ(crossed({Vec3d{100, 0, 0}, Vec3d{100, 0, 1}}, {Vec3d{101, 0, 0}, Vec3d{101, 0, 1}}), 0U);
  EXPECT_EQ(crossed({Vec3d{1.3, 1e3, -1}, Vec3d{1.3, 1e3, 3}}, {Vec3d{1.3, -1e3, -1}, Vec3d{1.3, -1e3, 3}}),
            crossed({Vec3d{1.3, 4, -1}, Vec3d{1.3, 4, 3}}, {Vec3d{1.3, -4, -1}, Vec3d{1.3, -4, 3}}));
  EXPECT_GT(crossed({Vec3d{1.3, 4, -1e6}, Vec3d{1.3, 4, 1e6}}, {Vec3d{1.3, -4, -1e6}, Vec3d{1.3, -4, 1e6}}), 10U);
  crossed({Vec3d{1e300, 4, -1e300}, Vec3d{1.3, 4, 1e300}}, {Vec3d{1.3, -4, -1e300}, Vec3d{1.3, -4, 1e300}});
  crossed({Vec3d{1.3, 1, -1e7}, Vec3d{1.3, 1, 1e7}}, {Vec3d{1.3, 1, -1e8}, Vec3d{1.3, 1, 1e8}});
  EXPECT_EQ(crossed({Vec3d{1, 1, 1}, Vec3d{1, 1, 1}}, {Vec3d{1, 1, 1}, Vec3d{1, 1, 1}}), 0U);
}

}  // namespace
}  // namespace pliant
