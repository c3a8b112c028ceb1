#include "model/matching/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "surfaces.h"

namespace pliant {
namespace {

using test::error_of;

Lattice box_lattice() { return build_lattice(test::box({0, 0, 0}, {0.12, 0.1, 0.08}), {0.01, 0}); }
Lattice ball_lattice() { return build_lattice(test::sphere(0.05, 0.01), {0.008, 0}); }

// The cells (i, j, k) in [0, size) that `inside` chooses, of edge 1; nodes of the same grid point are one.
template <class Inside>
Lattice cells_of(const std::array<int, 3>& size, const Inside& inside) {
  Lattice lattice;
  lattice.spacing = 1;
  std::map<std::array<std::int32_t, 3>, std::int32_t> number;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        if (!inside(i, j, k)) continue;
        Cell cell;
        cell.index = {i, j, k};
        for (int a = 0; a < 8; ++a) {
          const std::array<std::int32_t, 3> p{i + (a & 1), j + ((a >> 1) & 1), k + (a >> 2)};
          const auto [at, added] = number.emplace(p, static_cast<std::int32_t>(lattice.nodes.size()));
          if (added) lattice.nodes.push_back({p, 0});
          cell.nodes[a] = at->second;
        }
        lattice.cells.push_back(cell);
      }
    }
  }
  lattice.embedding.push_back({0, {0.5, 0.5, 0.5}});
  return lattice;
}

Body hybrid(double ratio) {
  Body body;
  body.pointer = "/bodies/0";
  body.model.pointer = "/bodies/0/model";
  body.model.type = ModelType::hybrid;
  body.model.ratio = ratio;
  return body;
}

Selection region(Selection::Kind kind, const Vec3d& a, const Vec3d& b, double radius) {
  Selection where;
  where.kind = kind;
  where.a = a;
  where.b = b;
  where.radius = radius;
  where.pointer = "/bodies/0/model/region";
  return where;
}

Vec3d centre(const Lattice& lattice, std::size_t cell) {
  Vec3d p{};
  for (int a = 0; a < 3; ++a) p[a] = lattice.origin[a] + lattice.spacing * (lattice.cells[cell].index[a] + 0.5);
  return p;
}

// Group of each cell with the given value of `operational`, over shared faces; -1 for the others. By the sets of four nodes.
std::vector<int> groups(const Lattice& lattice, const Partition& partition, bool operational, int& count) {
  std::map<std::array<std::int32_t, 4>, std::vector<std::size_t>> faces;
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        std::array<std::int32_t, 4> face{};
        int at = 0;
        for (int a = 0; a < 8; ++a) {
          if (((a >> axis) & 1) == side) face[at++] = lattice.cells[c].nodes[a];
        }
        std::sort(face.begin(), face.end());
        faces[face].push_back(c);
      }
    }
  }
  std::vector<int> group(lattice.cells.size(), -1);
  const auto chosen = [&](std::size_t c) { return (partition.operational[c] != 0) == operational; };
  count = 0;
  for (std::size_t c = 0; c < group.size(); ++c) {
    if (chosen(c)) group[c] = count++;
  }
  for (bool changed = true; changed;) {  // the lowest number of a group spreads over it
    changed = false;
    for (const auto& [face, cells] : faces) {
      for (const std::size_t a : cells) {
        for (const std::size_t b : cells) {
          if (chosen(a) && chosen(b) && group[b] < group[a]) {
            group[a] = group[b];
            changed = true;
          }
        }
      }
    }
  }
  std::vector<int> used(group);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  count = static_cast<int>(used.size()) - (!used.empty() && used[0] == -1 ? 1 : 0);
  return group;
}

