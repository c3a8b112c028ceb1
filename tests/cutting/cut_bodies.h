// Small bodies to cut, blades, and what must hold of every cut body.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <set>

#include "cutting/blade/blade.h"
#include "cutting/topology/cut_topology.h"
#include "geometry/disjoint_sets.h"
#include "geometry/vec.h"
#include "lattice/lattice.h"

namespace pliant::cut_test {

/// A box of cells of edge 1 from the origin; with `tets` their Kuhn tetrahedra as a volume mesh.
inline std::shared_ptr<CutMesh> box_mesh(int nx, int ny, int nz, bool tets = false) {
  auto mesh = std::make_shared<CutMesh>();
  mesh->shape = tets ? &tetrahedron_shape() : &lattice_cell_shape();
  const auto node = [&](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) mesh->rest.push_back({1.0 * i, 1.0 * j, 1.0 * k});
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        std::array<std::int32_t, 8> corners{};
        for (int a = 0; a < 8; ++a) corners[a] = node(i + (a & 1), j + (a >> 1 & 1), k + (a >> 2));
        if (!tets) mesh->cells.push_back(corners);
        for (const auto& t : kKuhnTets) {
          if (tets) mesh->cells.push_back({corners[t[0]], corners[t[1]], corners[t[2]], corners[t[3]], 0, 0, 0, 0});
        }
      }
    }
  }
  mesh->fill.assign(mesh->cells.size(), 1.0);
  return mesh;
}

/// A square of edge 2 `reach` around `point`, as what a blade of that length sweeps.
inline std::vector<SweepTriangle> plane_cut(const Vec3d& point, const Vec3d& normal, double reach = 100) {
  const Vec3d helper = std::abs(normal[0]) < 0.6 * vec::norm(normal) ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d u = vec::cross(normal, helper);
  u = vec::mul(u, reach / vec::norm(u));
  Vec3d v = vec::cross(normal, u);
  v = vec::mul(v, reach / vec::norm(v));
  return sweep({vec::add(vec::sub(point, u), v), vec::sub(vec::sub(point, u), v)},
               {vec::add(vec::add(point, u), v), vec::sub(vec::add(point, u), v)});
}

/// Cut with the body at rest.
inline CutEdit cut_at_rest(CutTopology& body, const std::vector<SweepTriangle>& triangles) {
  return body.cut(crossed_edges(body, body.mesh().rest, triangles));
}

/// Volume of each piece in cells of edge 1 (or in tetrahedra of a sixth).
inline std::vector<double> piece_volumes(const CutTopology& body) {
  std::vector<std::int32_t> piece;
  std::vector<double> volume(static_cast<std::size_t>(body.pieces(&piece)), 0.0);
  const double unit = body.mesh().shape->corners == 8 ? 1 : 1.0 / 6;
  for (std::size_t e = 0; e < piece.size(); ++e) volume[piece[e]] += unit * body.elements().fill[e];
  return volume;
}

inline void expect_same(const CutElements& a, const CutElements& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.real, b.real);
  EXPECT_EQ(a.fill, b.fill);
  EXPECT_EQ(a.origin, b.origin);
}

