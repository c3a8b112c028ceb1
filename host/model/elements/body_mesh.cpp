#include "model/elements/body_mesh.h"

#include <fmt/format.h>

#include "geometry/sheet.h"
#include "mesh_io/mesh_io.h"
#include "mesh_io/surface_report.h"
#include "model/model.h"
#include "model/surface_check.h"
#include "pliant/error.h"
#include "scene/keys.h"

namespace pliant {
namespace {

bool takes_tets(ElementKind kind) { return element_info(kind).corners == 4; }

TriangleMesh surface_of(const Body& body, SurfaceReport& report, std::vector<TextureCorners>* texture = nullptr) {
  return body.surface_in_memory == nullptr
             ? read_surface(body.surface, body.scale, body.translate, &report, texture)
             : clean_surface(*body.surface_in_memory, body.surface.string(), body.scale, body.translate, &report);
}

void from_lattice(const Body& body, BodyMesh& solid, SurfaceReport& report) {
  std::vector<TextureCorners> texture;
  const TriangleMesh mesh = surface_of(body, report, &texture);
  require_inside(report);
  Lattice lattice = build_lattice(mesh, body.lattice);
  solid.spacing = lattice.spacing;
  solid.surface_volume = report.volume;
  solid.surface = mesh.vertices;
  solid.triangles = mesh.triangles;
  if (!texture.empty()) {
    solid.texture = std::make_shared<const SurfaceTexture>(SurfaceTexture{mesh.triangles, std::move(texture)});
  }
  for (const LatticeNode& n : lattice.nodes) solid.nodes.push_back(lattice.position(n));
  for (const Embedding& at : lattice.embedding) {
    const Cell& cell = lattice.cells[at.cell];
    std::array<double, 8> weights{};
    for (int a = 0; a < 8; ++a) {
      weights[a] = ((a & 1) ? at.local[0] : 1 - at.local[0]) * ((a & 2) ? at.local[1] : 1 - at.local[1]) *
                   ((a & 4) ? at.local[2] : 1 - at.local[2]);
    }
    solid.surface_nodes.push_back(cell.nodes);
    solid.surface_cell.push_back(at.cell);
    solid.surface_weights.push_back(weights);
  }
  solid.lattice = std::make_shared<const Lattice>(lattice);
  solid.lattice_nodes = std::move(lattice.nodes);
  for (const Cell& cell : lattice.cells) solid.samples.push_back(cell.samples);
  if (takes_tets(body.element)) {
    for (const Cell& cell : lattice.cells) {
      for (const auto& tet : kKuhnTets) {
        solid.tets.push_back({cell.nodes[tet[0]], cell.nodes[tet[1]], cell.nodes[tet[2]], cell.nodes[tet[3]]});
        solid.fill.push_back(cell.fill);
      }
    }
    return;
  }
  for (const Cell& cell : lattice.cells) {
    solid.hexes.push_back(cell.nodes);
    solid.fill.push_back(cell.fill);
  }
  solid.cells = std::move(lattice.cells);
}

void from_mesh(const Body& body, BodyMesh& solid, SurfaceReport& report) {
  const VolumeMesh mesh = body.thickness > 0 ? thicken(surface_of(body, report), body.thickness, body.surface.string())
                                             : read_volume(body.mesh, body.scale, body.translate);
  const bool tets = takes_tets(body.element);
  if (tets ? mesh.tets.empty() : mesh.hexes.empty()) {
    const int corners = tets ? 8 : 4;  // of the file's elements
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: element {} needs {} and the file has only {}; use {}", body.mesh.string(),
                            to_string(body.element), element_info(body.element).cells, tets ? "hexahedra" : "tetrahedra",
                            elements_with([&](const ElementInfo& e) { return e.corners == corners; })));
  }
  if (!mesh.tets.empty() && !mesh.hexes.empty()) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: the file mixes {} tetrahedra and {} hexahedra; a body takes one kind",
                                                  body.mesh.string(), mesh.tets.size(), mesh.hexes.size()));
  }
  solid.nodes = mesh.vertices;
  solid.tets = mesh.tets;
  for (const auto& hex : mesh.hexes) {
    std::array<std::int32_t, 8> corners{};
    for (int a = 0; a < 8; ++a) corners[a] = hex[kVtkFromBits[a]];
    solid.hexes.push_back(corners);
  }
  solid.fill.assign(solid.tets.size() + solid.hexes.size(), 1.0);
  solid.triangles = boundary_triangles(mesh);
  surface_on_nodes(solid);
}