// What holds for every partition: kinds as the cells say, counts, no shape-matching group without a node of its own.
void check(const Lattice& lattice, const Partition& partition) {
  ASSERT_EQ(partition.operational.size(), lattice.cells.size());
  ASSERT_EQ(partition.kind.size(), lattice.nodes.size());
  std::vector<std::array<bool, 2>> on(lattice.nodes.size(), {false, false});
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    for (const std::int32_t n : lattice.cells[c].nodes) on[n][partition.operational[c] != 0 ? 0 : 1] = true;
  }
  std::array<std::int64_t, 3> counts{};
  for (std::size_t n = 0; n < on.size(); ++n) {
    const NodeKind expected = on[n][0] ? (on[n][1] ? NodeKind::interface : NodeKind::operational) : NodeKind::matching;
    ASSERT_EQ(partition.kind[n], expected) << "node " << n;
    ++counts[static_cast<std::size_t>(expected)];
  }
  EXPECT_EQ(counts, (std::array{partition.operational_nodes, partition.matching_nodes, partition.interface_nodes}));
  int count = 0;
  const auto group = groups(lattice, partition, false, count);
  std::vector<char> own(lattice.cells.size(), 0);
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    for (const std::int32_t n : lattice.cells[c].nodes) {
      if (group[c] >= 0 && partition.kind[n] == NodeKind::matching) own[group[c]] = 1;
    }
  }
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    if (group[c] >= 0) {
      ASSERT_EQ(own[group[c]], 1) << "cell " << c << " is left without a shape-matching node";
    }
  }
}

void check_ratio(const Lattice& lattice, Body body) {
  const auto nodes = static_cast<double>(lattice.nodes.size());
  std::vector<char> before;
  for (int tenth = 0; tenth <= 10; ++tenth) {
    body.model.ratio = 0.1 * tenth;
    const Partition p = partition_lattice(body, lattice);
    check(lattice, p);
    const auto held = static_cast<double>(p.operational_nodes + p.interface_nodes);
    // One more cell brings 8 nodes at most, so that the nearest count is at most 4 away.
    EXPECT_NEAR(held, body.model.ratio * nodes, 4) << "ratio " << body.model.ratio;
    int count = 0;
    groups(lattice, p, true, count);
    EXPECT_EQ(count, tenth == 0 ? 0 : 1) << "ratio " << body.model.ratio;
    EXPECT_EQ(partition_lattice(body, lattice).operational, p.operational);
    before = p.operational;
  }
  EXPECT_EQ(std::count(before.begin(), before.end(), 1), static_cast<std::ptrdiff_t>(lattice.cells.size()));
}

TEST(Partition, RatioOfABox) { check_ratio(box_lattice(), hybrid(0)); }

TEST(Partition, RatioOfABall) { check_ratio(ball_lattice(), hybrid(0)); }

TEST(Partition, RatioGrownFromTheMiddle) {
  Body body = hybrid(0);
  body.model.seed = Vec3d{0.001, 0.002, -0.001};
  check_ratio(ball_lattice(), body);
}

TEST(Partition, OfPureModels) {
  const Lattice lattice = box_lattice();
  const auto nodes = static_cast<std::int64_t>(lattice.nodes.size());
  Body body = hybrid(0.3);
  body.model.type = ModelType::tled;
  const Partition tled = partition_lattice(body, lattice);
  check(lattice, tled);
  EXPECT_EQ(tled.operational_nodes, nodes);
  body.model.type = ModelType::flsm;
  const Partition flsm = partition_lattice(body, lattice);
  check(lattice, flsm);
  EXPECT_EQ(flsm.matching_nodes, nodes);
  EXPECT_EQ(partition_lattice(hybrid(1), lattice).operational, tled.operational);
  EXPECT_EQ(partition_lattice(hybrid(0), lattice).operational, flsm.operational);
}

TEST(Partition, GrowsAroundTheSeed) {
  const Lattice lattice = build_lattice(test::box({0.3, -0.2, 0.1}, {0.42, -0.1, 0.18}), {0.01, 0});
  Body body = hybrid(0.2);
  body.model.seed = Vec3d{0.32, -0.15, 0.19};  // a little outside
  const Partition p = partition_lattice(body, lattice);
  // In a convex body the region is a ball: what is in is nearer than what is out. Ties are decided by number.
  double in = 0, out = 1;
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    const double d = vec::norm(vec::sub(centre(lattice, c), *body.model.seed));
    p.operational[c] != 0 ? in = std::max(in, d) : out = std::min(out, d);
  }
  EXPECT_LE(in, out + 1e-12);
  EXPECT_GT(p.operational_nodes, 0);
}

