#include "cutting/cut_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

#include "cutting/surface/tet_surface.h"
#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Which real nodes each virtual node goes with: those of the elements that it belongs to.
VirtualNodes anchors_of(const CutTopology& cut) {
  const CutElements& e = cut.elements();
  const int corners = cut.mesh().shape->corners;
  const auto real = static_cast<std::int32_t>(cut.mesh().rest.size());
  const std::size_t count = e.origin.size() - cut.mesh().rest.size();
  VirtualNodes out;
  if (count > 0) out.first = real;
  std::vector<std::int32_t> next(count + 1, 0);
  const auto for_corners = [&](auto&& visit) {  // visit(virtual node, element)
    for (std::size_t i = 0; i < e.nodes.size() && count > 0; ++i) {
      if (e.real[i] == (1 << corners) - 1) continue;
      for (int a = 0; a < corners; ++a) {
        if (e.nodes[i][a] >= real) visit(static_cast<std::size_t>(e.nodes[i][a] - real), i);
      }
    }
  };
  for_corners([&](std::size_t n, std::size_t i) { next[n + 1] += std::popcount(e.real[i]); });
  std::partial_sum(next.begin(), next.end(), next.begin());
  const std::vector<std::int32_t> begin = next;
  std::vector<std::int32_t> all(static_cast<std::size_t>(next.back()));
  for_corners([&](std::size_t n, std::size_t i) {
    for (int b = 0; b < corners; ++b) {
      if ((e.real[i] >> b & 1) != 0) all[next[n]++] = e.nodes[i][b];
    }
  });
  out.offset.push_back(0);
  for (std::size_t n = 0; n < count; ++n) {
    std::sort(all.begin() + begin[n], all.begin() + begin[n + 1]);
    const auto last = std::unique(all.begin() + begin[n], all.begin() + begin[n + 1]);
    out.anchor.insert(out.anchor.end(), all.begin() + begin[n], last);
    out.offset.push_back(static_cast<std::int32_t>(out.anchor.size()));
  }
  return out;
}

/// Elements 0 .. cells - 1 that are cut, and all copies behind them.
void set_elements(const BodyMesh& uncut, const CutTopology& cut, BodyElements& solid) {
  const CutElements& e = cut.elements();
  const bool lattice = cut.mesh().shape->corners == 8, tets = !uncut.tets.empty();
  const std::size_t cells = cut.mesh().cells.size(), count = e.nodes.size(), parts = tets && lattice ? kKuhnTets.size() : 1;
  solid.copy_of = e.cell;
  solid.fill.resize(parts * count);
  if (tets) solid.tets.resize(parts * count);
  if (!tets) solid.hexes.resize(count);
  if (!uncut.cells.empty()) solid.cells.resize(count);
  const auto set = [&](std::size_t i) {
    if (!tets) solid.hexes[i] = e.nodes[i];
    for (std::size_t p = 0; p < parts; ++p) {
      solid.fill[parts * i + p] = e.fill[i];
      if (!tets) continue;
      for (std::size_t a = 0; a < 4; ++a) solid.tets[parts * i + p][a] = e.nodes[i][lattice ? kKuhnTets[p][a] : a];
    }
    if (uncut.cells.empty()) return;
    if (i >= cells) solid.cells[i] = uncut.cells[e.cell[i]];
    solid.cells[i].nodes = e.nodes[i];
    solid.cells[i].fill = e.fill[i];
  };
  for (const auto& [cell, how] : cut.cells()) {
    if (how.components > 1) set(static_cast<std::size_t>(cell));
  }
  for (std::size_t i = cells; i < count; ++i) set(i);
}

void set_nodes(const BodyMesh& uncut, const CutTopology& cut, BodyElements& solid) {
  const std::vector<std::int32_t>& origin = cut.elements().origin;
  solid.nodes.resize(uncut.nodes.size());
  solid.lattice_nodes.resize(uncut.lattice_nodes.size());
  int copies = 0;  // of one origin; they follow each other
  for (std::size_t n = uncut.nodes.size(); n < origin.size(); ++n) {
    solid.nodes.push_back(uncut.nodes[origin[n]]);
    if (uncut.lattice_nodes.empty()) continue;
    copies = n > uncut.nodes.size() && origin[n - 1] == origin[n] ? copies + 1 : 1;
    LatticeNode node = uncut.lattice_nodes[origin[n]];
    node.copy += copies;
    solid.lattice_nodes.push_back(node);
  }
  solid.virtual_nodes = anchors_of(cut);
  solid.whole_nodes = uncut.nodes.size();
}

void embed_vertex(const CutSurfaceVertex& from, const CutTopology& cut, std::array<std::int32_t, 8>& nodes) {
  const std::int32_t element = cut.element_of(from.carrier.cell, from.carrier.label);
  nodes = cut.elements().nodes[element >= 0 ? element : from.carrier.cell];
}

void place_vertex(const CutSurfaceVertex& from, std::size_t v, BodySurface& solid) {
  solid.surface[v] = from.rest;
  solid.surface_cell[v] = from.carrier.cell;
  for (std::size_t a = 0; a < 8; ++a) {
    solid.surface_weights[v][a] = ((a & 1) != 0 ? from.local[0] : 1 - from.local[0]) *
                                  ((a & 2) != 0 ? from.local[1] : 1 - from.local[1]) *
                                  ((a & 4) != 0 ? from.local[2] : 1 - from.local[2]);
  }
}

