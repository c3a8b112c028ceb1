#include "lattice/lattice.h"

#include <gtest/gtest.h>

#include <set>

#include "mesh_io/mesh_io.h"
#include "scenes/generate/organs.h"
#include "surfaces.h"

namespace pliant {
namespace {

double material(const Lattice& lattice) {
  double fill = 0;
  for (const Cell& c : lattice.cells) fill += c.fill;
  return fill * std::pow(lattice.spacing, 3);
}

Vec3d embedded(const Lattice& lattice, const Embedding& e) {
  Vec3d p{};
  for (int a = 0; a < 8; ++a) {
    double w = 1;
    for (int n = 0; n < 3; ++n) w *= ((a >> n) & 1) != 0 ? e.local[n] : 1 - e.local[n];
    const Vec3d x = lattice.position(lattice.nodes[lattice.cells[e.cell].nodes[a]]);
    p = vec::add(p, vec::mul(x, w));
  }
  return p;
}

// What holds for every lattice: order, corners where they belong, no unused node, every vertex where it was.
void check(const Lattice& lattice, const TriangleMesh& surface) {
  std::vector<char> used(lattice.nodes.size(), 0);
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    const Cell& cell = lattice.cells[c];
    EXPECT_GT(cell.fill, 0);
    EXPECT_LE(cell.fill, 1);
    for (int a = 0; a < 8; ++a) {
      const LatticeNode& n = lattice.nodes[cell.nodes[a]];
      used[cell.nodes[a]] = 1;
      const std::array<std::int32_t, 3> expected{cell.index[0] + (a & 1), cell.index[1] + ((a >> 1) & 1),
                                                 cell.index[2] + (a >> 2)};
      ASSERT_EQ(n.index, expected);
    }
    if (c == 0) continue;
    const auto& before = lattice.cells[c - 1].index;
    ASSERT_LE((std::array{before[2], before[1], before[0]}), (std::array{cell.index[2], cell.index[1], cell.index[0]}));
  }
  for (std::size_t n = 1; n < lattice.nodes.size(); ++n) {
    const LatticeNode &x = lattice.nodes[n - 1], &y = lattice.nodes[n];
    ASSERT_LT((std::array{x.index[2], x.index[1], x.index[0], x.copy}),
              (std::array{y.index[2], y.index[1], y.index[0], y.copy}));
    ASSERT_EQ(y.copy, x.index == y.index ? x.copy + 1 : 0);
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
  ASSERT_EQ(lattice.embedding.size(), surface.vertices.size());
  double worst = 0;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    worst = std::max(worst, vec::norm(vec::sub(embedded(lattice, lattice.embedding[v]), surface.vertices[v])));
  }
  vec::Box box;
  for (const Vec3d& v : surface.vertices) box.extend(v);
  EXPECT_LT(worst, 1e-9 * vec::norm(vec::sub(box.upper, box.lower)));
}

bool same(const Lattice& a, const Lattice& b) {
  if (a.cells.size() != b.cells.size() || a.nodes.size() != b.nodes.size() || a.spacing != b.spacing) return false;
  for (std::size_t c = 0; c < a.cells.size(); ++c) {
    if (a.cells[c].index != b.cells[c].index || a.cells[c].nodes != b.cells[c].nodes) return false;
    if (std::abs(a.cells[c].fill - b.cells[c].fill) > 1e-9) return false;
  }
  for (std::size_t v = 0; v < a.embedding.size(); ++v) {
    if (a.embedding[v].cell != b.embedding[v].cell) return false;
  }
  return true;
}

std::int32_t pieces(const Lattice& lattice) {
  std::vector<std::int32_t> parent(lattice.nodes.size());
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<std::int32_t>(i);
  const auto find = [&](std::int32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Cell& c : lattice.cells) {
    for (const std::int32_t n : c.nodes) parent[find(n)] = find(c.nodes[0]);
  }
  std::set<std::int32_t> roots;
  for (const Cell& c : lattice.cells) roots.insert(find(c.nodes[0]));
  return static_cast<std::int32_t>(roots.size());
}

TEST(Lattice, BoxIsFilledExactly) {
  for (const TriangleMesh& mesh : {test::box({0.3, -0.1, 7}, {0.9, 0.2, 7.9}), make_shape("beam"), make_shape("cube")}) {
    vec::Box box;
    for (const Vec3d& v : mesh.vertices) box.extend(v);
    for (const int divisions : {2, 4, 10}) {
      const double d = (box.upper[1] - box.lower[1]) / divisions;
      const Lattice lattice = build_lattice(mesh, {d, 0});
      std::size_t cells = 1, nodes = 1;
      for (int a = 0; a < 3; ++a) {
        const auto n = static_cast<std::size_t>(std::ceil((box.upper[a] - box.lower[a]) / d - 1e-6));
        cells *= n;
        nodes *= n + 1;
      }
      EXPECT_EQ(lattice.cells.size(), cells);
      EXPECT_EQ(lattice.nodes.size(), nodes);
      EXPECT_NEAR(material(lattice), signed_volume(mesh), 1e-9 * signed_volume(mesh));
      check(lattice, mesh);
    }
  }
  for (const Cell& c : build_lattice(make_shape("beam"), {0.005, 0}).cells) EXPECT_EQ(c.fill, 1.0);
  for (const Cell& c : build_lattice(make_shape("cube"), {0.01, 0}).cells) EXPECT_EQ(c.fill, 1.0);
}

TEST(Lattice, SpacingThatDoesNotDivideABox) {
  const TriangleMesh mesh = make_shape("beam");
  const Lattice lattice = build_lattice(mesh, {0.008, 0});
  EXPECT_EQ(lattice.cells.size(), 13U * 3 * 3);
  EXPECT_NEAR(material(lattice), 4e-5, 0.01 * 4e-5);
  EXPECT_EQ(lattice.cells[19].index, (std::array<std::int32_t, 3>{6, 1, 0}));
  EXPECT_NEAR(lattice.cells[19].fill, 0.75, 1e-9);
  check(lattice, mesh);
}

TEST(Lattice, OrgansKeepTheirVolumeAndStayWhole) {
  for (const char* name : {"apple", "liver", "kidney", "cylinder"}) {
    const TriangleMesh mesh = read_surface(test::shipped(name));
    vec::Box box;
    for (const Vec3d& v : mesh.vertices) box.extend(v);
    for (const double divisions : {6.5, 17.0, 40.0}) {
      const Lattice lattice = build_lattice(mesh, {(box.upper[1] - box.lower[1]) / divisions, 0});
      const double ratio = material(lattice) / signed_volume(mesh);
      EXPECT_NEAR(ratio, 1, divisions < 10 ? 0.01 : 0.003) << name << ' ' << divisions;
      EXPECT_EQ(pieces(lattice), 1) << name << ' ' << divisions;
      // A smooth body has no slits: slivers of neighbouring cells must not be torn apart by the sampling.
      const auto copies =
          std::count_if(lattice.nodes.begin(), lattice.nodes.end(), [](const LatticeNode& n) { return n.copy > 0; });
      EXPECT_LE(copies, 2 + static_cast<std::ptrdiff_t>(lattice.nodes.size() / 200)) << name << ' ' << divisions;
      check(lattice, mesh);
    }
  }
}

TEST(Lattice, RandomFlipsDoNotMatter) {
  const TriangleMesh mesh = read_surface(test::shipped("liver"));
  TriangleMesh bad = mesh;
  test::flip_some(bad, 0.4, 11);
  const Lattice good = build_lattice(mesh, {0.009, 0});
  EXPECT_TRUE(same(good, build_lattice(bad, {0.009, 0})));
  EXPECT_TRUE(same(good, build_lattice(mesh, {0.009, 0})));
}

// Two slabs with a gap far thinner than a cell, through the middle of a layer of cells and along a plane of the grid.
TEST(Lattice, SlabsThatDoNotTouchShareNoNode) {
  for (const double gap : {0.05, 0.3, 0.9, 1e-4}) {
    for (const double middle : {0.0, 0.5, 0.13}) {
      TriangleMesh mesh = test::box({0, 0, 0}, {6, 3 + middle - gap / 2, 6});
      test::append(mesh, test::box({0, 3 + middle + gap / 2, 0}, {6, 6, 6}));
      const Lattice lattice = build_lattice(mesh, {1, 0});
      EXPECT_EQ(pieces(lattice), 2) << gap << ' ' << middle;
      EXPECT_NEAR(material(lattice), signed_volume(mesh), 0.01 * signed_volume(mesh)) << gap << ' ' << middle;
      check(lattice, mesh);
      // Every vertex is embedded in its own slab: the cells of the two slabs have no node in common.
      std::set<std::int32_t> lower, upper;
      for (std::size_t v = 0; v < 16; ++v) {
        for (const std::int32_t n : lattice.cells[lattice.embedding[v].cell].nodes) (v < 8 ? lower : upper).insert(n);
      }
      for (const std::int32_t n : lower) EXPECT_EQ(upper.count(n), 0U);
    }
  }
}

TEST(Lattice, TouchingAndOverlappingBodiesAreOne) {
  TriangleMesh mesh = test::box({0, 0, 0}, {6, 3.2, 6});
  test::append(mesh, test::box({0, 2.9, 0}, {6, 6, 6}));
  const Lattice lattice = build_lattice(mesh, {1, 0});
  EXPECT_EQ(pieces(lattice), 1);
  EXPECT_EQ(lattice.cells.size(), 216U);
  for (const Cell& c : lattice.cells) EXPECT_EQ(c.fill, 1.0);
}

// A horseshoe whose legs pass near each other: connected below, slit above.
TEST(Lattice, SlitBodyKeepsItsSlit) {
  const TriangleMesh mesh = surface_nets(
      [](const Vec3d& p) {
        const double ball = vec::norm(p) - 1, slit = std::max(std::abs(p[0] - 0.03) - 0.06, -0.2 - p[1]);
        return std::max(ball, -slit);
      },
      {{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}}, 0.04);
  const Lattice lattice = build_lattice(mesh, {0.25, 0});
  EXPECT_EQ(pieces(lattice), 1);
  std::size_t copies = 0;
  for (const LatticeNode& n : lattice.nodes) copies += n.copy > 0 ? 1 : 0;
  EXPECT_GT(copies, 20U);
  EXPECT_NEAR(material(lattice), signed_volume(mesh), 0.01 * signed_volume(mesh));
  check(lattice, mesh);
}

TEST(Lattice, ThinSheetAndTinyBody) {
  const TriangleMesh sheet = test::box({0, 0, 0}, {5, 0.05, 5});
  const Lattice thin = build_lattice(sheet, {0.5, 0});
  EXPECT_EQ(thin.cells.size(), 100U);
  EXPECT_NEAR(material(thin), 1.25, 0.01);
  EXPECT_EQ(pieces(thin), 1);
  check(thin, sheet);
  TriangleMesh tilted = test::box({0, 0, 0}, {5, 0.1, 5});  // a fifth of the spacing, less than the samples are apart
  for (Vec3d& v : tilted.vertices) v = {0.8 * v[0] - 0.6 * v[1], 0.6 * v[0] + 0.8 * v[1], v[2]};
  const Lattice slanted = build_lattice(tilted, {0.5, 0});
  EXPECT_EQ(pieces(slanted), 1);
  EXPECT_NEAR(material(slanted), 2.5, 0.1);
  check(slanted, tilted);
  const TriangleMesh grain = test::box({0, 0, 0}, {1, 1, 1});
  const Lattice one = build_lattice(grain, {50, 0});
  ASSERT_EQ(one.cells.size(), 1U);
  EXPECT_EQ(one.nodes.size(), 8U);
  check(one, grain);
}

/// A sheet of a tenth of a cell that lies askew passes from cell to cell through faces where no sample sees it, and each such
/// place divides a node. None would be best; it is to become no worse.
TEST(Lattice, ASheetThatLiesAskewIsDividedAtFewNodes) {
  const std::vector<std::pair<Vec3d, std::int64_t>> cases{
      {{0.762, 1.926, 1.405}, 136}, {{0.816, 0.081, 0.651}, 210}, {{2.634, 1.735, 0.773}, 59}};
  for (const auto& [angle, most] : cases) {
    const auto [a, b, c] = angle;
    TriangleMesh sheet = test::box({0, 0, 0}, {12, 10, 0.1});
    for (Vec3d& v : sheet.vertices) {
      v = {v[0], v[1] * std::cos(a) - v[2] * std::sin(a), v[1] * std::sin(a) + v[2] * std::cos(a)};
      v = {v[0] * std::cos(b) - v[2] * std::sin(b), v[1], v[0] * std::sin(b) + v[2] * std::cos(b)};
      v = {v[0] * std::cos(c) - v[1] * std::sin(c), v[0] * std::sin(c) + v[1] * std::cos(c), v[2]};
    }
    const Lattice lattice = build_lattice(sheet, {1, 0});
    EXPECT_EQ(pieces(lattice), 1);
    EXPECT_LE(std::count_if(lattice.nodes.begin(), lattice.nodes.end(), [](const LatticeNode& n) { return n.copy > 0; }), most);
    check(lattice, sheet);
  }
}

TEST(Lattice, OpenSurfaceIsClosedSmoothly) {
  TriangleMesh mesh = test::sphere(1, 0.06);
  const double volume = signed_volume(mesh);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const Vec3d& v = mesh.vertices[t[0]];
    return v[1] < 0 && std::hypot(v[0], v[2]) < 0.3;
  });
  for (const double spacing : {0.21, 0.05}) {
    const Lattice lattice = build_lattice(mesh, {spacing, 0});
    EXPECT_NEAR(material(lattice), volume, 0.02 * volume);
    EXPECT_EQ(pieces(lattice), 1);
    check(lattice, mesh);
  }
}

