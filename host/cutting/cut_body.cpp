#include "cutting/cut_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "model/vec.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Which real nodes each virtual node goes with: those of the elements that it belongs to.
VirtualNodes anchors_of(const CutTopology& cut) {
  const CutElements& e = cut.elements();
  const std::size_t real = cut.mesh().rest.size(), count = e.origin.size() - real;
  std::vector<std::vector<std::int32_t>> anchors(count);
  for (std::size_t i = 0; i < e.nodes.size() && count > 0; ++i) {
    for (int a = 0; a < cut.mesh().shape->corners; ++a) {
      if (e.nodes[i][a] < static_cast<std::int32_t>(real)) continue;
      auto& list = anchors[static_cast<std::size_t>(e.nodes[i][a]) - real];
      for (int b = 0; b < cut.mesh().shape->corners; ++b) {
        if (e.real[i] >> b & 1) list.push_back(e.nodes[i][b]);
      }
    }
  }
  VirtualNodes out;
  if (count > 0) out.first = static_cast<std::int32_t>(real);
  out.offset.push_back(0);
  for (auto& list : anchors) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    out.anchor.insert(out.anchor.end(), list.begin(), list.end());
    out.offset.push_back(static_cast<std::int32_t>(out.anchor.size()));
  }
  return out;
}

void set_elements(const CutTopology& cut, Solid& solid) {
  const CutElements& e = cut.elements();
  const bool lattice = cut.mesh().shape->corners == 8, tets = !solid.tets.empty();
  solid.copy_of = e.cell;
  solid.fill.clear();
  solid.tets.clear();
  solid.hexes.clear();
  for (std::size_t i = 0; i < e.nodes.size(); ++i) {
    if (!tets) solid.hexes.push_back(e.nodes[i]);
    if (tets && !lattice) solid.tets.push_back({e.nodes[i][0], e.nodes[i][1], e.nodes[i][2], e.nodes[i][3]});
    if (tets && lattice) {
      for (const auto& t : kKuhnTets) {
        solid.tets.push_back({e.nodes[i][t[0]], e.nodes[i][t[1]], e.nodes[i][t[2]], e.nodes[i][t[3]]});
      }
    }
    solid.fill.resize(solid.fill.size() + (tets && lattice ? kKuhnTets.size() : 1), e.fill[i]);
  }
  for (std::size_t i = 0; i < e.nodes.size() && !solid.cells.empty(); ++i) {
    if (i >= cut.mesh().cells.size()) solid.cells.push_back(solid.cells[e.cell[i]]);
    solid.cells[i].nodes = e.nodes[i];
    solid.cells[i].fill = e.fill[i];
  }
}

}  // namespace

std::shared_ptr<const CutMesh> cut_mesh(const Solid& solid, const std::string& name) {
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
        fmt::format("body '{}' is a volume mesh of hexahedra, which cannot be cut; allowed are lattices (\"surface\") and "
                    "volume meshes of tetrahedra",
                    name));
  }
  mesh->shape = &tetrahedron_shape();
  for (const auto& tet : solid.tets) mesh->cells.push_back({tet[0], tet[1], tet[2], tet[3], 0, 0, 0, 0});
  mesh->fill = solid.fill;
  return mesh;
}

Solid cut_solid(const Solid& uncut, const CutTopology& cut) {
  Solid solid = uncut;
  const std::size_t real = cut.mesh().rest.size();
  const std::vector<std::int32_t>& origin = cut.elements().origin;
  std::map<std::int32_t, std::int32_t> copies;
  for (std::size_t n = real; n < origin.size(); ++n) {
    solid.nodes.push_back(uncut.nodes[origin[n]]);
    if (uncut.lattice_nodes.empty()) continue;
    LatticeNode node = uncut.lattice_nodes[origin[n]];
    node.copy += ++copies[origin[n]];
    solid.lattice_nodes.push_back(node);
  }
  set_elements(cut, solid);
  solid.virtual_nodes = anchors_of(cut);
  for (std::size_t v = 0; v < solid.surface_cell.size(); ++v) {
    const std::int32_t cell = solid.surface_cell[v];
    const std::int32_t element = cut.element_of(cell, cut.label_at(cell, solid.surface[v]));
    solid.surface_nodes[v] = cut.elements().nodes[element >= 0 ? element : cell];
  }
  return solid;
}

void hang_surface(const CutSurface& surface, const CutTopology& cut, Solid& solid) {
  const std::vector<Vec3d> middles = [&] {
    std::vector<Vec3d> all;
    for (const auto& t : solid.triangles) {
      const Vec3d sum = vec::add(vec::add(solid.surface[t[0]], solid.surface[t[1]]), solid.surface[t[2]]);
      all.push_back(vec::mul(sum, 1.0 / 3));
    }
    return all;
  }();
  solid.surface.clear();
  solid.surface_nodes.clear();
  solid.surface_weights.clear();
  solid.surface_cell.clear();
  for (const CutSurfaceVertex& v : surface.vertices()) {
    const std::int32_t element = cut.element_of(v.carrier.cell, v.carrier.label);
    std::array<double, 8> weights{};
    for (int a = 0; a < 8; ++a) {
      weights[a] = ((a & 1) ? v.local[0] : 1 - v.local[0]) * ((a & 2) ? v.local[1] : 1 - v.local[1]) *
                   ((a & 4) ? v.local[2] : 1 - v.local[2]);
    }
    solid.surface.push_back(v.rest);
    solid.surface_nodes.push_back(cut.elements().nodes[element >= 0 ? element : v.carrier.cell]);
    solid.surface_weights.push_back(weights);
    solid.surface_cell.push_back(v.carrier.cell);
  }
  solid.triangles = surface.triangles();
  solid.triangle_middle.clear();
  solid.triangle_cut.clear();
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    const std::int32_t original = surface.original_of(static_cast<std::int32_t>(t));
    const bool known = original >= 0 && original < static_cast<std::int32_t>(middles.size());
    solid.triangle_middle.push_back(known ? middles[original] : Vec3d{none, none, none});
    solid.triangle_cut.push_back(surface.kinds()[t] == SurfaceKind::cut ? 1 : 0);
  }
}

}  // namespace pliant
