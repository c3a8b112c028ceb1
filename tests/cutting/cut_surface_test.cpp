// The surface after cuts: closed, oriented, of the same volume, in the pieces that the topology says, and stable in its
// numbers.
#include "cutting/surface/cut_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "cut_bodies.h"
#include "cut_scenes.h"
#include "mesh_io/mesh_io.h"
#include "scenes/generate/organs.h"
#include "scenes/generate/surface_nets.h"

namespace pliant::cut_test {
namespace {

struct Piece {
  double volume = 0;
  std::int64_t vertices = 0, triangles = 0;
  [[nodiscard]] std::int64_t euler() const { return vertices - triangles / 2; }
};

struct CutCase {
  CutCase(TriangleMesh surface, double spacing) {
    // Filling takes longer than cutting: each body is filled once.
    static std::map<std::pair<std::size_t, double>, Lattice> filled;
    Lattice& kept = filled[{surface.triangles.size(), spacing}];
    if (kept.cells.empty()) {
      LatticeSpec spec;
      spec.spacing = spacing;
      spec.nodes = 0;
      kept = build_lattice(surface, spec);
    }
    lattice = kept;
    auto cells = std::make_shared<CutMesh>();
    cells->shape = &lattice_cell_shape();
    for (const LatticeNode& n : lattice.nodes) cells->rest.push_back(lattice.position(n));
    for (const Cell& c : lattice.cells) {
      cells->cells.push_back(c.nodes);
      cells->fill.push_back(c.fill);
    }
    topology = std::make_unique<CutTopology>(cells);
    cut_surface = std::make_unique<CutSurface>(surface, lattice);
    for (const Vec3d& v : surface.vertices) box.extend(v);
    before = volume();
  }
  CutEdit cut(const Vec3d& point, const Vec3d& normal, double reach = 100) {
    const CutEdit edit = cut_at_rest(*topology, plane_cut(point, normal, reach));
    cut_surface->update(*topology, edit.cells);
    return edit;
  }
  [[nodiscard]] double volume() const {
    double sum = 0;
    for (const auto& t : cut_surface->triangles()) sum += part(t);
    return sum;
  }
  [[nodiscard]] double part(const std::array<std::int32_t, 3>& t) const {
    const auto& v = cut_surface->vertices();
    return vec::dot(v[t[0]].rest, vec::cross(v[t[1]].rest, v[t[2]].rest)) / 6;
  }
  [[nodiscard]] std::vector<Piece> pieces() const {
    DisjointSets sets(cut_surface->vertices().size());
    for (const auto& t : cut_surface->triangles()) {
      sets.join(t[0], t[1]);
      sets.join(t[1], t[2]);
    }
    std::map<std::int32_t, Piece> found;
    std::set<std::int32_t> used;
    for (const auto& t : cut_surface->triangles()) {
      Piece& piece = found[sets.find(t[0])];
      piece.volume += part(t);
      ++piece.triangles;
      used.insert(t.begin(), t.end());
    }
    for (const std::int32_t v : used) ++found[sets.find(v)].vertices;
    std::vector<Piece> out;
    for (const auto& [root, piece] : found) out.push_back(piece);
    return out;
  }
  void expect_closed() const {
    std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
    for (const auto& t : cut_surface->triangles()) {
      for (int i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
    }
    for (const auto& [edge, count] : uses) {
      ASSERT_NE(edge.first, edge.second);
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(uses.contains({edge.second, edge.first}));
    }
    ASSERT_NEAR(volume() / before, 1, 1e-12);
    // A cut exactly along a face of the surface may shave off a piece of no thickness.
    for (const Piece& piece : pieces()) ASSERT_GT(piece.volume, -1e-15 * before);
  }
  [[nodiscard]] Vec3d somewhere(std::mt19937& random) const {
    Vec3d p{};
    for (int a = 0; a < 3; ++a) {
      p[a] = box.lower[a] + (0.1 + 0.8 * static_cast<double>(random()) / 4294967296.0) * (box.upper[a] - box.lower[a]);
    }
    return p;
  }

  Lattice lattice;
  std::unique_ptr<CutTopology> topology;
  std::unique_ptr<CutSurface> cut_surface;
  vec::Box box;
  double before = 0;
};

TriangleMesh shape(const std::string& name) {
  if (name == "sphere") {
    return surface_nets([](const Vec3d& p) { return vec::norm(p) - 0.1; }, {{-0.12, -0.12, -0.12}, {0.12, 0.12, 0.12}}, 0.01);
  }
  if (name == "torus") {
    return surface_nets([](const Vec3d& p) { return std::hypot(std::hypot(p[0], p[1]) - 0.07, p[2]) - 0.025; },
                        {{-0.11, -0.11, -0.04}, {0.11, 0.11, 0.04}}, 0.007);
  }
  return make_shape(name);
}

Vec3d direction(std::mt19937& random) {
  Vec3d n{};
  for (double& c : n) c = static_cast<double>(random()) / 4294967296.0 - 0.5;
  return n;
}

TEST(CutSurface, ASphereFallsIntoTwoSpheres) {
  CutCase body(shape("sphere"), 0.023);
  body.cut({0, 0, 0.0203}, {0.3, -0.2, 1});
  body.expect_closed();
  const std::vector<Piece> pieces = body.pieces();
  ASSERT_EQ(pieces.size(), 2U);
  for (const Piece& piece : pieces) EXPECT_EQ(piece.euler(), 2);
  // Volume of a cap of height h: pi h^2 (r - h / 3); the mesh is inscribed.
  const double h = 0.1 - 0.0203 / std::sqrt(1.13), cap = std::numbers::pi * h * h * (0.1 - h / 3);
  EXPECT_NEAR(std::min(pieces[0].volume, pieces[1].volume), cap, 0.02 * cap);
}

TEST(CutSurface, CapsAreFlaggedAndLieInThePlane) {
  CutCase body(shape("cube"), 0.0103);
  const Vec3d normal{0.6, 0, 0.8};
  body.cut({0.003, 0, 0}, normal);
  double area = 0;
  const auto& v = body.cut_surface->vertices();
  for (std::size_t t = 0; t < body.cut_surface->triangles().size(); ++t) {
    if (body.cut_surface->kinds()[t] != SurfaceKind::cut) continue;
    const auto& c = body.cut_surface->triangles()[t];
    for (const std::int32_t corner : c) EXPECT_NEAR(vec::dot(normal, v[corner].rest), 0.0018, 1e-9);
    area += 0.5 * vec::norm(vec::cross(vec::sub(v[c[1]].rest, v[c[0]].rest), vec::sub(v[c[2]].rest, v[c[0]].rest)));
  }
  EXPECT_NEAR(area, 2 * 0.1 * 0.1 / 0.8, 1e-9);  // both sides
  body.expect_closed();
}

TEST(CutSurface, ATorusOpensAndThenFallsIntoTwo) {
  CutCase body(shape("torus"), 0.0113);
  body.cut({0.07, 0, 0}, {0, 1, 0.1}, 0.05);  // one side of the ring
  body.expect_closed();
  ASSERT_EQ(body.pieces().size(), 1U);
  EXPECT_EQ(body.pieces()[0].euler(), 2);  // a curved bar
  body.cut({-0.07, 0, 0}, {0, 1, 0.1}, 0.05);
  body.expect_closed();
  ASSERT_EQ(body.pieces().size(), 2U);
  for (const Piece& piece : body.pieces()) EXPECT_EQ(piece.euler(), 2);
}

TEST(CutSurface, ACutThatEndsInsideLeavesOneClosedPiece) {
  for (const char* name : {"cube", "liver"}) {
    CutCase body(shape(name), name == std::string("cube") ? 0.0111 : 0.013);
    body.cut({0.001, 0.5, 0.0013}, {1, 0.05, 0.2}, 0.5);  // from above down to y = 0
    body.expect_closed();
    ASSERT_EQ(body.pieces().size(), 1U) << name;
    EXPECT_EQ(body.pieces()[0].euler(), 2) << name;
    EXPECT_FALSE(body.cut_surface->take_changes().triangles.empty());
  }
}

// Cuts at random, through nodes, along lattice planes, through vertices of the surface, along its faces.
TEST(CutSurface, ClosedAfterAnyCut) {
  std::mt19937 random(7);
  for (const char* name : {"cube", "sphere", "torus", "liver", "kidney"}) {
    const double spacing = name == std::string("cube") ? 0.0125 : name == std::string("liver") ? 0.016 : 0.012;
    const TriangleMesh mesh = shape(name);
    for (int trial = 0; trial < 6; ++trial) {
      CutCase body(mesh, spacing);
      const bool whole = trial % 2 == 0;
      for (int c = 0; c < 3; ++c) {
        Vec3d normal = direction(random), point = body.somewhere(random);
        const auto kind = random() % 4;
        if (kind == 0) normal = {0, 1, 0};
        if (kind == 1) point = body.lattice.position(body.lattice.nodes[random() % body.lattice.nodes.size()]);
        if (kind < 2) point = body.lattice.position(body.lattice.nodes[random() % body.lattice.nodes.size()]);
        if (kind == 2) point = mesh.vertices[random() % mesh.vertices.size()];
        body.cut(point, normal, whole ? 100 : 0.05);
        body.expect_closed();
        if (HasFatalFailure()) FAIL() << name << " trial " << trial << " cut " << c;
      }
    }
  }
}

TEST(CutSurface, HistoryDoesNotMatter) {
  std::mt19937 random(11);
  CutCase one(shape("sphere"), 0.012), other(shape("sphere"), 0.012);
  std::vector<std::int32_t> cells;
  for (int c = 0; c < 4; ++c) {
    const Vec3d point = one.somewhere(random), normal = direction(random);
    one.cut(point, normal, 0.05);
    const CutEdit edit = cut_at_rest(*other.topology, plane_cut(point, normal, 0.05));
    cells.insert(cells.end(), edit.cells.begin(), edit.cells.end());
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  other.cut_surface->update(*other.topology, cells);
  EXPECT_EQ(one.cut_surface->triangles().size(), other.cut_surface->triangles().size());
  const auto corners = [](const CutCase& body) {
    std::vector<std::array<Vec3d, 3>> out;
    for (const auto& t : body.cut_surface->triangles()) {
      std::array<Vec3d, 3> x{};
      for (int i = 0; i < 3; ++i) x[i] = body.cut_surface->vertices()[t[i]].rest;
      std::rotate(x.begin(), std::min_element(x.begin(), x.end()), x.end());
      out.push_back(x);
    }
    std::sort(out.begin(), out.end());
    return out;
  };
  double difference = 0;  // triangulations may differ where polygons begin elsewhere; what they cover does not
  for (const CutCase* body : {&one, &other}) {
    double area = 0;
    for (const auto& x : corners(*body)) area += vec::norm(vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0])));
    difference = area - difference;
  }
  EXPECT_NEAR(difference, 0, 1e-12);
}

TEST(CutSurface, NumbersAreStable) {
  const TriangleMesh mesh = shape("liver");
  CutCase body(mesh, 0.016);
  body.cut({0.01, 0, 0}, {1, 0.1, 0});
  const auto first = body.cut_surface->vertices();
  const auto triangles = body.cut_surface->triangles();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) ASSERT_EQ(first[v].rest, mesh.vertices[v]);
  static_cast<void>(body.cut_surface->take_changes());
  body.cut({-0.05, 0, 0}, {1, 0.1, 0});
  for (std::size_t v = 0; v < first.size(); ++v) ASSERT_EQ(body.cut_surface->vertices()[v].rest, first[v].rest);
  const SurfaceChanges changes = body.cut_surface->take_changes();
  EXPECT_FALSE(changes.triangles.empty());
  for (std::size_t v = 0; v < body.cut_surface->vertices().size(); ++v) {
    if (std::binary_search(changes.vertices.begin(), changes.vertices.end(), static_cast<std::int32_t>(v))) continue;
    ASSERT_LT(v, first.size());
    ASSERT_EQ(body.cut_surface->vertices()[v].carrier, first[v].carrier);
  }
  for (std::size_t t = 0; t < body.cut_surface->triangles().size(); ++t) {
    if (std::binary_search(changes.triangles.begin(), changes.triangles.end(), static_cast<std::int32_t>(t))) continue;
    ASSERT_LT(t, triangles.size());
    ASSERT_EQ(body.cut_surface->triangles()[t], triangles[t]);
  }
  EXPECT_LT(changes.triangles.size(), triangles.size() / 2);
  EXPECT_LT(changes.vertices.size(), first.size() / 2);
}