TEST(Lattice, Bunny) {
  if (!std::filesystem::exists(test::kBunny)) GTEST_SKIP() << "glmark2-data is not installed";
  const TriangleMesh mesh = read_surface(test::kBunny);
  const Lattice lattice = build_lattice(mesh, {0, 2250});
  EXPECT_NEAR(static_cast<double>(lattice.nodes.size()), 2250, 45);
  EXPECT_NEAR(material(lattice), signed_volume(mesh), 0.01 * signed_volume(mesh));
  EXPECT_EQ(pieces(lattice), 1);
  check(lattice, mesh);
}

TEST(Lattice, WantedNumberOfNodes) {
  for (const auto& [name, nodes] : {std::pair{"apple", 2250}, {"liver", 2886}, {"kidney", 2886}, {"cube", 1000}, {"cube", 8}}) {
    const TriangleMesh mesh = read_surface(test::shipped(name));
    const Lattice lattice = build_lattice(mesh, {0, nodes});
    EXPECT_NEAR(static_cast<double>(lattice.nodes.size()), nodes, 0.02 * nodes) << name;
    check(lattice, mesh);
  }
}

// Where no spacing gives that many nodes, the nearest lattice is taken: a cube of one cell, of 27 or of 64 nodes.
TEST(Lattice, NearestNumberOfNodes) {
  for (const auto& [wanted, nodes] : {std::pair{9, 8U}, {25, 27U}, {35, 36U}}) {
    const TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, wanted == 35 ? 2.0 : 1.0});
    EXPECT_LE(std::abs(static_cast<double>(build_lattice(mesh, {0, wanted}).nodes.size()) - nodes), 1) << wanted;
  }
  const Lattice sheet = build_lattice(test::box({0, 0, 0}, {5, 0.01, 5}), {0, 1000});
  EXPECT_NEAR(static_cast<double>(sheet.nodes.size()), 1000, 100);
  // Cells of this one hold next to nothing until there are a million: too coarse is nearer.
  EXPECT_LT(build_lattice(test::box({0, 0, 0}, {5, 1e-5, 5}), {0, 1000}).nodes.size(), 1000U);
  // A loose triangle far away.
  TriangleMesh fin = make_shape("cube");
  const auto first = static_cast<std::int32_t>(fin.vertices.size());
  fin.vertices.insert(fin.vertices.end(), {{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.2, 0.2}});
  fin.triangles.push_back({first, first + 1, first + 2});
  const Lattice body = build_lattice(fin, {0, 1000});
  EXPECT_EQ(body.nodes.size(), 1000U);
  EXPECT_EQ(body.embedding.size(), fin.vertices.size());
}