TEST(Partition, StartsAtTheFirstVertexWithoutASeed) {
  Lattice lattice = ball_lattice();
  for (const Embedding& vertex : {lattice.embedding.front(), lattice.embedding.back()}) {
    lattice.embedding[0] = vertex;
    const Partition p = partition_lattice(hybrid(0.05), lattice);
    EXPECT_EQ(p.operational[vertex.cell], 1);
  }
}

TEST(Partition, StopsAtTheNearestCount) {
  const Lattice bar = cells_of({10, 1, 1}, [](int, int, int) { return true; });  // 44 nodes; the counts are 8, 12, 16, ...
  for (const auto& [target, count] : {std::pair{9, 8}, {11, 12}, {13, 12}, {15, 16}, {16, 16}, {41, 40}, {43, 44}}) {
    const Partition p = partition_lattice(hybrid(target / 44.0), bar);
    check(bar, p);
    EXPECT_EQ(p.operational_nodes + p.interface_nodes, count) << "target " << target;
  }
}

TEST(Partition, GrowsAlongTheBodyNotAcrossAGap) {
  const Lattice u = cells_of({5, 12, 2}, [](int i, int j, int) { return i != 2 || j == 0; });
  Body body = hybrid(0.35);
  body.model.seed = Vec3d{1.9, 11, 1};  // the end of the first limb; the second is nearer than most of the first
  const Partition p = partition_lattice(body, u);
  check(u, p);
  int count = 0;
  groups(u, p, true, count);
  EXPECT_EQ(count, 1);
  for (std::size_t c = 0; c < u.cells.size(); ++c) {
    if (u.cells[c].index[0] > 2) {
      ASSERT_EQ(p.operational[c], 0) << "cell " << c;
    }
  }
}

TEST(Partition, DoesNotGrowOverAnEdgeOrACorner) {
  const Lattice edge = cells_of({4, 2, 1}, [](int i, int j, int) { return (i < 2) == (j == 0); });
  const Lattice corner = cells_of({4, 2, 2}, [](int i, int j, int k) { return (i < 2) == (j == 0) && j == k; });
  for (Lattice lattice : {edge, corner}) {
    ASSERT_EQ(lattice.cells.size(), 4U);
    for (const bool last : {false, true}) {
      lattice.embedding[0].cell = last ? 3 : 0;
      const Partition p = partition_lattice(hybrid(0.95), lattice);
      check(lattice, p);
      EXPECT_EQ(p.operational, last ? (std::vector<char>{0, 0, 1, 1}) : (std::vector<char>{1, 1, 0, 0}));
    }
  }
}

TEST(Partition, RegionHoldsTheCellsWithTheirCentreInside) {
  for (const Lattice& lattice : {box_lattice(), ball_lattice()}) {
    for (const Selection& where : {region(Selection::Kind::box, {-0.02, -0.02, -0.02}, {0.031, 0.033, 0.08}, 0),
                                   region(Selection::Kind::sphere, {0.01, 0.01, 0.01}, {}, 0.025)}) {
      Body body = hybrid(0.9);  // the region decides, not the ratio
      body.model.region = where;
      const Partition p = partition_lattice(body, lattice);
      check(lattice, p);
      for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
        ASSERT_EQ(p.operational[c] != 0, where.contains(centre(lattice, c), 0)) << "cell " << c;
      }
      EXPECT_GT(p.operational_nodes, 0);
      EXPECT_GT(p.matching_nodes, 0);
      EXPECT_GT(p.interface_nodes, 0);
    }
  }
}