// Every vertex of a piece is embedded in the same piece of the topology, so that pieces come apart as wholes.
TEST(CutSurface, PiecesHangInTheirOwnElements) {
  std::mt19937 random(3);
  // The skin of the second cube lies on faces of the lattice.
  for (const auto& [name, spacing] :
       {std::pair("cube", 0.0127), {"cube", 0.0125}, {"sphere", 0.0127}, {"liver", 0.0127}, {"kidney", 0.0127}}) {
    CutCase body(shape(name), spacing);
    for (int c = 0; c < 2; ++c) body.cut(body.somewhere(random), direction(random));
    std::vector<std::int32_t> piece_of;
    static_cast<void>(body.topology->pieces(&piece_of));
    std::vector<std::int32_t> piece_of_node(body.topology->elements().origin.size(), -1);
    for (std::size_t e = 0; e < piece_of.size(); ++e) {
      for (const std::int32_t n : body.topology->elements().nodes[e]) piece_of_node[n] = piece_of[e];
    }
    std::array<std::int32_t, 8> nodes{};
    std::array<double, 8> weights{};
    for (const auto& t : body.cut_surface->triangles()) {
      std::set<std::int32_t> pieces;
      for (const std::int32_t v : t) {
        body.cut_surface->embedding(*body.topology, v, nodes, weights);
        pieces.insert(piece_of_node[nodes[0]]);
        Vec3d x{};
        for (int a = 0; a < 8; ++a) {
          const std::int32_t origin = body.topology->elements().origin[nodes[a]];
          x = vec::add(x, vec::mul(body.topology->mesh().rest[origin], weights[a]));
        }
        ASSERT_LT(vec::norm(vec::sub(x, body.cut_surface->vertices()[v].rest)), 1e-12);
      }
      ASSERT_EQ(pieces.size(), 1U) << name << " " << spacing;
    }
    EXPECT_EQ(static_cast<std::int32_t>(body.pieces().size()), body.topology->pieces()) << name << " " << spacing;
  }
}