/// The definition of the virtual node algorithm, over all copies at once: the set of corners (element, corner) of each node.
inline std::vector<std::int32_t> nodes_by_definition(const CutTopology& body) {
  const CutMesh& mesh = body.mesh();
  const CutElements& e = body.elements();
  const int corners = mesh.shape->corners;
  const auto count = static_cast<std::int32_t>(e.nodes.size());
  DisjointSets sets(e.nodes.size() * 8);
  const auto corner_with = [&](std::int32_t element, std::int32_t node) {
    for (int a = 0; a < corners; ++a) {
      if (mesh.cells[e.cell[element]][a] == node) return a;
    }
    return -1;
  };
  for (std::int32_t i = 0; i < count; ++i) {
    for (std::int32_t j = i + 1; j < count; ++j) {
      if (e.cell[i] == e.cell[j]) continue;
      for (int a = 0; a < corners; ++a) {
        const int b = corner_with(j, mesh.cells[e.cell[i]][a]);
        if (b >= 0 && (e.real[i] >> a & 1) && (e.real[j] >> b & 1)) sets.join(8 * i + a, 8 * j + b);
      }
      for (const auto& face : mesh.shape->faces) {
        bool shared = true, real = false;
        for (const int a : face) {
          const int b = corner_with(j, mesh.cells[e.cell[i]][a]);
          shared = shared && b >= 0;
          real = real || (b >= 0 && (e.real[i] >> a & 1) && (e.real[j] >> b & 1));
        }
        if (!shared || !real) continue;
        for (const int a : face) sets.join(8 * i + a, 8 * j + corner_with(j, mesh.cells[e.cell[i]][a]));
      }
    }
  }
  std::vector<std::int32_t> root;
  for (std::int32_t k = 0; k < 8 * count; ++k) root.push_back(k % 8 < corners ? sets.find(k) : -1);
  return root;
}

/// What holds of every cut body; `definition` also looks at all pairs of elements.
inline void check_body(const CutTopology& body, bool definition = true) {
  const CutMesh& mesh = body.mesh();
  const CutElements& e = body.elements();
  const int corners = mesh.shape->corners;
  const auto nodes = static_cast<std::int32_t>(e.origin.size());
  ASSERT_EQ(e.nodes.size(), e.cell.size());
  ASSERT_EQ(e.nodes.size(), e.real.size());
  ASSERT_EQ(e.nodes.size(), e.fill.size());
  std::vector<char> used(e.origin.size(), 0);
  std::vector<double> fill(mesh.cells.size(), 0.0);
  std::vector<int> real(mesh.cells.size(), 0);
  for (std::size_t i = 0; i < e.nodes.size(); ++i) {
    ASSERT_GE(e.cell[i], 0);
    ASSERT_LT(e.cell[i], static_cast<std::int32_t>(mesh.cells.size()));
    if (i < mesh.cells.size()) {
      ASSERT_EQ(e.cell[i], static_cast<std::int32_t>(i));
    }
    EXPECT_GT(e.fill[i], 0);
    fill[e.cell[i]] += e.fill[i];
    EXPECT_EQ(real[e.cell[i]] & e.real[i], 0) << "a corner is real in two copies";
    real[e.cell[i]] |= e.real[i];
    for (int a = 0; a < corners; ++a) {
      const std::int32_t n = e.nodes[i][a];
      ASSERT_GE(n, 0);
      ASSERT_LT(n, nodes);
      used[n] = 1;
      EXPECT_EQ(e.origin[n], mesh.cells[e.cell[i]][a]);
      if (e.real[i] >> a & 1) {
        EXPECT_EQ(n, e.origin[n]);
      }
    }
  }
  for (std::size_t c = 0; c < fill.size(); ++c) EXPECT_NEAR(fill[c], mesh.fill[c], 1e-13);
  for (const char u : used) EXPECT_EQ(u, 1) << "a node without an element";
  if (!definition) return;
  const std::vector<std::int32_t> root = nodes_by_definition(body);
  std::map<std::int32_t, std::int32_t> node_of;
  std::set<std::int32_t> taken;
  for (std::size_t k = 0; k < root.size(); ++k) {
    if (root[k] < 0) continue;
    const std::int32_t n = e.nodes[k / 8][k % 8];
    const auto [at, added] = node_of.emplace(root[k], n);
    ASSERT_EQ(at->second, n) << "corners that are one node have two numbers";
    if (added) {
      ASSERT_TRUE(taken.insert(n).second) << "two nodes have one number";
    }
  }
}

/// The same set of edges at once gives the same copies. What they hold depends on the order: later cuts divide each copy's own.
inline void check_from_scratch(const CutTopology& body, const std::shared_ptr<const CutMesh>& mesh) {
  CutTopology fresh(mesh);
  fresh.cut(body.edges());
  CutElements at_once = fresh.elements();
  at_once.fill = body.elements().fill;
  expect_same(at_once, body.elements());
}

}  // namespace pliant::cut_test
