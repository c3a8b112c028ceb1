// Removal, decomposition and separation: what each loses and keeps, on boxes of Kuhn tetrahedra and on lattice cells.
#include <gtest/gtest.h>

#include <random>

#include "cutting/cut_bodies.h"
#include "support/error_of.h"
#include "tearing/method.h"

namespace pliant {
namespace {

using namespace cut_test;
using test::error_of;

ElementMesh box(int nx, int ny, int nz, bool tets = true) {
  const auto cells = box_mesh(nx, ny, nz, tets);
  ElementMesh mesh{cells->rest, {}, {}, cells->fill};
  for (const auto& c : cells->cells) {
    if (tets) mesh.tets.push_back({c[0], c[1], c[2], c[3]});
    if (!tets) mesh.hexes.push_back(c);
  }
  return mesh;
}

Material material() { return make_material(Law::neo_hookean, Moduli::from_lame(4000, 1000)); }

TEST(Methods, FiguresOfAWholeBox) {
  for (const bool tets : {true, false}) {
    const MeshFigures f = figures_of(box(3, 2, 2, tets));
    EXPECT_EQ(f.elements, tets ? 72 : 12);
    EXPECT_EQ(f.nodes, 36);
    EXPECT_EQ(f.pieces, 1);
    EXPECT_TRUE(f.closed());
    EXPECT_NEAR(f.material, 12, 1e-12);
    EXPECT_NEAR(f.enclosed, 12, 1e-12);
  }
}

TEST(Methods, RemovalLosesTheLayerThatTheBladePasses) {
  for (const bool tets : {true, false}) {
    const MethodResult cut = remove_crossed(box(3, 2, 2, tets), plane_cut({1.5, 1, 1}, {1, 0, 0}));
    const MeshFigures f = figures_of(cut.mesh);
    EXPECT_EQ(cut.crossed, tets ? 24 : 4);
    EXPECT_NEAR(f.material, 8, 1e-12);  // a third of the mass is gone
    EXPECT_NEAR(f.enclosed, 8, 1e-12);
    EXPECT_EQ(f.pieces, 2);
    EXPECT_TRUE(f.closed());
    EXPECT_EQ(cut.element_from.size(), static_cast<std::size_t>(f.elements));
  }
}

TEST(Methods, RemovalSeesABladeThatEndsInsideAnElement) {
  const SweepTriangle small{Vec3d{1.4, 0.3, 0.2}, Vec3d{1.45, 0.3, 0.2}, Vec3d{1.4, 0.32, 0.2}};
  EXPECT_EQ(remove_crossed(box(3, 2, 2), std::vector{small}).crossed, 1);
  EXPECT_EQ(remove_crossed(box(3, 2, 2, false), std::vector{small}).crossed, 1);
}

TEST(Methods, DecompositionKeepsMassAndVolumeAndShortensTheStableStep) {
  const ElementMesh whole = box(3, 2, 2);
  const double before = element_bound(whole, material());
  double last = before;
  for (const double past : {0.3, 0.03, 0.003}) {  // the closer to a layer of nodes, the thinner the pieces
    const MethodResult cut = decompose_crossed(whole, plane_cut({1 + past, 1, 1}, {1, 0, 0}));
    const MeshFigures f = figures_of(cut.mesh);
    EXPECT_NEAR(f.material, 12, 1e-11);
    EXPECT_NEAR(f.enclosed, 12, 1e-11);
    EXPECT_EQ(f.pieces, 2);
    EXPECT_TRUE(f.closed());
    EXPECT_GT(f.elements, 72 + 24);
    const double after = element_bound(cut.mesh, material());
    EXPECT_LT(after, 0.7 * last);
    last = after;
  }
  EXPECT_LT(last, 0.02 * before);
}

TEST(Methods, DecompositionDividesLatticeCellsByKuhn) {
  const MethodResult cut = decompose_crossed(box(3, 2, 2, false), plane_cut({1.4, 1, 1}, {1, 0.2, 0.1}));
  const MeshFigures f = figures_of(cut.mesh);
  EXPECT_TRUE(cut.mesh.hexes.empty());
  EXPECT_NEAR(f.enclosed, 12, 1e-11);
  EXPECT_EQ(f.pieces, 2);
  EXPECT_TRUE(f.closed());
}

TEST(Methods, ABladeThatStopsInsideLeavesOneClosedPiece) {
  const auto half = plane_cut({1.5, 0, 1}, {1, 0, 0}, 1.05);  // from y = -1.05 to 1.05
  for (const MethodResult& cut : {decompose_crossed(box(3, 2, 2), half), separate_crossed(box(3, 2, 2), half)}) {
    const MeshFigures f = figures_of(cut.mesh);
    EXPECT_EQ(f.pieces, 1);
    EXPECT_TRUE(f.closed());
    EXPECT_NEAR(f.enclosed, 12, 1e-11);
    EXPECT_GT(f.nodes, 36) << "nothing was opened";
  }
}

TEST(Methods, SeparationAddsNoElementAndKeepsVolume) {
  const ElementMesh whole = box(3, 2, 2);
  for (const bool remesh : {false, true}) {
    SeparationOptions options;
    options.remesh = remesh;
    const MethodResult cut = separate_crossed(whole, plane_cut({1.4, 1, 1}, {1, 0.1, 0.05}), options);
    const MeshFigures f = figures_of(cut.mesh);
    EXPECT_EQ(f.elements, 72);
    EXPECT_NEAR(f.material, 12, 1e-11);
    EXPECT_NEAR(f.enclosed, 12, 1e-11);
    EXPECT_EQ(f.pieces, 2);
    EXPECT_TRUE(f.closed());
    EXPECT_GE(f.least_quality, std::min(options.least_quality, figures_of(whole).least_quality));
    if (remesh) {
      EXPECT_LT(cut.distance, 0.3 * cut.distance_before);
      EXPECT_GT(element_bound(cut.mesh, material()), 0.3 * element_bound(whole, material()));
    } else {
      EXPECT_DOUBLE_EQ(element_bound(cut.mesh, material()), element_bound(whole, material()));
    }
  }
}

TEST(Methods, RemeshingKeepsEveryTetrahedronAboveTheBound) {
  SeparationOptions options;
  for (const double bound : {0.1, 0.4, 0.7}) {
    options.least_quality = bound;
    const ElementMesh whole = box(4, 4, 4);
    const double worst = figures_of(whole).least_quality;
    for (int k = 0; k < 10; ++k) {
      const MethodResult cut = separate_crossed(whole, plane_cut({1.1 + 0.2 * k, 2, 2}, {1, 0.1 * k, -0.3}), options);
      EXPECT_GE(figures_of(cut.mesh).least_quality, std::min(bound, worst) - 1e-12);
    }
  }
}

/// Two bricks of tetrahedra that share the middle edge (or node) only, after everything between them is taken away.
TEST(Methods, WhatHangsTogetherAtAPointOrAnEdgeIsParted) {
  const ElementMesh whole = box(2, 2, 2);
  for (const bool edge : {true, false}) {
    ElementMesh mesh{whole.nodes, {}, {}, {}};
    for (std::size_t t = 0; t < whole.tets.size(); ++t) {
      Vec3d c{};
      for (const std::int32_t n : whole.tets[t]) c = vec::add(c, vec::mul(whole.nodes[n], 0.25));
      const bool low = c[0] < 1 && c[1] < 1 && (edge || c[2] < 1), high = c[0] > 1 && c[1] > 1 && (edge || c[2] > 1);
      if (low || high) mesh.tets.push_back(whole.tets[t]);
    }
    mesh.fill.assign(mesh.tets.size(), 1.0);
    EXPECT_EQ(figures_of(mesh).pieces, 1);
    EXPECT_EQ(figures_of(mesh).closed(), !edge);
    std::vector<std::uint8_t> none(mesh.tets.size(), 0);
    std::vector<std::int32_t> all(mesh.nodes.size());
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = static_cast<std::int32_t>(n);
    const auto from = part_at_faces(mesh.tets, mesh.nodes.size(), none, all);
    for (std::size_t n = mesh.nodes.size(); n < from.size(); ++n) mesh.nodes.push_back(mesh.nodes[from[n]]);
    EXPECT_EQ(from.size() - whole.nodes.size(), edge ? 3U : 1U);
    EXPECT_EQ(figures_of(mesh).pieces, 2);
    EXPECT_TRUE(figures_of(mesh).closed());
  }
}

/// Planes, strips and repeated cuts through nodes, edges and faces.
TEST(Methods, RandomCutsStayClosedAndKeepWhatTheyShould) {
  std::mt19937 random(11);
  const auto real = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto pick = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  int opened = 0;
  for (int k = 0; k < 120; ++k) {
    ElementMesh whole = box(3, 3, 2);
    std::vector<SweepTriangle> sweep;
    for (int s = 1 + pick(2); s > 0; --s) {
      Vec3d point{}, normal{};
      for (int a = 0; a < 3; ++a) {
        point[a] = pick(2) == 0 ? pick(4) : real(0, 3);
        normal[a] = pick(2) == 0 ? pick(3) - 1 : real(-1, 1);
      }
      if (vec::norm(normal) < 0.1) normal = {1, 0, 0};
      const auto part = plane_cut(point, normal, pick(3) == 0 ? 1.2 : 20);
      sweep.insert(sweep.end(), part.begin(), part.end());
    }
    const MethodResult removed = remove_crossed(whole, sweep), divided = decompose_crossed(whole, sweep),
                       parted = separate_crossed(whole, sweep);
    const MeshFigures r = figures_of(removed.mesh), d = figures_of(divided.mesh), s = figures_of(parted.mesh);
    EXPECT_TRUE(r.closed()) << k;
    EXPECT_TRUE(d.closed()) << k << ": " << d.singular_edges;
    EXPECT_TRUE(s.closed()) << k << ": " << s.singular_edges;
    EXPECT_EQ(r.elements + removed.crossed, 108);
    EXPECT_NEAR(r.enclosed, r.material, 1e-10);
    for (const MeshFigures* f : {&d, &s}) {
      EXPECT_NEAR(f->material, 18, 1e-10);
      EXPECT_NEAR(f->enclosed, 18, 1e-10);
      EXPECT_GT(f->least_quality, 0);
    }
    EXPECT_EQ(s.elements, 108);
    opened += d.nodes > 48;
  }
  EXPECT_GT(opened, 60);
}

TEST(Methods, ASweepThatIsNotFiniteIsRefused) {
  const SweepTriangle bad{Vec3d{0, 0, 0}, Vec3d{NAN, 0, 0}, Vec3d{0, 1, 0}};
  for (const auto& method : {remove_crossed, decompose_crossed}) {
    const std::string message = error_of([&] { method(box(1, 1, 1), std::vector{bad}); });
    EXPECT_NE(message.find("finite"), std::string::npos);
  }
}

TEST(Breaking, StressOfUniaxialStretch) {
  const std::array<Vec3d, 4> rest{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  std::array<Vec3d, 4> now = rest;
  now[1][0] = 1.2;
  Material m = material();
  auto stress = tet_stress(rest, now, m);  // neo-Hookean: sigma_xx = mu (s^2 - 1) / J + lambda (J - 1), J = s
  EXPECT_NEAR((*stress)(0, 0), 1000 * (1.44 - 1) / 1.2 + 4000 * 0.2, 1e-9);
  EXPECT_NEAR((*stress)(1, 1), 4000 * 0.2, 1e-9);
  for (const Law law : all_laws()) {
    m.set_moduli(law, m.moduli);
    now[1][0] = 1 + 1e-6;  // all laws agree with linear elasticity
    stress = tet_stress(rest, now, m);
    EXPECT_NEAR((*stress)(0, 0), (m.moduli.lambda + 2 * m.moduli.mu) * 1e-6, 1e-7);
    EXPECT_NEAR((*stress)(2, 2), m.moduli.lambda * 1e-6, 1e-7);
  }
  now[1][0] = -0.5;
  EXPECT_FALSE(tet_stress(rest, now, m));
}

TEST(Breaking, SharpnessAndDamageRaiseTheCuttingStress) {
  Eigen::Matrix3d stress;
  stress << 300, 40, 0, 40, 100, 0, 0, 0, -50;
  BreakingLaw law{1, 1, 400};
  const double principal = 200 + std::sqrt(100.0 * 100 + 40 * 40);
  EXPECT_NEAR(cutting_stress(stress, law), principal, 1e-9);
  EXPECT_FALSE(breaks(stress, law));
  law.sharpness = 0.5;
  EXPECT_NEAR(cutting_stress(stress, law), 2 * principal, 1e-9);
  EXPECT_TRUE(breaks(stress, law));
  law = {1, 0.7, 400};
  EXPECT_TRUE(breaks(stress, law));
  const CuttingTraction t = cutting_traction(stress, Eigen::Vector3d::UnitX(), {0.5, 1, 0});
  EXPECT_NEAR(t.normal, 600, 1e-9);
  EXPECT_NEAR(t.shear, 80, 1e-9);
}

TEST(Breaking, ABluntBladePartsOnlyWhatIsUnderStress) {
  const ElementMesh whole = box(3, 2, 2);
  const Material m = material();
  std::vector<Vec3d> u(whole.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n) u[n] = {0.1 * whole.nodes[n][0], 0, 0};  // 10 % along x: about 630 Pa
  const auto sweep = plane_cut({1.5, 1, 1}, {1, 0, 0});
  BreakingLaw law{1, 1, 1000};
  SeparationOptions options;
  options.law = &law;
  options.material = &m;
  options.displacement = u;
  EXPECT_EQ(separate_crossed(whole, sweep, options).crossed, 0);
  law.sharpness = 0.5;
  EXPECT_EQ(separate_crossed(whole, sweep, options).crossed, separate_crossed(whole, sweep).crossed);
  options.displacement = {};
  EXPECT_NE(error_of([&] { separate_crossed(whole, sweep, options); }).find("displacement"), std::string::npos);
}

}  // namespace
}  // namespace pliant