// Cuts along faces and through nodes of the lattice, whole ones and short ones, in a box whose skin lies on the lattice: fronts
// of cuts meet on the sharp edges of the box.
TEST(CutSurface, AnyCutsOfABoxLeaveItClosed) {
  const auto box = box_surface({0.04, 0.03, 0.03});
  const unsigned seeds = std::getenv("PLIANT_RANDOM_CUTS") != nullptr ? 1000 : 50;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    std::mt19937 random(seed);
    CutCase body(*box, 0.01);
    for (int c = 0; c < 4; ++c) {
      Vec3d point = body.somewhere(random), normal = direction(random);
      if (random() % 3 == 0) {
        for (double& v : point) v = 0.01 * std::round(v / 0.01);
      }
      if (random() % 3 == 0) {
        const std::size_t axis = random() % 3;
        normal = {};
        normal[axis] = 1;
        if (random() % 2 == 0) normal[(axis + 1) % 3] = 1;
      }
      body.cut(point, normal, random() % 2 == 0 ? 100 : 0.012);
      body.expect_closed();
      if (HasFatalFailure()) FAIL() << "seed " << seed << ", cut " << c;
    }
  }
}

// The bunny has holes below, and places where several cells of the lattice share one cell of the grid.
TEST(CutSurface, Bunny) {
  const char* file = "/usr/share/glmark2/models/bunny.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not installed";
  CutCase body(read_surface(file), 0.11);
  const Vec3d middle = vec::mul(vec::add(body.box.lower, body.box.upper), 0.5);
  body.cut(middle, {0.1, 0.2, 1});
  body.expect_closed();
  body.cut(middle, {1, 0.2, 0.1}, 0.4);
  body.expect_closed();
}

TEST(CutSurface, HolesAreClosed) {
  TriangleMesh mesh = shape("sphere");
  std::erase_if(mesh.triangles, [&](const auto& t) { return mesh.vertices[t[0]][2] < -0.085; });
  CutCase body(mesh, 0.023);
  std::int64_t fillers = 0;
  for (const SurfaceKind kind : body.cut_surface->kinds()) fillers += kind == SurfaceKind::filler ? 1 : 0;
  EXPECT_GT(fillers, 0);
  body.expect_closed();
  body.cut({0.013, 0, 0}, {1, 0.2, 0});  // through the hole
  body.expect_closed();
  EXPECT_EQ(body.pieces().size(), 2U);
}

}  // namespace
}  // namespace pliant::cut_test