// Before anything is filled: the cells of this one would not fit into memory.
TEST(Lattice, FarTooManyCellsAreRefusedAtOnce) {
  const auto error = [](double spacing) { return test::error_of([&] { build_lattice(make_shape("cube"), {spacing, 0}); }); };
  EXPECT_NE(error(2e-4).find("spacing 0.0002 m needs at least 12500000"), std::string::npos) << error(2e-4);
  EXPECT_NE(error(2e-4).find("at most 100000000 are allowed (choose a larger spacing)"), std::string::npos);
}

TEST(Lattice, ErrorsSayWhatIsWrong) {
  const TriangleMesh cube = make_shape("cube");
  const auto error = [&](const LatticeSpec& spec, std::int64_t most) {
    return test::error_of([&] { build_lattice(cube, spec, most); });
  };
  const auto mentions = [](const std::string& message, const std::string& words) {
    return message.find(words) != std::string::npos ? ::testing::AssertionSuccess() : ::testing::AssertionFailure() << message;
  };
  EXPECT_TRUE(mentions(error({-0.01, 0}, 1000), "spacing is -0.01 m; a positive number is needed"));
  EXPECT_TRUE(mentions(error({0, 0}, 1000), "spacing is 0 m"));
  EXPECT_TRUE(mentions(error({std::nan(""), 0}, 1000), "a positive number is needed"));
  EXPECT_TRUE(mentions(error({0.01, 0}, 999), "needs at least 1000 cells; at most 999 are allowed"));
  EXPECT_TRUE(mentions(error({0.0001, 0}, 1000), "cells; at most 1000 are allowed"));
  EXPECT_TRUE(mentions(error({1e-9, 0}, 1000), "1e+08 cells along x"));
  EXPECT_TRUE(mentions(error({0, 7}, 1000), "at least the 8 nodes of one cell"));
  EXPECT_TRUE(mentions(error({0, 1001}, 1000), "lattice nodes is 1001; at most 1000 are allowed"));
  EXPECT_EQ(error({0.01, 0}, 1000), "");
  TriangleMesh bad = cube;
  bad.vertices[3][1] = std::nan("");
  EXPECT_NE(test::error_of([&] { build_lattice(bad, {0.01, 0}); }), "");
}

}  // namespace
}  // namespace pliant