void set_triangle(const CutSurface& surface, const BodyMesh& uncut, std::size_t t, BodySurface& solid) {
  solid.triangles[t] = surface.triangles()[t];
  solid.triangle_cut[t] = surface.kinds()[t] == SurfaceKind::cut ? 1 : 0;
  const std::int32_t original = surface.original_of(static_cast<std::int32_t>(t));
  const bool part = original >= 0 && original < static_cast<std::int32_t>(uncut.triangles.size());
  if (solid.texture != nullptr) solid.triangle_source[t] = part ? original : -1;
  if (!solid.wants_middles) return;
  const double none = std::numeric_limits<double>::quiet_NaN();
  solid.triangle_middle[t] = {none, none, none};
  if (!part) return;
  const auto& [a, b, c] = uncut.triangles[original];
  solid.triangle_middle[t] = vec::mul(vec::add(vec::add(uncut.surface[a], uncut.surface[b]), uncut.surface[c]), 1.0 / 3);
}

void resize_surface(const CutSurface& surface, BodySurface& solid) {
  const std::size_t vertices = surface.vertices().size(), triangles = surface.triangles().size();
  solid.surface.resize(vertices);
  solid.surface_nodes.resize(vertices);
  solid.surface_weights.resize(vertices);
  solid.surface_cell.resize(vertices, -1);
  solid.triangles.resize(triangles);
  solid.triangle_cut.resize(triangles);
  solid.triangle_middle.resize(solid.wants_middles ? triangles : 0);
  solid.triangle_source.resize(solid.texture != nullptr ? triangles : 0);
}

/// The split and capped surface in place of the one that `solid` has.
void hang_surface(const CutSurface& surface, const CutTopology& cut, const BodyMesh& uncut, BodySurface& solid) {
  resize_surface(surface, solid);
  for (std::size_t v = 0; v < solid.surface.size(); ++v) {
    place_vertex(surface.vertices()[v], v, solid);
    embed_vertex(surface.vertices()[v], cut, solid.surface_nodes[v]);
  }
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) set_triangle(surface, uncut, t, solid);
  solid.changes.reset();
}

}  // namespace

std::shared_ptr<const CutMesh> cut_mesh(const BodyMesh& solid, const std::string& name) {
  auto mesh = std::make_shared<CutMesh>();
  mesh->rest = solid.nodes;
  if (!solid.lattice_nodes.empty()) {
    mesh->shape = &lattice_cell_shape();
    mesh->material = solid.samples;
    mesh->cells = solid.hexes;
    mesh->fill = solid.fill;
    for (std::size_t t = 0; t < solid.tets.size(); t += kKuhnTets.size()) {
      if (t == 0) mesh->fill.clear();
      mesh->cells.push_back(cell_corners(&solid.tets[t]));
      mesh->fill.push_back(solid.fill[t]);
    }
    return mesh;
  }
  if (solid.tets.empty()) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("body '{}' is a volume mesh of hexahedra, which cannot be cut; allowed are lattices (\"surface\") and "
                    "volume meshes of tetrahedra",
                    name));
  }
  mesh->shape = &tetrahedron_shape();
  for (const auto& tet : solid.tets) mesh->cells.push_back({tet[0], tet[1], tet[2], tet[3], 0, 0, 0, 0});
  mesh->fill = solid.fill;
  return mesh;
}

void update_body_elements(const BodyMesh& uncut, const CutTopology& cut, BodyElements& solid) {
  set_nodes(uncut, cut, solid);
  set_elements(uncut, cut, solid);
}

void update_body_surface(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface, BodySurface& solid) {
  if (surface != nullptr) {
    hang_surface(*surface, cut, uncut, solid);
    return;
  }
  if (uncut.lattice_nodes.empty() && cut.mesh().shape->corners == 4) return cut_tet_surface(cut, uncut, solid);
  for (std::size_t v = 0; v < solid.surface_cell.size(); ++v) {
    const std::int32_t cell = solid.surface_cell[v];
    const std::int32_t element = cut.element_of(cell, cut.label_at(cell, solid.surface[v]));
    solid.surface_nodes[v] = cut.elements().nodes[element >= 0 ? element : cell];
  }
}

void patch_body_surface(const BodyMesh& uncut, const CutTopology& cut, const CutSurface& surface, SurfaceChanges changes,
                        BodySurface& solid) {
  const bool has_middles = !solid.triangle_middle.empty() || !solid.wants_middles;
  const bool has_sources = !solid.triangle_source.empty() || solid.texture == nullptr;
  resize_surface(surface, solid);
  for (std::size_t t = 0; t < solid.triangles.size() && !(has_middles && has_sources); ++t)
    set_triangle(surface, uncut, t, solid);
  for (const std::int32_t v : changes.vertices) {
    place_vertex(surface.vertices()[v], static_cast<std::size_t>(v), solid);
  }
  changes.reembedded.clear();
  auto next = changes.vertices.begin();
  for (std::size_t v = 0; v < solid.surface_cell.size(); ++v) {
    const bool changed = next != changes.vertices.end() && static_cast<std::size_t>(*next) == v;
    if (changed) ++next;
    // Every edit renumbers the nodes of divided cells.
    if (!changed && !cut.divided(solid.surface_cell[v])) continue;
    embed_vertex(surface.vertices()[v], cut, solid.surface_nodes[v]);
    changes.reembedded.push_back(static_cast<std::int32_t>(v));
  }
  for (const std::int32_t t : changes.triangles) set_triangle(surface, uncut, static_cast<std::size_t>(t), solid);
  solid.changes = std::move(changes);
}

void update_body_mesh(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface, BodyMesh& solid) {
  update_body_elements(uncut, cut, solid);
  update_body_surface(uncut, cut, surface, solid);
}

BodyMesh cut_body_mesh(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface) {
  BodyMesh solid = uncut;
  update_body_mesh(uncut, cut, surface, solid);
  return solid;
}

}  // namespace pliant