TEST(Partition, RegionMayHaveSeveralParts) {
  // Two limbs; the box takes the end of each and nothing of the bend.
  TriangleMesh limbs = test::box({0, 0, 0}, {0.02, 0.1, 0.02});
  test::append(limbs, test::box({0.04, 0, 0}, {0.06, 0.1, 0.02}));
  const Lattice lattice = build_lattice(limbs, {0.01, 0});
  Body body = hybrid(0.5);
  body.model.region = region(Selection::Kind::box, {-1, 0.06, -1}, {1, 1, 1}, 0);
  const Partition p = partition_lattice(body, lattice);
  check(lattice, p);
  int count = 0;
  groups(lattice, p, true, count);
  EXPECT_EQ(count, 2);
}

// Cells in a ring that is folded onto itself: growth from cell 0 meets at cell 4, which keeps no node of its own.
TEST(Partition, LeavesNoCellWithInterfaceNodesOnly) {
  Lattice lattice;
  lattice.spacing = 1;
  constexpr int kCells = 8;
  for (int m = 0; m < kCells; ++m) {
    Cell cell;
    cell.index = {std::min(m, kCells - m), 0, 0};
    for (int a = 0; a < 8; ++a) cell.nodes[a] = 4 * ((m + (a & 1)) % kCells) + (a >> 1);
    lattice.cells.push_back(cell);
    for (int a = 0; a < 4; ++a) lattice.nodes.push_back({{cell.index[0], a & 1, a >> 1}, m > 4 ? 1 : 0});
  }
  lattice.embedding.push_back({0, {0.5, 0.5, 0.5}});
  const Partition p = partition_lattice(hybrid(0.999), lattice);
  check(lattice, p);
  EXPECT_EQ(p.operational_nodes, 4 * kCells);
  const Partition half = partition_lattice(hybrid(0.5), lattice);
  check(lattice, half);
  EXPECT_EQ(half.operational, (std::vector<char>{1, 1, 0, 0, 0, 0, 0, 1}));
}

TEST(Partition, SmallRatioStillHoldsACell) {
  const Lattice lattice = box_lattice();
  const Partition p = partition_lattice(hybrid(1e-6), lattice);
  EXPECT_EQ(std::count(p.operational.begin(), p.operational.end(), 1), 1);
}

TEST(Partition, RefusesAnEmptyRegion) {
  const Lattice lattice = box_lattice();
  Body body = hybrid(0.5);
  for (const Selection& where : {region(Selection::Kind::box, {0.5, 0, 0}, {0.6, 1, 1}, 0),
                                 region(Selection::Kind::sphere, {0.5, 0.25, 0.125}, {}, 0.0625)}) {
    body.model.region = where;
    const std::string message = error_of([&] { partition_lattice(body, lattice); });
    EXPECT_NE(message.find("/bodies/0/model/region"), std::string::npos) << message;
    EXPECT_NE(message.find("0.5, "), std::string::npos) << message;
    EXPECT_NE(message.find("0.12, 0.1, 0.08"), std::string::npos) << message;
  }
}

TEST(Partition, RefusesASeedFarAway) {
  const Lattice lattice = box_lattice();
  Body body = hybrid(0.5);
  body.model.seed = Vec3d{0.28, 0.05, 0.04};  // 0.165 m from the nearest centre; the diagonal of the body is 0.175 m
  EXPECT_EQ(error_of([&] { partition_lattice(body, lattice); }), "");
  body.model.seed = Vec3d{0.31, 0.05, 0.04};
  const std::string message = error_of([&] { partition_lattice(body, lattice); });
  EXPECT_NE(message.find("/bodies/0/model/seed"), std::string::npos) << message;
  EXPECT_NE(message.find("(0.31, 0.05, 0.04)"), std::string::npos) << message;
  EXPECT_NE(message.find("allowed"), std::string::npos) << message;
}

TEST(Partition, RefusesARatioOutsideZeroToOne) {
  const Lattice lattice = box_lattice();
  for (const double ratio : {-0.1, 1.5, std::nan("")}) {
    const std::string message = error_of([&] { partition_lattice(hybrid(ratio), lattice); });
    EXPECT_NE(message.find("/bodies/0/model/ratio"), std::string::npos) << message;
    EXPECT_NE(message.find("0 to 1"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace pliant
