// Blade paths from bytes: whatever is swept over whatever body, however it is deformed, the cut body and its surface stay
// consistent.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>

#include "cutting/blade/blade.h"
#include "cutting/blade/blade_trace.h"
#include "cutting/surface/cut_surface.h"
#include "cutting/topology/cut_topology.h"
#include "geometry/vec.h"
#include "lattice/lattice.h"

namespace {

using namespace pliant;

constexpr double kSpacing = 0.9;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

struct Bytes {
  const std::uint8_t* data;
  std::size_t left;
  int next() {
    if (left == 0) return 0;
    --left;
    return *data++;
  }
  /// Eighths of a cell, so that nodes, edges and faces are hit exactly, now and then anything between.
  double coordinate() {
    const int b = next();
    return b < 200 ? (b - 80) * kSpacing / 8 : (b - 208) * 0.137;
  }
  Vec3d point() { return {coordinate(), coordinate(), coordinate()}; }
};

TriangleMesh wedge() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {3.2, 0.1, 0}, {2.9, 3.1, 0.2}, {0.1, 2.8, 0}, {0.3, 0.2, 2.1}, {2.6, 0.4, 1.7}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 2}, {4, 2, 3}, {0, 1, 5}, {0, 5, 4}, {1, 2, 5}, {0, 4, 3}};
  return mesh;
}

/// One body, as a lattice with a surface and as a mesh of tetrahedra.
struct Base {
  TriangleMesh surface = wedge();
  Lattice lattice;
  std::shared_ptr<CutMesh> cells = std::make_shared<CutMesh>(), tets = std::make_shared<CutMesh>();
  Base() {
    LatticeSpec spec;
    spec.spacing = kSpacing;
    lattice = build_lattice(surface, spec);
    cells->shape = &lattice_cell_shape();
    tets->shape = &tetrahedron_shape();
    for (const LatticeNode& n : lattice.nodes) cells->rest.push_back(lattice.position(n));
    tets->rest = cells->rest;
    for (const Cell& c : lattice.cells) {
      cells->cells.push_back(c.nodes);
      cells->fill.push_back(c.fill);
      cells->material.push_back(c.samples);
      for (const auto& t : kKuhnTets) {
        tets->cells.push_back({c.nodes[t[0]], c.nodes[t[1]], c.nodes[t[2]], c.nodes[t[3]], 0, 0, 0, 0});
        tets->fill.push_back(1);
      }
    }
  }
};

void check(const CutTopology& body) {
  const CutElements& e = body.elements();
  const CutMesh& mesh = body.mesh();
  std::vector<double> fill(mesh.cells.size(), 0.0);
  std::vector<char> used(e.origin.size(), 0);
  for (std::size_t i = 0; i < e.nodes.size(); ++i) {
    require(e.cell[i] >= 0 && e.cell[i] < static_cast<std::int32_t>(mesh.cells.size()), "an element of no cell");
    require(e.fill[i] > 0, "an element without fill");
    fill[e.cell[i]] += e.fill[i];
    for (int a = 0; a < mesh.shape->corners; ++a) {
      const std::int32_t n = e.nodes[i][a];
      require(n >= 0 && n < static_cast<std::int32_t>(e.origin.size()), "a stale node");
      require(e.origin[n] == mesh.cells[e.cell[i]][a], "a node at another place");
      used[n] = 1;
    }
  }
  for (std::size_t c = 0; c < fill.size(); ++c) require(std::abs(fill[c] - mesh.fill[c]) < 1e-12, "fill that does not add up");
  for (std::size_t n = mesh.rest.size(); n < used.size(); ++n) require(used[n] != 0, "a node without an element");
}

void check_edit(const CutEdit& edit, const CutElements& before, const CutElements& now) {
  if (!edit.changed_elements()) return;
  require(edit.node_from.size() == now.origin.size() && edit.element_from.size() == now.nodes.size(),
          "an edit of another size");
  for (const std::int32_t n : edit.node_from)
    require(n >= 0 && n < static_cast<std::int32_t>(before.origin.size()), "a stale origin");
  for (const std::int32_t i : edit.element_from)
    require(i >= 0 && i < static_cast<std::int32_t>(before.nodes.size()), "a stale element");
  std::vector<double> inherited(before.nodes.size(), 0.0);
  for (std::size_t i = 0; i < now.nodes.size(); ++i) inherited[edit.element_from[i]] += now.fill[i];
  for (std::size_t i = 0; i < inherited.size(); ++i)
    require(std::abs(inherited[i] - before.fill[i]) < 1e-12, "fill that changed hands");
}