/// The cells of a lattice alone. What they enclose is the body now, though some are filled in part only.
void forget_lattice(BodyMesh& solid) {
  VolumeMesh mesh{solid.nodes, solid.tets, {}};
  for (const auto& hex : solid.hexes) {
    std::array<std::int32_t, 8> corners{};
    for (int a = 0; a < 8; ++a) corners[a] = hex[kVtkFromBits[a]];
    mesh.hexes.push_back(corners);
  }
  BodyMesh plain;
  plain.nodes = std::move(solid.nodes);
  plain.tets = std::move(solid.tets);
  plain.hexes = std::move(solid.hexes);
  plain.fill = std::move(solid.fill);
  plain.triangles = boundary_triangles(mesh);
  surface_on_nodes(plain);
  solid = std::move(plain);
}

/// Copies inherit the partition of the uncut lattice's cells; the kind of a node follows from its elements.
void spread_to_copies(BodyElements& solid) {
  Partition& partition = solid.partition;
  const std::vector<char> of_cell = std::move(partition.operational);
  partition = {};
  std::vector<char> on(solid.nodes.size(), 0);  // 1: on an operational element, 2: on a shape-matching one
  const std::size_t corners = solid.tets.empty() ? 8 : 4, parts = solid.tets.empty() ? 1 : kKuhnTets.size();
  for (std::size_t c = 0; c < solid.copy_of.size(); ++c) {
    partition.operational.push_back(of_cell[solid.copy_of[c]]);
    for (std::size_t p = parts * c; p < parts * (c + 1); ++p) {
      const std::int32_t* nodes = solid.tets.empty() ? solid.hexes[p].data() : solid.tets[p].data();
      for (std::size_t a = 0; a < corners; ++a) on[nodes[a]] |= static_cast<char>(partition.operational.back() != 0 ? 1 : 2);
    }
  }
  for (const char where : on) {
    partition.kind.push_back(where == 1 ? NodeKind::operational : where == 2 ? NodeKind::matching : NodeKind::interface);
    ++(where == 1 ? partition.operational_nodes : where == 2 ? partition.matching_nodes : partition.interface_nodes);
  }
}

}  // namespace

std::vector<BodyMesh> make_body_meshes(const Scene& scene) {
  std::vector<BodyMesh> solids;
  for (const Body& body : scene.bodies) {
    try {
      solids.push_back(make_body_mesh(body));
    } catch (const Error& error) {
      if (scene.file.empty() || body.pointer.empty()) throw;
      throw Error(error.code(), fmt::format("{}: {}: {}", scene.file.string(), body.pointer, error.what()));
    }
  }
  return solids;
}

std::array<std::int32_t, 8> cell_corners(const std::array<std::int32_t, 4>* tets) {
  std::array<std::int32_t, 8> corners{};
  for (std::size_t t = 0; t < kKuhnTets.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) corners[kKuhnTets[t][a]] = tets[t][a];
  }
  return corners;
}

void repartition(const Body& body, BodyElements& solid) {
  if (!body.model.matches()) return;
  const Lattice& lattice = *solid.lattice;
  solid.partition = partition_lattice(body, lattice);
  solid.matching_cells.clear();
  if (!solid.copy_of.empty()) spread_to_copies(solid);
  for (std::size_t c = 0; c < solid.partition.operational.size(); ++c) {
    if (solid.partition.operational[c] != 0) continue;
    Cell cell = lattice.cells[solid.copy_of.empty() ? c : static_cast<std::size_t>(solid.copy_of[c])];
    if (!solid.copy_of.empty()) cell.nodes = solid.tets.empty() ? solid.hexes[c] : cell_corners(&solid.tets[6 * c]);
    solid.matching_cells.push_back(cell);
  }
}

void surface_on_nodes(BodyMesh& solid) {
  std::vector<std::int32_t> vertex(solid.nodes.size(), -1);
  for (auto& triangle : solid.triangles) {
    for (std::int32_t& v : triangle) {
      if (vertex[v] < 0) {
        vertex[v] = static_cast<std::int32_t>(solid.surface.size());
        solid.surface.push_back(solid.nodes[v]);
        solid.surface_nodes.push_back({v, v, v, v, v, v, v, v});
        solid.surface_weights.push_back({1, 0, 0, 0, 0, 0, 0, 0});
      }
      v = vertex[v];
    }
  }
  solid.surface_volume = signed_volume({solid.surface, solid.triangles});
}

BodyMesh make_body_mesh(const Body& body) {
  SurfaceReport report;
  return make_body_mesh(body, report);
}

BodyMesh make_body_mesh(const Body& body, SurfaceReport& report) {
  BodyMesh solid;
  if (body.has_lattice()) {
    from_lattice(body, solid, report);
    if (body.plain) forget_lattice(solid);
  } else {
    from_mesh(body, solid, report);
  }
  return solid;
}

}  // namespace pliant