double volume(const CutSurface& surface) {
  double six = 0;
  for (const auto& t : surface.triangles()) {
    six += vec::dot(surface.vertices()[t[0]].rest, vec::cross(surface.vertices()[t[1]].rest, surface.vertices()[t[2]].rest));
  }
  return six / 6;
}

void check(const CutSurface& surface, const CutTopology& body, double whole) {
  std::map<std::array<std::int32_t, 2>, std::array<int, 2>> edges;
  for (const auto& t : surface.triangles()) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      require(a >= 0 && a < static_cast<std::int32_t>(surface.vertices().size()), "a stale vertex");
      ++edges[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
      std::array<std::int32_t, 8> nodes{};
      std::array<double, 8> weights{};
      surface.embedding(body, a, nodes, weights);
      for (const std::int32_t n : nodes)
        require(n >= 0 && n < static_cast<std::int32_t>(body.elements().origin.size()), "a vertex embedded in a stale node");
    }
  }
  for (const auto& [edge, count] : edges) require(count[0] == 1 && count[1] == 1, "an edge without exactly two triangles");
  require(std::abs(volume(surface) - whole) < 1e-9 * whole, "volume that was lost");
}

/// Where the nodes are: real ones as they were moved, virtual ones a little beside them, as where a cut gapes.
std::vector<Vec3d> positions(const CutTopology& body, const std::vector<Vec3d>& moved, double gape) {
  std::vector<Vec3d> x;
  const auto& origin = body.elements().origin;
  for (std::size_t n = 0; n < origin.size(); ++n) {
    x.push_back(vec::add(body.mesh().rest[origin[n]], moved[origin[n]]));
    if (n < moved.size()) continue;
    const double turn = 2.4 * static_cast<double>(n);
    x.back() = vec::add(x.back(), {gape * std::cos(turn), gape * std::sin(turn), gape * std::cos(1.7 * turn)});
  }
  return x;
}

void move_a_node(Bytes& in, std::vector<Vec3d>& moved) {
  Vec3d& m = moved[static_cast<std::size_t>(in.next()) % moved.size()];
  const Vec3d by = in.point();
  m = vec::add(m, {by[0] / 32, by[1] / 32, by[2] / 32});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Base base;
  Bytes in{data, size};
  const bool tets = in.next() % 3 == 0;
  CutTopology body(tets ? base.tets : base.cells);
  RestEdges edges(body.mesh(), kSpacing);
  std::unique_ptr<CutSurface> surface;
  if (!tets) surface = std::make_unique<CutSurface>(base.surface, base.lattice);
  const double whole = tets ? 0 : volume(*surface);
  const double gape = in.next() * 0.001;
  std::vector<Vec3d> moved(body.mesh().rest.size());
  BladeTrace front{{in.point(), in.point()}, 0, {}};
  if (front.blade[0] == front.blade[1]) return 0;
  for (int k = 0; k < 12 && in.left > 6; ++k) {
    const int how = in.next();
    if (how % 4 == 0) move_a_node(in, moved);
    const CutElements before = body.elements();
    const std::vector<Vec3d> x = positions(body, moved, gape);
    const BladeSegment next{how % 8 == 1 ? front.blade[0] : in.point(), in.point()};
    CutEdges crossed;
    if (how % 16 == 2) {
      crossed = crossed_edges(body, x, sweep(front.blade, next));
    } else if (next[0] != next[1]) {
      BladeSweep blade(body, x, edges, kSpacing);
      if (how % 16 == 3) front = {next, 0, {}};  // lifted and put there
      blade.move(front, next);
      crossed = blade.crossed();
    }
    const CutEdit edit = body.cut(crossed);
    check_edit(edit, before, body.elements());
    check(body);
    if (surface == nullptr || !edit.changed_elements()) continue;
    surface->update(body, edit.cells);
    check(*surface, body, whole);
  }
  CutTopology fresh(tets ? base.tets : base.cells);
  fresh.cut(body.edges());
  require(fresh.elements().nodes == body.elements().nodes && fresh.elements().cell == body.elements().cell,
          "the history of the cuts shows");
  return 0;
}
